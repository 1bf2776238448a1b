// A design in one flight condition, prepared for evaluation at many conductor sizes.
#pragma once

#include <cmath>
#include <limits>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// Everything that steady flight needs as a function of the conductor's radius r, with what does
/// not depend on r computed once. The tether's mass is a quadratic in r, its drag linear in r, its
/// resistance linear in 1/r², at the tether's `conductor_temperature_C`: the heat balance, where
/// one is asked for, is `evaluate`'s, and so is the mass of a reserve battery, which depends on r.
/// `evaluate` and the solvers share these functions, so they cannot disagree. Refers to the
/// design's motor and converter: the design must outlive it.
///
/// Radii are in m and positive; thrusts are in N per motor; powers in W; masses in kg.
class SteadyFlight {
 public:
  /// Prepares `design` for `condition`. The design is taken as valid: no check is made here.
  SteadyFlight(const Design& design, Condition condition);

  /// The same design in another condition, sooner than from the design.
  [[nodiscard]] SteadyFlight in(Condition condition) const;

  /// The same with `mass` kg more on board.
  [[nodiscard]] SteadyFlight carrying(double mass) const {
    SteadyFlight heavier = *this;
    heavier.drone_mass_ += mass;
    return heavier;
  }

  /// Mass of the airborne tether.
  [[nodiscard]] double tether_mass(double radius) const {
    return mass_0_ + radius * (mass_1_ + radius * mass_2_);
  }
  /// Mass of drone and airborne tether, and the mass whose weight is the pull of the winch: what
  /// the motors lift.
  [[nodiscard]] double takeoff_mass(double radius) const {
    return drone_mass_ + tether_mass(radius);
  }
  /// Derivative of the mass by the radius, kg/m.
  [[nodiscard]] double mass_slope(double radius) const { return mass_1_ + 2 * radius * mass_2_; }
  /// Second derivative, kg/m².
  [[nodiscard]] double mass_curvature() const { return 2 * mass_2_; }

  /// Radius at which the take-off mass is `mass`; negative where even the thinnest tether is
  /// heavier.
  [[nodiscard]] double radius_of_mass(double mass) const;

  /// Drag of the airborne tether in N, along the motion.
  [[nodiscard]] double tether_drag(double radius) const {
    return tether_drag_0_ + tether_drag_1_ * radius;
  }

  /// Wall of the insulation in m, as the supply voltage asks for.
  [[nodiscard]] double wall() const { return wall_; }

  /// Resistance of the loop in Ω: both conductors, the part on the drum, and the contacts.
  [[nodiscard]] double resistance(double radius) const {
    return contact_resistance_ + resistance_area_ / (radius * radius);
  }
  /// The same with the whole tether at `temperature_C`.
  [[nodiscard]] double resistance(double radius, double temperature_C) const;
  /// Derivative of the resistance by the radius, Ω/m.
  [[nodiscard]] double resistance_slope(double radius) const {
    return -2 * resistance_area_ / (radius * radius * radius);
  }
  /// Radius at which the loop has `resistance`; +infinity where contacts alone have more.
  [[nodiscard]] double radius_of_resistance(double resistance) const;

  /// Tangent of the tilt's magnitude, +infinity beyond `tan_limit`. `guess` saves iterations.
  [[nodiscard]] double tan_pitch(double radius, double tan_limit, double guess = 0) const {
    return area_force_factor_ == 0 && tether_drag_1_ == 0
               ? 0
               : balanced_tan_pitch(radius, tan_limit, guess);
  }

  /// First approximation of `tan_pitch`: with the drag of the level drone.
  [[nodiscard]] double level_drag_tan_pitch(double radius) const {
    return (area_force_factor_ * design_->drone.drag.front_area + tether_drag_0_ +
            tether_drag_1_ * radius) /
           (takeoff_mass(radius) * weight_per_mass_);
  }

  /// Airspeed in m/s in this condition.
  [[nodiscard]] double airspeed() const { return airspeed_; }

  /// Sign of the tilt: −1 flying backward through the air, else +1.
  [[nodiscard]] double pitch_sign() const { return pitch_sign_; }

  /// Tangent of the design's largest allowed tilt.
  [[nodiscard]] double tan_pitch_limit() const { return tan_pitch_limit_; }

  /// A range of radii, open at both ends and empty where lo ≥ hi.
  struct Radii {
    double lo = 0;  ///< m
    double hi = 0;  ///< m
  };
  /// The radii at which the tilt exceeds its limit. (Weight grows with r², tether drag with r:
  /// there is at most one such range.)
  [[nodiscard]] Radii beyond_pitch_limit() const;

  /// A thrust of one motor and how it changes with the radius.
  struct Thrust {
    double value = 0;      ///< N
    double slope = 0;      ///< N/m
    double tan_slope = 0;  ///< derivative of the tangent of the tilt, 1/m
  };
  /// Thrust that carries the weight at a tilt with tangent `tan_pitch`: (m_d + m_t)g/(n·cosθ).
  [[nodiscard]] double necessary_thrust(double radius, double tan_pitch) const {
    return takeoff_mass(radius) * weight_per_mass_ * std::sqrt(1 + tan_pitch * tan_pitch) *
           per_motor_;
  }
  /// The same with its derivative, where `tan_pitch` is that of the equilibrium at `radius`.
  [[nodiscard]] Thrust necessary_thrust_with_slope(double radius, double tan_pitch) const;

  /// Largest power at the converter's input over a loop of `resistance`.
  [[nodiscard]] double available_power(double resistance) const {
    return deliverable_ / resistance;
  }
  /// Thrust the motors make of `available_power` at the converter's input.
  [[nodiscard]] double available_thrust(double available_power) const;

  /// Radius at which the available power is exactly `power`: 0 for power ≤ 0, +infinity where
  /// contacts alone keep it lower.
  [[nodiscard]] double radius_of_available_power(double power) const {
    if (!(power > 0)) return 0;
    // P = deliverable/(R_contact + resistance_area/r²), solved for r.
    const double line = deliverable_ - contact_resistance_ * power;
    return line > 0 ? std::sqrt(resistance_area_ * power / line)
                    : std::numeric_limits<double>::infinity();
  }

  /// Power at the converter's input for a thrust, +infinity where the motors cannot make it.
  [[nodiscard]] double drone_power(double thrust) const {
    return input_power(design_->drone.motor.power(thrust));
  }
  /// The same for one motor's data-sheet power in W.
  [[nodiscard]] double input_power(double motor_power) const {
    return converter_input_power(design_->supply.converter, power_scale_ * motor_power) +
           design_->drone.auxiliary_power;
  }
  /// Power at the converter's output for one motor's data-sheet power.
  [[nodiscard]] double output_power(double motor_power) const { return power_scale_ * motor_power; }

  /// The design this was made of.
  [[nodiscard]] const Design& design() const { return *design_; }

 private:
  void set_airspeed(double speed);
  [[nodiscard]] double balanced_tan_pitch(double radius, double tan_limit, double guess) const;

  const Design* design_;
  double drone_mass_;  ///< with the winch's pull as mass
  double wall_;
  double airspeed_;
  double mass_0_, mass_1_, mass_2_;  ///< tether mass = mass_0 + mass_1·r + mass_2·r²
  double contact_resistance_;
  double resistance_area_;  ///< Ω·m², (R − R_contact)·r²
  double weight_per_mass_;  ///< gravity, m/s²
  double area_force_factor_;
  double tether_drag_0_, tether_drag_1_;  ///< tether drag = tether_drag_0 + tether_drag_1·r, N
  double pitch_sign_;
  double tan_pitch_limit_;
  double deliverable_;  ///< V², P_avail·R
  double per_motor_;    ///< one over the number of motors
  double power_scale_;  ///< converter output per data-sheet power of one motor: n·f
};

}  // namespace tethercalc
