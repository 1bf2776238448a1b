// How good a motor with its propeller is, and what one comes to that nobody measured.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// Power in W that an ideal propeller of `diameter` (m, > 0) needs to hover with `thrust` (N, ≥ 0)
/// in air of `air_density` (kg/m³, > 0): T^1.5/√(2ρA), A its disc (momentum theory: Leishman,
/// Principles of Helicopter Aerodynamics, 2nd ed., section 2.2).
[[nodiscard]] double ideal_hover_power(double thrust, double diameter, double air_density);

/// Ideal hover power over electrical power at each point of a motor's curve, (0, 0) left out: the
/// figure of merit (Leishman, section 2.8) of the propeller times the efficiency of motor and speed
/// controller. In the air that the curve was measured in, else in `standard_air_density`. Empty
/// where the propeller is not known.
[[nodiscard]] std::vector<double> figures_of_merit(const MotorEntry& motor);

/// Exact (international inch); propellers are sold by it.
inline constexpr double metres_per_inch = 0.0254;

/// Figures of merit of all points of several motors.
struct FigureOfMeritSpread {
  double least = 0;        ///< of all points
  double median = 0;       ///< likewise
  double greatest = 0;     ///< likewise
  std::size_t points = 0;  ///< how many there are
  /// Of 95 % of the points the power is within this share of what the median gives, 0.3 being 30 %.
  double power_band = 0;
};

/// Of `motors` whose propeller is known. Throws std::invalid_argument where there is none.
[[nodiscard]] FigureOfMeritSpread figure_of_merit_spread(std::span<const MotorEntry> motors);

/// A motor that is known by its propeller only.
struct GenericMotorRequest {
  double diameter = 0;                        ///< m, > 0, of the propeller
  double figure_of_merit = 0;                 ///< electrical, see `figures_of_merit`; in (0, 1)
  double max_thrust = 0;                      ///< N, > 0
  double air_density = standard_air_density;  ///< kg/m³, > 0
};

/// The curve P = `factor`·T^1.5 (W/N^1.5, > 0) of momentum theory, at 31 thrusts from a twentieth
/// of the greatest (N, > 0) to it, between which it is at most 0.1 % above the formula.
[[nodiscard]] MotorCurve momentum_curve(double factor, double max_thrust);

/// The curve of such a motor, by momentum theory: P = T^1.5/√(2ρA)/figure of merit, see
/// `momentum_curve`. It counts as measured in that air. Throws std::invalid_argument outside the
/// ranges.
[[nodiscard]] MotorCurve generic_motor_curve(const GenericMotorRequest& request);

/// `own` and the eight motors whose greatest thrust is nearest to its own, by ratio, in the order
/// of `motors`; `own` last where it is none of them. As many as a figure can tell apart, and of a
/// size that may fit the same frame.
[[nodiscard]] std::vector<MotorEntry> alike_motors(std::span<const MotorEntry> motors,
                                                   const MotorEntry& own);

}  // namespace tethercalc
