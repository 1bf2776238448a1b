// Logs with too few samples for what a drone does between them.
#pragma once

#include <optional>

#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// What is to be said of a log whose samples are usually `step` s apart; nothing of two a second
/// and more.
[[nodiscard]] std::optional<Warning> slow_log_warning(double step);

}  // namespace tethercalc
