// The air that a cable hangs in, and what it does to a cylinder.
#pragma once

#include <compare>

#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// m, m/s or N; x and y level, z up.
struct Vector3 {
  double x = 0;  ///< level
  double y = 0;  ///< level, a quarter turn to the left of x
  double z = 0;  ///< up

  auto operator<=>(const Vector3&) const = default;  ///< member by member
};

/// How the wind grows with height over ground.
enum class WindProfile {
  uniform,      ///< the same everywhere
  power_law,    ///< (z/z_ref)^exponent; below z_ref/100 in a straight line to 0
  logarithmic,  ///< ln(z/roughness)/ln(z_ref/roughness)
};

/// The air that a cable hangs in. Below the ground and, with a logarithmic profile, below the
/// roughness length, a wind that grows with height is still; all of it is where the reference
/// height lies there.
struct MovingAir {
  double density = standard_air_density;       ///< kg/m³
  double viscosity = 1.81e-5;                  ///< Pa·s; of air at 20 °C, 6 % less at −5 °C
  Vector3 wind{};                              ///< m/s, velocity of the air at the reference height
  WindProfile profile = WindProfile::uniform;  ///< how it grows with height
  double station_height = 0;                   ///< m of the cable's lower end over ground, ≥ 0
  double reference_height = 10;                ///< m over ground
  double exponent = 1.0 / 7;                   ///< of the power law; 1/7 over open land (Hellmann)
  double roughness_length = 0.03;              ///< m; 0.03 over grass (WMO-No. 8, annex 1.D)
  /// Of the wind at the reference height, the share that all heights have, whatever the profile:
  /// air that the cable meets because it is moved.
  double even_share = 0;

  /// m/s, velocity of the drone over ground. The cable follows it in proportion to the way along
  /// the chord.
  Vector3 drone_velocity{};

  auto operator<=>(const MovingAir&) const = default;  ///< member by member
};

/// m/s, a level wind of `speed` that comes from `from` rad, clockwise seen from above, 0 being
/// where x points.
[[nodiscard]] Vector3 level_wind(double speed, double from);

/// Wind at `height` m over the station as a part of that at the reference height.
[[nodiscard]] double wind_share(const MovingAir& air, double height);

/// A drag coefficient.
struct CylinderDrag {
  double coefficient = 1;  ///< over the cylinder's width
  double slope = 0;        ///< its derivative by the Reynolds number
};

/// Drag coefficient of a long smooth cylinder across the wind, after Sucker and Brauer (1975,
/// Wärme- und Stoffübertragung 8, 149), up to the drag crisis at a Reynolds number of 2·10⁵: 1.45
/// at 100, 0.96 at 1000, 1.1 at 10 000. Below 1, where a wind of millimetres a second carries no
/// force, that of 1.
[[nodiscard]] CylinderDrag cylinder_drag(double reynolds);

}  // namespace tethercalc
