// Electrical measurements along the supply chain of a flight, over time.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace tethercalc {

/// Time series, one element a sample; every vector is as long as `time`, or empty where the
/// channel was not measured (only those marked optional may be). Time strictly increases.
///
/// *Supply* is the ground end of the tether, *drone* the converter's input, *bus* the converter's
/// output, which feeds the motors. The deployed length of the tether is the height.
///
/// What can be judged, the channels decide: each part of the chain (tether, converter, motors) is
/// compared where all that it needs was measured, see `diagnose_power`.
struct PowerLog {
  std::vector<double> time;                   ///< s
  std::vector<double> height;                 ///< m above the station or take-off, optional
  std::vector<double> airspeed;               ///< m/s
  std::vector<double> ambient_temperature_C;  ///< °C, optional
  std::vector<double> supply_voltage;         ///< V, optional
  std::vector<double> supply_current;         ///< A, optional
  std::vector<double> drone_voltage;          ///< V, optional
  std::vector<double> bus_voltage;            ///< V, optional
  std::vector<double> bus_current;            ///< A, optional
  std::vector<double> bus_power{};           ///< W, optional: where only their product was measured
  std::vector<double> acceleration_along{};  ///< m/s², of the airspeed, optional: else it is steady
  /// m/s², level and across it, optional likewise. Of means over a time with it what the mean along
  /// leaves out, so that the squares of both make the mean square.
  std::vector<double> acceleration_across{};
  /// Flown from a battery without tether and converter, which is the bus. Its cable neither weighs
  /// nor drags; what the drone draws besides its motors comes out of the same battery.
  bool free_flight = false;
};

/// A channel as files and messages name it.
struct PowerChannel {
  std::string_view name;                  ///< of its CSV column
  std::vector<double> PowerLog::*values;  ///< where a log has it
  bool optional = false;                  ///< may be empty
  bool may_rest = true;                   ///< a steady reading is possible in flight
  bool of_motion = false;  ///< how the drone was flown, no instrument's reading; 0 where absent
};

/// The channels of a power log, described once: all but the time.
inline constexpr std::array<PowerChannel, 11> power_channels{{
    {"height_m", &PowerLog::height, true},
    {"airspeed_m_s", &PowerLog::airspeed},
    {"ambient_temperature_C", &PowerLog::ambient_temperature_C, true},
    {"supply_voltage_V", &PowerLog::supply_voltage, true},
    {"supply_current_A", &PowerLog::supply_current, true, false},
    {"drone_voltage_V", &PowerLog::drone_voltage, true, false},
    {"bus_voltage_V", &PowerLog::bus_voltage, true},
    {"bus_current_A", &PowerLog::bus_current, true, false},
    {"bus_power_W", &PowerLog::bus_power, true, false},
    {"acceleration_along_m_s2", &PowerLog::acceleration_along, true, true, true},
    {"acceleration_across_m_s2", &PowerLog::acceleration_across, true, true, true},
}};

/// Power at the bus in W, a value a sample: as measured, or voltage times current; empty where the
/// log has neither.
[[nodiscard]] inline std::vector<double> bus_power_of(const PowerLog& log) {
  if (!log.bus_power.empty() || log.bus_voltage.empty() || log.bus_current.empty()) {
    return log.bus_power;
  }
  std::vector<double> power(log.bus_voltage);
  for (std::size_t i = 0; i < power.size(); ++i) power[i] *= log.bus_current[i];
  return power;
}

/// Throws std::invalid_argument where a log that is said to be of a free flight has channels of a
/// supply on the ground.
void check_flies_free(const PowerLog& log);

/// Puts a further free flight of the same drone behind those of `all`, its time counted on from
/// there. Throws std::invalid_argument where it has other channels than they have, but for those of
/// the motion.
void append_flight(PowerLog& all, const PowerLog& flight);

}  // namespace tethercalc
