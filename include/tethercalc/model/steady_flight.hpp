// A design in one flight state, prepared for many conductor sizes.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "tethercalc/model/design.hpp"
#include "tethercalc/model/tether_load.hpp"

namespace tethercalc {

/// Everything that steady flight needs as a function of the conductor's radius r, with what does
/// not depend on r computed once: what the motors lift, the tilt at which thrust, weight and drag
/// balance, the thrust that takes, the power for it, and the power that arrives. Resistances are
/// those at the tether's `conductor_temperature_C`; the heat balance, where one is asked for, is
/// `evaluate`'s. Operating points, solvers and diagnoses share these functions, so that they cannot
/// disagree. Refers to the design, which must outlive it.
///
/// Radii are in m and positive; thrusts are in N per motor; powers in W; masses in kg.
class SteadyFlight {
 public:
  /// Prepares `design` for `state`. The design is taken as valid: no check is made here.
  SteadyFlight(const Design& design, const FlightState& state,
               ConductorsAsked asked = ConductorsAsked::many);

  /// The same for `flight_state(design, condition)`.
  SteadyFlight(const Design& design, Condition condition,
               ConductorsAsked asked = ConductorsAsked::many);

  /// The design was made for longer than this.
  SteadyFlight(Design&&, const FlightState&) = delete;
  SteadyFlight(Design&&, Condition) = delete;

  /// The same design in another condition, sooner than from the design. Only for a flight that was
  /// made for a condition.
  [[nodiscard]] SteadyFlight in(Condition condition) const;

  /// The design this was made of.
  [[nodiscard]] const Design& design() const { return *design_; }
  /// What flies, with its motors' curve as it is in the air of this flight (`motor_in_flight`).
  [[nodiscard]] const Drone& drone() const { return rescaled_ ? *rescaled_ : design_->drone; }
  /// The curve of one motor in this air.
  [[nodiscard]] const MotorCurve& motor() const { return drone().motor; }
  /// The state it flies in.
  [[nodiscard]] const FlightState& state() const { return state_; }
  /// Its tether.
  [[nodiscard]] const TetherInFlight& tether() const { return tether_; }
  /// Wall of the insulation in m, as the supply voltage asks for.
  [[nodiscard]] double wall() const { return wall_; }

  // --- Mass and weight ---

  /// Mass of the reserve battery, which the design's whole tether decides, whatever is in the air;
  /// +infinity where none can carry itself, 0 without one.
  [[nodiscard]] double battery_mass(double radius) const {
    return has_battery_ ? sized_battery(radius) : 0;
  }
  /// Mass of all that flies: drone, converter, battery, and the tether in the air.
  [[nodiscard]] double takeoff_mass(double radius) const {
    return takeoff_mass(radius, battery_mass(radius));
  }
  /// The same with that battery's mass known.
  [[nodiscard]] double takeoff_mass(double radius, double battery_mass) const {
    return fixed_mass_ + tether_.mass(radius) + battery_mass;
  }
  /// N that the motors lift: the weight of all that flies, and what the tether pulls down beyond
  /// its own. +infinity where it cannot hang.
  [[nodiscard]] double weight(double radius) const { return lifted(radius, takeoff_mass(radius)); }
  /// The weight of drone and converter alone, N.
  [[nodiscard]] double lifted_without_tether() const { return fixed_mass_ * gravity_; }
  /// The same for a take-off mass in kg.
  [[nodiscard]] double lifted(double radius, double takeoff_mass) const {
    return takeoff_mass < std::numeric_limits<double>::infinity()
               ? takeoff_mass * gravity_ + tether_.pull_beyond_weight(radius)
               : takeoff_mass;
  }
  /// The largest radius, up to 1 m, at which motors that pull with `weight` N lift the drone in
  /// still air; negative where even the thinnest tether is heavier. For a design in one of its
  /// conditions.
  [[nodiscard]] double radius_of_weight(double weight) const;

  /// N of all motors together at the end of their curve.
  [[nodiscard]] double full_thrust() const { return drone().motor_count * motor().max_thrust(); }

  /// The piece of the motor curve that the landing from the reserve battery decides its mass on; 0
  /// without a battery.
  [[nodiscard]] std::size_t battery_piece(double radius) const;

  /// Whether wind blows as the battery lands it.
  [[nodiscard]] bool lands_in_wind() const { return has_battery_ && landing_.windy; }

  // --- Balance of forces ---

  /// Tangent of the tilt's magnitude with motors that lift `weight`, as `weight(radius)` has it;
  /// +infinity beyond `tan_limit`. `guess` saves iterations.
  [[nodiscard]] double tan_pitch(double radius, double weight, double tan_limit,
                                 double guess = 0) const;
  /// The same of a tether that drags with `tether_drag` N, whatever it is taken for here.
  [[nodiscard]] double tan_pitch_against(double tether_drag, double weight, double tan_limit,
                                         double guess = 0) const;
  /// First approximation of `tan_pitch`: with the drag of the level drone.
  [[nodiscard]] double level_drag_tan_pitch(double radius, double weight) const {
    return (area_force_factor_ * design_->drone.drag.front_area + tether_.drag(radius)) / weight;
  }
  /// Sign of the tilt: −1 flying backward through the air, else +1.
  [[nodiscard]] double pitch_sign() const { return state_.airspeed < 0 ? -1 : 1; }
  /// Tangent of the design's largest allowed tilt.
  [[nodiscard]] double tan_pitch_limit() const { return tan_pitch_limit_; }
  /// N at the tilt limit against the motion, but for the tether's share.
  [[nodiscard]] double airframe_drag_at_pitch_limit() const {
    return area_force_factor_ * effective_area(design_->drone.drag, tan_pitch_limit_);
  }

  /// A range of radii, open at both ends and empty where lo ≥ hi.
  struct Radii {
    double lo = 0;  ///< m
    double hi = 0;  ///< m
  };
  /// The radii at which the tilt exceeds its limit with a straight tether and without a reserve
  /// battery, whose weight only lessens it. (Weight grows with r², tether drag with r: there is at
  /// most one such range.)
  [[nodiscard]] Radii beyond_pitch_limit() const;

  /// A thrust of one motor and how it changes with the radius.
  struct Thrust {
    double value = 0;      ///< N
    double slope = 0;      ///< N/m
    double tan_slope = 0;  ///< derivative of the tangent of the tilt, 1/m
  };
  /// Thrust that holds `weight` at a tilt with tangent `tan_pitch`: weight/(n·cosθ).
  [[nodiscard]] double necessary_thrust(double weight, double tan_pitch) const {
    return weight * std::sqrt(1 + tan_pitch * tan_pitch) * per_motor_;
  }
  /// The least tangent that the tilt may have at radii between two, with a weight that is less by
  /// `lighter` N and `of_drag` times the tether's drag: of a solved tether, whose load may fall as
  /// the radius grows.
  [[nodiscard]] double least_tan_pitch(const Radii& between, double lighter = 0,
                                       double of_drag = 1) const;
  /// The greatest that it may have there, likewise.
  [[nodiscard]] double most_tan_pitch(const Radii& between, double lighter = 0,
                                      double of_drag = 1) const;

  /// Tilt and thrust of the equilibrium, where no limit holds the tilt.
  struct Balance {
    double tan_pitch = 0;       ///< of the tilt
    Thrust thrust;              ///< N per motor, and how it changes
    double landing_thrust = 0;  ///< N of one motor as the battery lands it; 0 without
  };
  /// The balance at `radius`; `tan_guess` saves iterations.
  [[nodiscard]] Balance balance(double radius, double tan_guess) const {
    const Weight weight = weighed(radius);
    constexpr double none = std::numeric_limits<double>::infinity();
    if (weight.value == none) return {none, {none, 0, 0}, weight.landing_thrust};
    const double tangent =
        tan_pitch(radius, weight.value, std::numeric_limits<double>::infinity(), tan_guess);
    return {tangent, thrust_of(radius, weight, tangent), weight.landing_thrust};
  }

  // --- Power ---

  /// Largest power at the converter's input over a loop of `resistance`.
  [[nodiscard]] double available_power(double resistance) const {
    return deliverable_ / resistance;
  }
  /// Thrust the motors make of `available_power` at the converter's input, which gives no more than
  /// its rated output.
  [[nodiscard]] double available_thrust(double available_power, double share) const;

  /// The most thrust of one motor that converter and motors have, whatever arrives.
  [[nodiscard]] double most_thrust(double share) const { return available_thrust(1e300, share); }

  /// Radius at which the available power is exactly `power`: 0 for power ≤ 0, +infinity where
  /// contacts alone keep it lower.
  [[nodiscard]] double radius_of_available_power(double power) const {
    if (!(power > 0)) return 0;
    // P = deliverable/(R_contact + resistance_area/r²), solved for r.
    if (tether_.is_solved()) return tether_.radius_of_resistance(deliverable_ / power);
    const double line = deliverable_ - tether_.contact_resistance() * power;
    return line > 0 ? std::sqrt(tether_.straight().resistance_area() * power / line)
                    : std::numeric_limits<double>::infinity();
  }

  /// The share of the motors' data-sheet power that a thrust takes in this air, leaning with
  /// `tan_pitch`; see `translational_lift_share`. It grows with the tilt.
  [[nodiscard]] PowerShare power_share(double tan_pitch) const {
    return share_changes_
               ? translational_lift_share(drone().translational_lift, state_.airspeed, tan_pitch)
               : PowerShare{};
  }
  /// Whether it depends on the tilt, and with it on the radius.
  [[nodiscard]] bool share_changes() const { return share_changes_; }

  /// Power at the converter's input for a thrust, +infinity where the motors cannot make it. Here
  /// and below `share` is a `power_share`.
  [[nodiscard]] double drone_power(double thrust, double share) const {
    return input_power(motor().power(thrust), share);
  }
  /// The same for one motor's data-sheet power in W.
  [[nodiscard]] double input_power(double motor_power, double share) const {
    return converter_input_power(design_->supply.converter, output_power(motor_power, share)) +
           design_->drone.auxiliary_power;
  }
  /// Power at the converter's output for one motor's data-sheet power.
  [[nodiscard]] double output_power(double motor_power, double share) const {
    return power_scale_ * share * motor_power;
  }

 private:
  void set_airspeed(double speed);
  /// N, and N/m of the radius.
  struct Weight {
    double value = 0;
    double slope = 0;
    double landing_thrust = 0;  ///< as in a `Balance`
  };
  [[nodiscard]] Weight weighed(double radius) const;
  [[nodiscard]] Thrust thrust_of(double radius, Weight weight, double tan_pitch) const;
  [[nodiscard]] ForceBalance force_balance(double tether_drag, double weight) const;
  [[nodiscard]] double sized_battery(double radius) const;
  [[nodiscard]] double searched_radius(double weight) const;
  /// The radius at which the battery takes the drone to `takeoff` kg, or to what its motors hold
  /// where that is less, unless its mass leaps there.
  [[nodiscard]] double radius_of_takeoff(double takeoff, double start) const;
  /// The largest radius between two up to which the motors lift no more than `weight`.
  [[nodiscard]] double radius_between(double weight, double light, double heavy) const;
  /// kg that the battery lands, but for its own.
  [[nodiscard]] double mass_without_battery_at(double radius) const;

  /// A landing from the height and in the wind of the design, whatever the state of this flight.
  struct LandingInWind {
    Landing beside_tether;
    double least_drag = 0;  ///< N of the whole tether without thickness of metal
    double drag_slope = 0;  ///< N/m, what it gains with the radius
    bool windy = false;
  };
  static LandingInWind landing_in_wind(const Design& design, double wall);
  [[nodiscard]] Landing landing(double radius) const;

  const Design* design_;
  std::shared_ptr<const Drone> rescaled_;  ///< null where the motors' curve counts as it stands
  FlightState state_;
  double wall_;
  TetherInFlight tether_;
  double fixed_mass_;  ///< drone and converter
  bool has_battery_;
  LandingInWind landing_;  ///< where there is a battery
  double gravity_;         ///< m/s²
  double area_force_factor_;
  double tan_pitch_limit_;
  double deliverable_;  ///< V², P_avail·R
  double per_motor_;    ///< one over the number of motors
  double power_scale_;  ///< converter output per data-sheet power of one motor: n·f
  bool share_changes_;
};

}  // namespace tethercalc
