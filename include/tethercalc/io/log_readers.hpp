// Flight logs and power logs from what people have: autopilots' logs and CSV.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// How to read a flight log.
struct FlightLogOptions {
  /// Which of the estimators that run side by side, 0 ≤ core ≤ 255. Not used for CSV.
  int core = 0;
  /// Whether a CSV file may lack `roll_deg` and `vd_m_s`. They then count as 0, level flight at one
  /// height, and a note says so.
  bool level_where_missing = false;
  /// Of a CSV file, NAME=COLUMN each: the column that holds what the one called NAME would, its
  /// numbers in the unit at the end of NAME: "yaw_rad=heading". A minus before the column turns its
  /// sign.
  std::vector<std::string> columns{};
};

/// A flight log, and how it came about.
struct FlightLogReading {
  FlightLog log;  ///< what was read
  /// m above where the estimator counts from, one a sample; empty where the log does not tell, as
  /// in CSV.
  std::vector<double> height{};
  /// "XKF1 of EKF core 0", "NKF6", "vehicle_local_position and vehicle_attitude", or "CSV"
  std::string source;
  /// Samples left out because their time does not increase; as few as make the rest increase.
  std::size_t samples_out_of_order = 0;
  /// Samples left out because a value is not finite, or cannot be: |pitch| above 90°, |roll| above
  /// 360°, a velocity above 500 m/s, which flipped bits produce; and one that leaps there and back,
  /// by more than 20 g for the time between and 10 m/s.
  std::size_t samples_implausible = 0;
  /// What is to be said of these and of damage to the log; empty where nothing was amiss.
  std::vector<Warning> notes;
};

/// Reads attitude and velocity over time; `name` stands for the file in messages.
///
/// From a DataFlash log: message XKF1 (EKF3) of the wanted core; without it NKF1 (EKF2; core 1 of
/// logs before the messages had a core field is NKF6), without it EKF1, which had one core only.
/// Time from `TimeUS` or `TimeMS`.
///
/// From CSV: columns `time_s, roll_deg, pitch_deg, yaw_deg, vn_m_s, ve_m_s, vd_m_s` in any order,
/// named exactly so; every value finite, angles within ±90° (pitch), ±360° (roll) and ±360 000°
/// (yaw), velocities within ±500 m/s, time increasing. Which of them may be missing, the options
/// tell. A measured wind may stand beside them: `wind_north_m_s` and `wind_east_m_s`, the velocity
/// of the air over ground (of a wind from the north `wind_north_m_s` is negative), or
/// `airspeed_forward_m_s` along the heading, from which the wind ahead follows, or `airspeed_m_s`
/// with `air_from_deg`, the direction that this air comes from. Instead of the angles there may be
/// a quaternion, instead of the velocity the one along the drone's own axes; see docs/csv.md.
///
/// From a ULog: vehicle_local_position and vehicle_attitude, of core 0 the estimate that flew; of
/// another core its own estimator_local_position and estimator_attitude. The wind that PX4 writes
/// is the estimator's guess and is not taken for a measured one; a note says so.
///
/// Which of them it is, the content tells, not the name.
///
/// Yaw comes out without wraps: it continues beyond ±π rather than jump, so that it can be
/// interpolated. The first value is as logged.
///
/// Throws InputError: what is none of these (naming what it is, if known), a log without attitude
/// and velocity, or without the wanted core (the message lists the cores there are); every problem
/// of a CSV file, with its line.
[[nodiscard]] FlightLogReading parse_flight_log(std::span<const std::byte> content,
                                                const std::string& name,
                                                const FlightLogOptions& options = {});

/// The same from a log that is already opened.
[[nodiscard]] FlightLogReading parse_flight_log(const AutopilotLog& log,
                                                const FlightLogOptions& options = {});

/// How to read a power log.
struct PowerLogOptions {
  /// The drone flew without its tether; then CSV needs no height.
  bool free_flight = false;
  /// Which battery monitors of an autopilot feed the motors, by their numbers from 0; empty: the
  /// only one that measures a current. Not used for CSV.
  std::vector<int> batteries{};
  /// Of the estimator, as in FlightLogOptions.
  int core = 0;
  std::vector<std::string> columns{};  ///< as in FlightLogOptions
};

/// A power log, and how it came about.
struct PowerLogReading {
  PowerLog log;        ///< what was read
  std::string source;  ///< "CSV", "BAT 0 + BAT 1 and XKF1 of EKF core 0"
  /// Sentences for the user: where the airspeed comes from, what was left out.
  std::vector<Warning> notes{};
};

/// Reads power, height and airspeed over time; `name` stands for the file in messages.
///
/// From CSV: `time_s`, `height_m` and `airspeed_m_s` and whatever there is of
/// `ambient_temperature_C, supply_voltage_V, supply_current_A, drone_voltage_V, bus_voltage_V,
/// bus_current_A` or, instead of these two, `bus_power_W`, in any order, named exactly so; columns
/// of a flight log may stand beside them. Without `airspeed_m_s` it is made of the velocity over
/// ground, `vn_m_s` and `ve_m_s`, and a measured wind; without one of those it is the speed over
/// ground, and a note says so. Accelerations are the columns' or, with velocities, made of those.
///
/// From an autopilot's log: the bus is what its battery monitor measures (DataFlash BAT, BAT2,
/// CURR, CURR2, ULog battery_status), at that monitor's times, from take-off to landing as
/// `summarize_log` tells them. Of several monitors that `batteries` choose the currents add up, and
/// the voltage is their mean weighted by current, so that the power is the sum. Height is the
/// estimator's, above take-off. The airspeed is measured (ARSP, airspeed), else the velocity over
/// ground less the wind that the estimator guesses, else the speed over ground; a note says which.
/// The acceleration is that over ground in the mean over 0.4 s, in a wind that is steady meanwhile.
///
/// Throws InputError: what is neither; every problem of a CSV file, with its line; a log without
/// flight, voltage or current, with several monitors and no choice, or of another vehicle.
[[nodiscard]] PowerLogReading parse_power_log(std::span<const std::byte> content,
                                              const std::string& name,
                                              const PowerLogOptions& options = {});

/// The same from a log that is already opened.
[[nodiscard]] PowerLogReading parse_power_log(const AutopilotLog& log,
                                              const PowerLogOptions& options = {});

}  // namespace tethercalc
