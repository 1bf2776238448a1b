// The electrical power one motor with its propeller needs for a thrust, and the thrust it makes of
// a power: the data sheet's curve, both ways; how it comes out of noisy test-bench points, and what
// the airspeed changes.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/model/warning.hpp"

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
  [[nodiscard]] double power(double thrust) const {
    if (thrust <= 0) return 0;
    // A thrust that was solved for to be the last point's may miss it by rounding.
    constexpr double rounding = 1e-12;
    if (!(thrust <= max_thrust() * (1 + rounding))) {
      return std::numeric_limits<double>::infinity();
    }
    const std::size_t i = piece(thrust);
    return line_->vertices[i].power + line_->slopes[i] * (thrust - line_->vertices[i].thrust);
  }

  /// Thrust in N from electrical power in W; 0 for power ≤ 0; `max_thrust()` from `max_power()` on.
  [[nodiscard]] double thrust(double power) const;

  /// Index i of the piece, between vertices i and i + 1, that holds `thrust`; the upper one at a
  /// vertex, the nearest one outside the curve. Not for the empty curve.
  [[nodiscard]] std::size_t piece(double thrust) const {
    return piece_at(line_->vertices, &MotorPoint::thrust, thrust);
  }

  /// Slope of `power` on piece `index`, W/N.
  [[nodiscard]] double slope(std::size_t index) const { return line_->slopes[index]; }

  /// The same motor and propeller in air of `density_ratio` (> 0) times the density: every point at
  /// the same speed of rotation, where thrust and shaft power both go with the density (T = C_T·ρ·
  /// n²·D⁴, P = C_P·ρ·n³·D⁵: Leishman, Principles of Helicopter Aerodynamics, 2nd ed., section 2.3;
  /// McCormick, Aerodynamics, Aeronautics and Flight Mechanics, 2nd ed., section 6.3), so that T
  /// and P become ratio·T and ratio·P and a thrust costs ratio·P(T/ratio). Where P goes with T^1.5,
  /// as an ideal rotor's does, that is P(T)/√ratio, which momentum theory has at equal thrust.
  ///
  /// The electrical power is taken to go like the shaft's: the motor keeps its efficiency at a
  /// speed of rotation. In thinner air it turns a little faster at full throttle, since less torque
  /// costs less voltage in the winding; that is not counted, and the last point is where the
  /// measured one turned. A power given for a thrust is then within about a percent, and the
  /// greatest thrust a little low in thin air (and a little high in dense air). Reynolds and Mach
  /// numbers move the coefficients of small propellers by a few percent, likewise not counted.
  [[nodiscard]] MotorCurve in_air(double density_ratio) const;

  /// The largest convex curve nowhere above this one, through some of its vertices and with the
  /// same limits (its lower convex hull). A convex curve is its own. Lives as long as this curve.
  [[nodiscard]] const MotorCurve& convex_hull() const;

  /// Whether the power of an additional thrust rises from piece to piece.
  [[nodiscard]] bool is_convex() const;

  /// N, 0 for the empty curve.
  [[nodiscard]] double max_thrust() const { return line_->vertices.back().thrust; }
  /// W, 0 for the empty curve.
  [[nodiscard]] double max_power() const { return line_->vertices.back().power; }

  /// The points with (0, 0) in front. At least one.
  [[nodiscard]] std::span<const MotorPoint> vertices() const { return line_->vertices; }

  /// kg/m³ of the air that the points were measured in; nothing where that is not known.
  [[nodiscard]] std::optional<double> measured_in() const { return measured_in_; }
  /// States it: > 0.
  void set_measured_in(std::optional<double> air_density) { measured_in_ = air_density; }

  /// Share by which the power may be off either way where the curve is an estimate; nothing where
  /// it was measured.
  [[nodiscard]] std::optional<double> uncertainty() const { return uncertainty_; }
  /// States it: > 0.
  void set_uncertainty(std::optional<double> share) { uncertainty_ = share; }

 private:
  /// A rising piecewise-linear curve: vertices from (0, 0) on and the slope of each piece.
  struct Polyline {
    std::vector<MotorPoint> vertices;
    std::vector<double> slopes;              ///< W/N, one fewer than vertices
    std::shared_ptr<const MotorCurve> hull;  ///< null where the curve is its own lower convex hull
  };

  /// Index of the piece that holds `value` of the rising `member`, the first piece for smaller
  /// values and the last for larger ones.
  [[nodiscard]] static std::size_t piece_at(std::span<const MotorPoint> vertices,
                                            double MotorPoint::*member, double value) {
    const MotorPoint* base = vertices.data();
    std::size_t count = vertices.size() - 1;
    while (count > 1) {
      const std::size_t half = count / 2;
      base += base[half].*member <= value ? half : 0;  // branch-free: this is the hottest loop
      count -= half;
    }
    return static_cast<std::size_t>(base - vertices.data());
  }

  explicit MotorCurve(std::shared_ptr<const Polyline> line);
  std::shared_ptr<const Polyline> line_;  ///< never null
  std::optional<double> measured_in_{};   ///< kg/m³
  std::optional<double> uncertainty_{};
};

/// What `MotorCurve::in_air` makes of an ideal rotor's power for a thrust, P going with T^1.5, over
/// that before: 1/√`density_ratio` (> 0).
[[nodiscard]] double ideal_power_in_air(double density_ratio);

/// A motor with its propeller. Texts are empty and numbers absent where the file gives none.
struct MotorEntry {
  std::string id;                      ///< what specs and options call it
  std::string name;                    ///< what people call it
  std::string source;                  ///< where its numbers come from
  std::optional<double> voltage_V;     ///< at which the curve was measured
  std::optional<double> propeller_in;  ///< diameter in inches
  MotorCurve curve;                    ///< of one motor, at that voltage with that propeller
  std::vector<Warning> warnings;       ///< what was done to noisy points, and what is not known
};

/// Part of the motor power that changes with airspeed: rotors that move through the air accelerate
/// more of it by less, and lean against the drag, whose power they make, too. Neutral:
/// `induced_share` 0, the published model, in which a thrust costs the same power at every
/// airspeed.
struct TranslationalLift {
  double induced_share = 0;        ///< in [0, 1): part of the hover power that is induced
  double hover_induced_speed = 6;  ///< m/s, > 0: speed of the air through the rotor disc in hover,
                                   ///< √(T/(2ρA_disc)) of the ideal rotor
};

/// Induced velocity of a level disc over that in hover, in (0, 1], for `speed_ratio` = airspeed
/// over hover induced velocity (of either sign): the root of ν·√(μ² + ν²) = 1, i.e. ν² = √(1 +
/// μ⁴/4) − μ²/2 (Glauert's momentum theory; Leishman, Principles of Helicopter Aerodynamics, 2nd
/// ed., section 2.14, with the disc level).
[[nodiscard]] double induced_velocity_ratio(double speed_ratio);

/// Velocity of the air through a disc over that in hover, and its derivative by the tangent of the
/// disc's tilt.
struct Inflow {
  double ratio = 1;  ///< λ
  double slope = 0;  ///< dλ/d tanα
};

/// Of a disc that leans against the air with a tangent of `tan_pitch` ≥ 0: the root λ > μ·sinα of
/// (λ − μ·sinα)·√(μ²cos²α + λ²) = 1 (Glauert; Leishman, the same section). What comes from the
/// airspeed, μ·sinα, is the drag's power: T·v·sinα = D·v. Level it is `induced_velocity_ratio`.
[[nodiscard]] Inflow inflow_ratio(double speed_ratio, double tan_pitch);

/// A share of the static motor curve's power, and its derivative by the tangent of the tilt.
struct PowerShare {
  double value = 1;  ///< of it
  double slope = 0;  ///< by the tangent
};

/// Motor power at `airspeed` (m/s), leaning with `tan_pitch` ≥ 0, over the power the static motor
/// curve gives for the same thrust: 1 − s·(1 − λ). 1 at rest; the least is that of level discs.
[[nodiscard]] PowerShare translational_lift_share(const TranslationalLift& lift, double airspeed,
                                                  double tan_pitch);

/// Measured points that contradicted each other and were replaced by their mean.
struct PooledMotorPoints {
  std::vector<std::size_t> members;  ///< positions in the measured points, by rising thrust
  MotorPoint mean;                   ///< the point in their place
};

/// What `isotonic_motor_points` made of measured points.
struct IsotonicMotorPoints {
  std::vector<MotorPoint> points;         ///< by strictly rising thrust and strictly rising power
  std::vector<PooledMotorPoints> pooled;  ///< by rising thrust; empty where nothing was pooled
};

/// Points fit for a MotorCurve from measured ones in any order: the isotonic regression of power on
/// thrust by pooling adjacent violators (Ayer, Brunk, Ewing, Reid and Silverman 1955, Annals of
/// Mathematical Statistics 26(4), 641–647): neighbours whose power does not rise are replaced by
/// their mean power, which is the least-squares fit among all curves that do not fall. Since a
/// MotorCurve is inverted it must rise strictly, so a pool becomes a single point at its mean
/// thrust instead of a level stretch. Points of equal thrust are pooled first. Points that rise are
/// kept to the last digit.
///
/// Throws std::invalid_argument where a thrust or power is not finite and positive. Takes time
/// n·log n.
[[nodiscard]] IsotonicMotorPoints isotonic_motor_points(std::span<const MotorPoint> measured);

}  // namespace tethercalc
