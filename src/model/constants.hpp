// Numbers that stand for what no number can.
#pragma once

#include <limits>

namespace tethercalc {

/// A quantity that does not exist: a dash in tables, null in JSON, nothing in CSV.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Without bound, or beyond what can be had.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace tethercalc
