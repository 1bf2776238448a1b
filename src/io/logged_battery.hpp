// What the battery monitors of an autopilot measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// One monitor: a battery, or another source whose voltage the controller measures.
struct LoggedBattery {
  std::string message;            ///< where it is told: "BAT", "battery_status"
  std::optional<int> instance{};  ///< which of several
  int number = 0;                 ///< from 0: its instance, or what its message's name says
  std::vector<double> time;       ///< s, in the order of the log
  std::vector<double> voltage;    ///< V, above 0
  std::vector<double> current;    ///< A, NaN where it is not known

  /// "BAT 0", or "CURR" where the log has one only.
  [[nodiscard]] std::string name() const;
  /// Whether there is a sensor of the current: one that ever reads more than 0.
  [[nodiscard]] bool measures_current() const;
  /// V.
  [[nodiscard]] double mean_voltage() const;
  /// A, of what is known; there is such where `measures_current`.
  [[nodiscard]] double mean_current() const;
};

/// All monitors with a voltage. ArduPilot: BAT, BAT2, CURR and CURR2, whose integers hold
/// hundredths in logs until 2015; PX4: battery_status, which writes −1 for a current that is not
/// known. Voltages and currents beyond 1000 V and A are damage.
[[nodiscard]] std::vector<LoggedBattery> logged_batteries(const AutopilotLog& log);

}  // namespace tethercalc
