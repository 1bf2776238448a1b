// The load that a tether puts on the drone.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// What the drone and the ground feel of a tether in one flight state, with one conductor. Another
/// model of the tether's shape answers with the same.
struct TetherLoad {
  double along = 0;              ///< N at the drone against its motion through the air
  double down = 0;               ///< N at the drone downwards
  double tension_at_drone = 0;   ///< N
  double tension_at_ground = 0;  ///< N
  double mass = 0;               ///< kg in the air

  /// N, what the cable has to stand.
  [[nodiscard]] double greatest_tension() const {
    return std::max(tension_at_drone, tension_at_ground);
  }
};

/// The tether that hangs straight between drone and ground, all of its weight, its drag and the
/// pull of the winch on the drone (paper section III-A and V-B), as functions of the conductor's
/// radius r in m, with what does not depend on r computed once. Mass is a quadratic in r, drag
/// linear in r, resistance linear in 1/r².
/// Refers to the tether, which must outlive it.
class StraightTether {
 public:
  /// `wall` in m of the insulation, `air_density` in kg/m³, `gravity` in m/s².
  StraightTether(const Tether& tether, double wall, const FlightState& state, double air_density,
                 double gravity);

  /// The same at another airspeed, sooner than anew.
  void set_airspeed(double airspeed);

  /// The load on the drone.
  [[nodiscard]] TetherLoad load(double radius) const {
    const double down = mass(radius) * gravity_ + winch_pull();
    const double along = drag(radius);
    return {along, down, std::hypot(down, along), winch_pull(), mass(radius)};
  }

  /// kg in the air.
  [[nodiscard]] double mass(double radius) const {
    return mass_0_ + radius * (mass_1_ + radius * mass_2_);
  }
  /// kg of `length` m of the tether.
  [[nodiscard]] double mass_of(double length, double radius) const;
  /// Derivative of the mass by the radius, kg/m.
  [[nodiscard]] double mass_slope(double radius) const { return mass_1_ + 2 * radius * mass_2_; }
  /// Second derivative, kg/m².
  [[nodiscard]] double mass_curvature() const { return 2 * mass_2_; }
  /// Radius at which the mass is `mass`; negative where even the thinnest tether is heavier.
  [[nodiscard]] double radius_of_mass(double mass) const;

  /// N at the drone, along the motion; ≥ 0.
  [[nodiscard]] double drag(double radius) const { return drag_0_ + drag_1_ * radius; }
  /// Its derivative by the radius, N/m.
  [[nodiscard]] double drag_slope() const { return drag_1_; }
  /// m, mean width that the wind meets.
  [[nodiscard]] double width(double radius) const {
    return 4 * tether_->projection_factor * (radius + width_);
  }
  /// The drag of a tether without thickness of metal, N.
  [[nodiscard]] double least_drag() const { return drag_0_; }

  /// N downwards at the ground end.
  [[nodiscard]] double winch_pull() const { return tether_->winch_pull; }

  /// Resistance of the loop in Ω without current: both conductors, the part on the drum, and the
  /// contacts, at the temperature of the air where the current warms the tether, else at its
  /// `conductor_temperature_C`.
  [[nodiscard]] double resistance(double radius) const {
    return contact_resistance() + resistance_area_ / (radius * radius);
  }
  /// The same with the conductor at these temperatures, °C, in the air and on the drum.
  [[nodiscard]] double resistance(double radius, double in_air_C, double on_drum_C) const;
  /// Derivative of `resistance(radius)` by the radius, Ω/m.
  [[nodiscard]] double resistance_slope(double radius) const {
    return -2 * resistance_area_ / (radius * radius * radius);
  }
  /// Radius at which the loop has `resistance`; +infinity where contacts alone have more.
  [[nodiscard]] double radius_of_resistance(double resistance) const {
    const double line = resistance - contact_resistance();
    return line > 0 ? std::sqrt(resistance_area_ / line) : std::numeric_limits<double>::infinity();
  }
  /// Ω of plugs and slip rings.
  [[nodiscard]] double contact_resistance() const { return tether_->contact_resistance; }
  /// Ω·m²: what the conductors' resistance is over r².
  [[nodiscard]] double resistance_area() const { return resistance_area_; }

 private:
  const Tether* tether_;
  double wall_;
  double deployed_;
  double on_drum_;
  double width_;  ///< m over a conductor's radius, a quarter of the width that the wind meets
  double half_density_;
  double gravity_;
  double mass_0_, mass_1_, mass_2_;  ///< mass = mass_0 + mass_1·r + mass_2·r²
  double resistance_area_;           ///< Ω·m², (R − R_contact)·r²
  double drag_0_, drag_1_;           ///< drag = drag_0 + drag_1·r, N
};

}  // namespace tethercalc
