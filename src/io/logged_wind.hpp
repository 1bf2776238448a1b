// The wind as an autopilot's estimator guesses it, from the drag that it assumes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// The velocity of the air over ground.
struct LoggedWind {
  std::string message;        ///< where it is told: "XKF2", "wind"
  std::vector<double> time;   ///< s, in the order of the log
  std::vector<double> north;  ///< m/s
  std::vector<double> east;   ///< m/s
};

/// The first estimator's; nothing where it guesses none, which is written as zeros. Winds above
/// 100 m/s are damage and left out.
[[nodiscard]] std::optional<LoggedWind> logged_wind(const AutopilotLog& log);

}  // namespace tethercalc
