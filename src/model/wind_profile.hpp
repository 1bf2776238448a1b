// Where and how steeply a wind grows with height.
#pragma once

#include <array>

#include "tethercalc/model/moving_air.hpp"

namespace tethercalc {

/// Whether the wind is still at all heights because that of its reference has none.
[[nodiscard]] bool is_still(const MovingAir& air);

/// Heights in m over the station at which the slope of the wind's profile jumps.
[[nodiscard]] std::array<double, 2> corner_heights(const MovingAir& air);

/// 1/m, derivative of `wind_share` by the height.
[[nodiscard]] double wind_share_slope(const MovingAir& air, double height);

}  // namespace tethercalc
