// What the instruments of a power log should have read: the one simulation in the flight state of
// every sample, stage by stage, each stage from the quantities that were measured before it.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"
#include "tethercalc/model/tether_heat.hpp"

namespace tethercalc {

/// A design as it flew, and what its instruments made of it.
struct PowerModel {
  Design design;                   ///< with a cable cross-section
  double supply_current_gain = 1;  ///< the ground ammeter's reading over the truth
};

/// What heat balances of one log's samples came to. A search asks for the same ones hundreds of
/// times: most effects change neither the heat that a cable makes nor what it gives off.
class CableHeat {
 public:
  /// One a sample: the steady temperatures of a cable without measured heating, nothing where there
  /// are none. The log must be that of the call before.
  [[nodiscard]] const std::vector<std::optional<TetherTemperatures>>& temperatures(
      const PowerModel& model, const PowerLog& log);

 private:
  struct Known {
    // All that the temperatures may depend on beside the log.
    Tether tether;
    Flight flight;
    double supply_voltage = 0;  ///< decides the wall
    double supply_current_gain = 1;
    std::vector<std::optional<TetherTemperatures>> temperatures;
  };
  std::deque<Known> known_;  ///< the latest first
};

/// Loop resistance in Ω at every sample, the deployed length being the height; see
/// `flight_state_at` for the cable on a drum and the temperature of the air. A heated cable is as
/// warm as the current of the log makes it: where its heating was measured it follows with its time
/// constant from a cold start, otherwise at once. NaN where it would be too hot for any insulation.
[[nodiscard]] std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log,
                                                  CableHeat& heat);

/// Power in W at the bus in steady flight at every sample's height and airspeed. Above the motors'
/// largest thrust their curve is continued straight, and the design's limit of the tilt does not
/// count, so that the value stays finite: a log shows what was flown. NaN beyond a tilt of 80°.
[[nodiscard]] std::vector<double> motor_power(const PowerModel& model, const PowerLog& log);

}  // namespace tethercalc
