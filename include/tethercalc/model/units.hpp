// Physical constants and the factors between SI and the practical units used at the edge.
#pragma once

#include <numbers>

namespace tethercalc {

/// Standard acceleration of gravity, m/s² (3rd CGPM 1901, exact by definition). Also what makes a
/// gram-force: the thrust unit of motor data sheets.
inline constexpr double standard_gravity = 9.80665;

/// Zero degrees Celsius in kelvin (exact by definition of the Celsius scale).
inline constexpr double zero_celsius_K = 273.15;

/// Density of the standard atmosphere at sea level, kg/m³ (ISO 2533): the air where nobody says
/// which it is, but for a design's, see `Flight::air_density`.
inline constexpr double standard_air_density = 1.225;

/// Multiply by one of these to go from the practical unit to SI, divide to come back.
namespace unit {
inline constexpr double gram = 1e-3;                             ///< kg
inline constexpr double millimetre = 1e-3;                       ///< m
inline constexpr double square_millimetre = 1e-6;                ///< m²
inline constexpr double gram_force = 1e-3 * standard_gravity;    ///< N
inline constexpr double degree = std::numbers::pi / 180.0;       ///< rad
inline constexpr double gram_per_cubic_centimetre = 1e3;         ///< kg/m³
inline constexpr double megapascal = 1e6;                        ///< Pa
inline constexpr double kilovolt_per_millimetre = 1e6;           ///< V/m
inline constexpr double ohm_square_millimetre_per_metre = 1e-6;  ///< Ω·m
}  // namespace unit

}  // namespace tethercalc
