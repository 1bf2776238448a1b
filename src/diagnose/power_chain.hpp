// What the instruments of a power log should have read: the one simulation in the flight state of
// every sample, stage by stage, each stage from the quantities that were measured before it.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "diagnose/hanging_loads.hpp"
#include "model/tether_heat.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {

/// What the instruments of a power log make of the truth: reading = gain·truth + offset.
struct PowerInstruments {
  double supply_voltage_gain = 1;
  double supply_current_gain = 1;
  double supply_current_offset = 0;  ///< A
  double drone_voltage_offset = 0;   ///< V
  double bus_current_gain = 1;
  double height_offset = 0;  ///< m
  double airspeed_gain = 1;

  bool operator==(const PowerInstruments&) const = default;
};

/// What was read without the errors of the instruments.
[[nodiscard]] PowerLog without_errors(PowerLog log, const PowerInstruments& instruments);

/// A design as it flew, and what its instruments made of it.
struct PowerModel {
  Design design;  ///< with a cable cross-section, unless the log is of a free flight
  PowerInstruments instruments{};
  double slack = 0;       ///< length of the cable in the air over the height, less 1
  double air_share = 0;   ///< of the way from the spec's temperature of the cable to the air's
  double climb_work = 0;  ///< of the work against the weight that a climb takes, at the bus
  double motor_power_growth = 0;  ///< from the first to the last sample, steadily, over the first
  double dropped_mass = 0;        ///< kg that the drone is lighter by from `drop_time` on
  double drop_time = 0;           ///< s of the log's clock
  /// W drawn at the bus beside, in a sample of the log in which the rest draws so much.
  std::vector<std::function<double(const PowerModel&, const PowerLog&, std::size_t, double)>>
      added_power{};
};

/// What heat balances of one log's samples came to. A search asks for the same ones hundreds of
/// times: most effects change neither the heat that a cable makes nor what it gives off.
class CableHeat {
 public:
  /// One a sample: the steady temperatures of a cable without measured heating, nothing where there
  /// are none. `log` is without the errors of the model's instruments, and otherwise that of the
  /// call before.
  [[nodiscard]] const std::vector<std::optional<TetherTemperatures>>& temperatures(
      const PowerModel& model, const PowerLog& log, HangingLoads& loads);

 private:
  struct Known {
    // All that the temperatures may depend on beside the log.
    Tether tether;
    Flight flight;
    double supply_voltage = 0;  ///< decides the wall
    PowerInstruments instruments;
    double slack = 0;
    std::vector<std::optional<TetherTemperatures>> temperatures;
  };
  std::deque<Known> known_;  ///< the latest first
};

/// Remembers what the predictions of one log solved.
struct ChainMemory {
  CableHeat heat;
  HangingLoads loads;
};

/// A design in the state of one sample after the other. A solved tether flies as a straight one
/// that is as long and loads the drone as much.
class FlownDesign {
 public:
  /// `design` with a cable cross-section.
  FlownDesign(const Design& design, HangingLoads& loads);
  FlownDesign(const FlownDesign&) = delete;
  FlownDesign& operator=(const FlownDesign&) = delete;

  /// With the drone's own mass `mass` in kg.
  void set_mass(double mass) { design_.drone.mass = mass; }

  /// That which holds until the next call; nothing where the tether cannot hang.
  [[nodiscard]] const SteadyFlight* in(const FlightState& state);

  /// Its tether alone, sooner.
  [[nodiscard]] const TetherInFlight* tether_in(const FlightState& state);

  /// m of the conductor.
  [[nodiscard]] double radius() const { return radius_; }
  /// N at the motors, in the last state.
  [[nodiscard]] double weight() const { return steady_->weight(radius_); }
  /// Tangent of the tilt in the last state, +infinity beyond `limit`; `guess` only saves time.
  [[nodiscard]] double tan_pitch(double limit, double guess = 0) const;

 private:
  /// The state in which the straight tether is that of the design; nothing where it cannot hang.
  [[nodiscard]] std::optional<FlightState> laid_straight(const FlightState& state);

  Design design_;  ///< its tether straight
  std::optional<Tether> hanging_;
  HangingLoads& loads_;
  double radius_;
  double wall_;                         ///< m of the insulation
  std::optional<double> hanging_drag_;  ///< N of a solved tether in the last state
  std::optional<SteadyFlight> steady_;
  std::optional<TetherInFlight> tether_;
};

/// Loop resistance in Ω at every sample of a log without the errors of its instruments; see
/// `flight_state_at` for the cable on a drum and the temperature of the air. A heated cable is as
/// warm as the current of the log makes it: where its heating was measured it follows with its time
/// constant from a cold start, otherwise at once. NaN where it would be too hot for any insulation.
[[nodiscard]] std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log,
                                                  ChainMemory& memory);

/// Power in W at the bus at the height and airspeed of every sample of such a log, in steady flight
/// unless it tells accelerations; the thrust then also accelerates the drone's own mass, with the
/// drag of steady flight.
/// Above the motors' largest thrust their curve is continued straight, and the design's limit of
/// the tilt does not count, so that the value stays finite: a log shows what was flown. NaN beyond
/// a tilt of 80°. In free flight without tether, winch, converter and reserve battery, and with the
/// auxiliary power, which the battery feeds as well; the design then needs no cross-section.
[[nodiscard]] std::vector<double> motor_power(const PowerModel& model, const PowerLog& log,
                                              HangingLoads& loads);

/// The design as a drone that left its tether, and all that hangs on that, on the ground.
[[nodiscard]] Design without_tether(Design design);

/// The entries of the catalogue for power logs, from the ground to the air.
[[nodiscard]] std::vector<Effect> power_effects();

}  // namespace tethercalc
