#include "tethercalc/model/moving_air.hpp"

#include <algorithm>
#include <cmath>

#include "model/wind_profile.hpp"

namespace tethercalc {
namespace {

/// Below this share of the reference height a power law, whose slope has no end at the ground, is
/// taken as a straight line to it.
constexpr double linear_below = 0.01;

/// Of the wind that is not the same at all heights, the part that there is at `height`.
double profile_share(const MovingAir& air, double height) {
  const double over_ground = height + air.station_height;
  switch (air.profile) {
    case WindProfile::uniform:
      return 1;
    case WindProfile::power_law:
      return over_ground > linear_below * air.reference_height
                 ? std::pow(over_ground / air.reference_height, air.exponent)
                 : std::max(over_ground / (linear_below * air.reference_height), 0.0) *
                       std::pow(linear_below, air.exponent);
    case WindProfile::logarithmic:
      return over_ground > air.roughness_length && !is_still(air)
                 ? std::log(over_ground / air.roughness_length) /
                       std::log(air.reference_height / air.roughness_length)
                 : 0;
  }
  return 1;
}

double profile_share_slope(const MovingAir& air, double height) {
  const double over_ground = height + air.station_height;
  if (over_ground <= 0) return 0;
  switch (air.profile) {
    case WindProfile::uniform:
      return 0;
    case WindProfile::power_law:
      return over_ground < linear_below * air.reference_height
                 ? profile_share(air, height) / over_ground
                 : air.exponent * profile_share(air, height) / over_ground;
    case WindProfile::logarithmic:
      return over_ground > air.roughness_length && !is_still(air)
                 ? 1 / (over_ground * std::log(air.reference_height / air.roughness_length))
                 : 0;
  }
  return 0;
}

}  // namespace

Vector3 level_wind(double speed, double from) {
  return {-speed * std::cos(from), speed * std::sin(from), 0};
}

bool is_still(const MovingAir& air) {
  return air.profile == WindProfile::logarithmic && !(air.reference_height > air.roughness_length);
}

double wind_share(const MovingAir& air, double height) {
  return air.even_share + (1 - air.even_share) * profile_share(air, height);
}

std::array<double, 2> corner_heights(const MovingAir& air) {
  if (air.profile == WindProfile::power_law)
    return {-air.station_height, linear_below * air.reference_height - air.station_height};
  return {air.roughness_length - air.station_height, air.roughness_length - air.station_height};
}

double wind_share_slope(const MovingAir& air, double height) {
  return (1 - air.even_share) * profile_share_slope(air, height);
}

CylinderDrag cylinder_drag(double reynolds) {
  const double re = std::max(reynolds, 1.0);
  const double falls = 6.8 * std::pow(re, -0.89);
  const double root = 1.96 / std::sqrt(re);
  const double bend = 1 + 3.64e-7 * re * re;
  CylinderDrag drag{.coefficient = 1.18 + falls + root - 0.0004 * re / bend};
  if (reynolds > 1) {
    drag.slope = -(0.89 * falls + 0.5 * root) / re - 0.0004 * (2 - bend) / (bend * bend);
  }
  return drag;
}

}  // namespace tethercalc
