// The electrical power one motor with its propeller needs for a thrust, and the thrust it makes of
// a power: the data sheet's curve, both ways.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace tethercalc {

/// One measured point of a motor with its propeller on a test bench.
struct MotorPoint {
  double thrust = 0;  ///< static thrust, N
  double power = 0;   ///< electrical input power, W
};

/// Static thrust against electrical power of one motor.
///
/// Linear between the points, linear from (0, 0) to the first one (the efficiency of the lowest
/// measured point also holds below it: a conservative reading of data sheets that start at half
/// throttle, paper section III-A), and saturated at the last one: no thrust exists above it.
///
/// A value type; copies share the same immutable points, so copying is cheap. Lookups take time
/// logarithmic in the number of points.
class MotorCurve {
 public:
  /// No points: every lookup of a positive thrust is infinite power. Exists so that a Design can be
  /// filled field by field.
  MotorCurve();

  /// `points` by rising thrust, SI units. Throws std::invalid_argument unless there are at least
  /// two and thrust and power are finite, positive and strictly increasing. Measured data that is
  /// not belongs through `isotonic_motor_points` first.
  explicit MotorCurve(std::vector<MotorPoint> points);

  /// Electrical power in W for `thrust` in N; 0 for thrust ≤ 0; +infinity above `max_thrust()`
  /// (by more than 1e-12 of it, so that rounding does not decide).
  [[nodiscard]] double power(double thrust) const;

  /// Thrust in N from electrical power in W; 0 for power ≤ 0; `max_thrust()` from `max_power()` on.
  [[nodiscard]] double thrust(double power) const;

  /// Index i of the piece, between vertices i and i + 1, that holds `thrust`; the upper one at a
  /// vertex, the nearest one outside the curve. Not for the empty curve.
  [[nodiscard]] std::size_t piece(double thrust) const;

  /// Slope of `power` on piece `index`, W/N.
  [[nodiscard]] double slope(std::size_t index) const;

  /// The largest convex curve nowhere above this one, through some of its vertices and with the
  /// same limits (its lower convex hull). A convex curve is its own. Lives as long as this curve.
  [[nodiscard]] const MotorCurve& convex_hull() const;

  /// Whether the power of an additional thrust rises from piece to piece.
  [[nodiscard]] bool is_convex() const;

  [[nodiscard]] double max_thrust() const;  ///< N, 0 for the empty curve
  [[nodiscard]] double max_power() const;   ///< W, 0 for the empty curve

  /// The points with (0, 0) in front. At least one.
  [[nodiscard]] std::span<const MotorPoint> vertices() const;

 private:
  struct Polyline;
  explicit MotorCurve(std::shared_ptr<const Polyline> line);
  std::shared_ptr<const Polyline> line_;  ///< never null
};

}  // namespace tethercalc
