// Aerodynamic drag of the drone, and the tilt at which thrust balances it.
#pragma once

#include <cmath>

namespace tethercalc {

/// Drag of the drone as in the paper's section III-B. The areas include the drag coefficient; they
/// are fitted, not measured with a ruler.
struct AirframeDrag {
  double front_area = 0;    ///< A_f, m²
  double top_area = 0;      ///< A_t, m²
  double linear_speed = 0;  ///< j, m/s: the speed at which linear and quadratic drag are equal
  double fore_aft_asymmetry = 0;  ///< a in (−1, 1): drag is (1 + a) times larger flying forward
                                  ///< and (1 − a) times flying backward
  bool is_estimate = false;       ///< from `drag_of_mass`, not measured: answers say so
};

/// The drag that a multirotor of `mass` (kg, > 0, ready to fly, without a tether) may be expected
/// to have where nobody measured it: that of the one drone whose drag was published in these terms,
/// a Holybro X500 V2 of 1.549 kg with A_f 0.01451 m², A_t 0.01361 m², j 19.27 m/s (Beffert and Zell
/// 2025), for drones of its shape and density. Then areas go with m^(2/3); and the drag in
/// proportion to the speed, which rotors make by turning the air's momentum, goes with the thrust
/// and so with m, which makes j go with m^(1/3).
///
/// The force may be off by `drag_estimate_factor` either way: docs/drag.md compares it with what
/// others published for drones from 0.8 to 32.5 kg, 0.6 to 1.6 times as much.
[[nodiscard]] AirframeDrag drag_of_mass(double mass);

/// See `drag_of_mass`.
inline constexpr double drag_estimate_factor = 2;

/// Effective area in m² for a tilt given by its tangent (of either sign):
/// A_f·cos|θ| + A_t·sin|θ|, without trigonometry.
[[nodiscard]] inline double effective_area(const AirframeDrag& drag, double tan_pitch) {
  return (drag.front_area + drag.top_area * std::abs(tan_pitch)) /
         std::sqrt(1 + tan_pitch * tan_pitch);
}

/// The same where the tilt's cosine is known.
[[nodiscard]] inline double effective_area(const AirframeDrag& drag, double tan_pitch,
                                           double cosine) {
  return (drag.front_area + drag.top_area * std::abs(tan_pitch)) * cosine;
}

/// Drag in N per m² of effective area at `airspeed` (m/s, either sign), `air_density` in kg/m³:
/// ½·ρ·(v² + j·|v|)·(1 + a·sign v). Never negative.
[[nodiscard]] inline double area_force_factor(const AirframeDrag& drag, double air_density,
                                              double airspeed) {
  const double speed = std::abs(airspeed);
  const double asymmetry = airspeed < 0 ? -drag.fore_aft_asymmetry : drag.fore_aft_asymmetry;
  return 0.5 * air_density * speed * (speed + drag.linear_speed) * (1 + asymmetry);
}

/// Drag in N against the motion, with the sign of `airspeed` (m/s, forward positive):
/// ½·ρ·(A_f cos|θ| + A_t sin|θ|)·(v|v| + j·v)·(1 + a·sign v). `air_density` in kg/m³.
[[nodiscard]] double airframe_drag_force(const AirframeDrag& drag, double air_density,
                                         double airspeed, double tan_pitch);

/// The part along the forward axis of the drag on a drone that also moves sideways: the force lies
/// along the airspeed vector, (`along`, `across`) in m/s, and is as large as its magnitude makes
/// it: ½·ρ·A·(√(along² + across²) + j)·along·(1 + a·sign along), A the effective `area` in m².
[[nodiscard]] inline double airframe_drag_along(const AirframeDrag& drag, double air_density,
                                                double along, double across, double area) {
  const double asymmetry = along < 0 ? -drag.fore_aft_asymmetry : drag.fore_aft_asymmetry;
  const double speed = std::sqrt(along * along + across * across);
  return 0.5 * air_density * (speed + drag.linear_speed) * along * (1 + asymmetry) * area;
}

/// `airframe_drag_along` with its derivatives.
struct AirframeDragSlopes {
  double force = 0;            ///< N
  double by_front_area = 0;    ///< N/m²
  double by_top_area = 0;      ///< N/m²
  double by_linear_speed = 0;  ///< N·s/m
  double by_along = 0;         ///< N·s/m
  double by_across = 0;        ///< N·s/m
};

/// At a tilt with `cosine` = cos θ and `sine` = |sin θ|.
[[nodiscard]] inline AirframeDragSlopes airframe_drag_slopes(const AirframeDrag& drag,
                                                             double air_density, double along,
                                                             double across, double cosine,
                                                             double sine) {
  const double speed = std::sqrt(along * along + across * across);
  const double asymmetry = along < 0 ? -drag.fore_aft_asymmetry : drag.fore_aft_asymmetry;
  const double k = 0.5 * air_density * (1 + asymmetry);
  const double factor = k * (speed + drag.linear_speed) * along;
  const double area = drag.front_area * cosine + drag.top_area * sine;
  const double direction = speed > 0 ? along / speed : 0;  // at rest the quadratic part is flat
  return {area * factor,
          cosine * factor,
          sine * factor,
          k * area * along,
          k * area * (speed + drag.linear_speed + along * direction),
          k * area * across * direction};
}

/// What `equilibrium_tan_pitch` balances.
struct ForceBalance {
  double weight = 0;             ///< N, > 0: drone and tether
  double area_force_factor = 0;  ///< N/m², ≥ 0, at this airspeed
  double tether_drag = 0;        ///< N along the same direction
  double front_area = 0;         ///< A_f, m², ≥ 0
  double top_area = 0;           ///< A_t, m², ≥ 0
};

/// Tangent t ≥ 0 of the tilt that holds a steady speed: the root of
/// weight·t = area_force_factor·(A_f + A_t·t)/√(1 + t²) + tether_drag (paper eq. (12)).
///
/// The root is unique: with g(t) = (A_f + A_t t)/√(1+t²), the difference
/// weight·t − factor·g(t) − tether_drag is ≤ 0 at t = 0, convex while g is concave, and rising from
/// where g stops being concave on, since g falls there. Newton's method from the right of the root
/// therefore converges monotonically; it is used with a bracket all the same. Where `tan_limit` is
/// exceeded the answer is +infinity: the drone would have to tilt further than allowed. (With
/// neither front area nor tether drag, t = 0 is a second root; the answer is the other one, where
/// it exists, as the limit of a small front area.) `guess` ≥ 0 only saves iterations. Relative
/// error of t below 1e-14. A tether that pulls the other way, `tether_drag` < 0, may make t < 0:
/// the drone leans away from the wind then; no limit is heeded.
[[nodiscard]] double equilibrium_tan_pitch(const ForceBalance& balance, double tan_limit,
                                           double guess = 0);

/// A force and how it changes.
struct InclinedThrust {
  double value = 0;      ///< N of all motors together
  double slope = 0;      ///< its derivative
  double tan_slope = 0;  ///< that of the tangent of the tilt
};

/// The thrust of `balance` at the equilibrium tilt with tangent `tan_pitch`, and its derivative by
/// whatever the weight changes with by `weight_slope` and the tether's drag by `drag_slope`.
[[nodiscard]] inline InclinedThrust inclined_thrust(const ForceBalance& balance, double tan_pitch,
                                                    double weight_slope, double drag_slope) {
  if (tan_pitch == 0) return {balance.weight, weight_slope, 0};
  const double secant_squared = 1 + tan_pitch * tan_pitch;
  const double secant = std::sqrt(secant_squared);
  // The balance W·t − q·g(t) − F_t = 0, differentiated: tan_slope/secant.
  const double tan_slope_cosine =
      (drag_slope - weight_slope * tan_pitch) * secant_squared /
      (balance.weight * secant_squared * secant -
       balance.area_force_factor * (balance.top_area - balance.front_area * tan_pitch));
  return {balance.weight * secant,
          weight_slope * secant + balance.weight * tan_pitch * tan_slope_cosine,
          tan_slope_cosine * secant};
}

/// N, the weight that `thrust` N holds up while it balances the drag of `balance`, whose own weight
/// does not count: the inverse of `equilibrium_tan_pitch` and `inclined_thrust`, in closed form. 0
/// where the drag takes all of the thrust.
[[nodiscard]] double weight_held(const ForceBalance& balance, double thrust);

}  // namespace tethercalc
