#include "tethercalc/model/steady_flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

using std::numbers::pi;

/// Larger root of a·x² + b·x + c with a ≥ 0, b ≥ 0, c < 0, without cancellation.
double positive_root(double a, double b, double c) {
  return -2 * c / (b + std::sqrt(b * b - 4 * a * c));
}

}  // namespace

double airspeed(const Design& design, Condition condition) {
  const Flight& flight = design.flight;
  return condition == Condition::hover ? flight.headwind : flight.airspeed + flight.headwind;
}

SteadyFlight::SteadyFlight(const Design& design, Condition condition)
    : design_(&design),
      drone_mass_(design.drone.mass + converter_mass(design.supply.converter) +
                  design.tether.winch_pull / design.flight.gravity),
      wall_(insulation_wall(design.tether.insulation, design.supply.voltage)),
      airspeed_(tethercalc::airspeed(design, condition)),
      contact_resistance_(design.tether.contact_resistance),
      weight_per_mass_(design.flight.gravity),
      tan_pitch_limit_(std::tan(design.requirements.max_pitch)),
      per_motor_(1.0 / design.drone.motor_count),
      power_scale_(design.drone.motor_count * design.drone.motor_power_factor) {
  const Tether& tether = design.tether;
  const StrengthMemberData member = strength_member_data(tether.strength_member);
  const double insulation = 2 * tether.length * tether.insulation.density * pi * wall_;
  mass_0_ = insulation * wall_ + tether.length * member.mass_per_metre;
  mass_1_ = 2 * insulation;
  mass_2_ = 2 * tether.length * tether.conductor.density * pi;
  resistance_area_ = 2 * (tether.length + tether.spooled_length) * resistivity(tether) / pi;

  deliverable_ = tethercalc::available_power(design.supply.voltage,
                                             lowest_input_voltage(design.supply.converter), 1.0);
  set_airspeed(tethercalc::airspeed(design, condition));
}

SteadyFlight SteadyFlight::in(Condition condition) const {
  SteadyFlight other = *this;
  other.set_airspeed(tethercalc::airspeed(*design_, condition));
  return other;
}

void SteadyFlight::set_airspeed(double speed) {
  const Tether& tether = design_->tether;
  const double density = design_->flight.air_density;
  airspeed_ = speed;
  power_scale_ = design_->drone.motor_count * design_->drone.motor_power_factor *
                 translational_lift_factor(design_->drone.translational_lift, speed);
  area_force_factor_ = area_force_factor(design_->drone.drag, density, speed);
  tether_drag_1_ = 0.5 * density * speed * speed * tether.drag_coefficient *
                   tether.projection_factor * 4 * tether.length;
  tether_drag_0_ =
      tether_drag_1_ * (wall_ + 0.25 * strength_member_data(tether.strength_member).diameter);
  pitch_sign_ = speed < 0 ? -1 : 1;
}

double SteadyFlight::resistance(double radius, double temperature_C) const {
  const Tether& tether = design_->tether;
  return contact_resistance_ + 2 * (tether.length + tether.spooled_length) *
                                   resistivity(tether.conductor, temperature_C) /
                                   (pi * radius * radius);
}

double SteadyFlight::radius_of_mass(double mass) const {
  const double rest = drone_mass_ + mass_0_ - mass;
  return rest < 0 ? positive_root(mass_2_, mass_1_, rest) : -1;
}

double SteadyFlight::radius_of_resistance(double resistance) const {
  const double line = resistance - contact_resistance_;
  return line > 0 ? std::sqrt(resistance_area_ / line) : std::numeric_limits<double>::infinity();
}

double SteadyFlight::balanced_tan_pitch(double radius, double tan_limit, double guess) const {
  const AirframeDrag& drag = design_->drone.drag;
  return equilibrium_tan_pitch(
      {takeoff_mass(radius) * weight_per_mass_, area_force_factor_,
       tether_drag_0_ + tether_drag_1_ * radius, drag.front_area, drag.top_area},
      tan_limit, guess);
}

SteadyFlight::Radii SteadyFlight::beyond_pitch_limit() const {
  // The tilt exceeds its limit where weight·t_max < drag at t_max: a·r² + b·r + c < 0.
  const double t = tan_pitch_limit_;
  const double a = weight_per_mass_ * mass_2_ * t;
  const double b = weight_per_mass_ * mass_1_ * t - tether_drag_1_;
  const double c = weight_per_mass_ * (drone_mass_ + mass_0_) * t - tether_drag_0_ -
                   area_force_factor_ * effective_area(design_->drone.drag, t);
  if (b >= 0 && c >= 0) return {};  // as in hover
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return {};
  const double root = std::sqrt(discriminant);
  // The root without cancellation first, the other from their product.
  const double far = b > 0 ? -(b + root) / (2 * a) : (root - b) / (2 * a);
  const double near = c / (a * far);
  return {std::max(0.0, std::min(far, near)), std::max(0.0, std::max(far, near))};
}

SteadyFlight::Thrust SteadyFlight::necessary_thrust_with_slope(double radius,
                                                               double tan_pitch) const {
  const AirframeDrag& drag = design_->drone.drag;
  const double weight = takeoff_mass(radius) * weight_per_mass_;
  const double weight_slope = mass_slope(radius) * weight_per_mass_;
  const double secant_squared = 1 + tan_pitch * tan_pitch;
  const double secant = std::sqrt(secant_squared);
  // The force balance W·t − q·g(t) − F_t = 0, differentiated by r: tan_slope/secant.
  const double tan_slope_cosine =
      (tether_drag_1_ - weight_slope * tan_pitch) * secant_squared /
      (weight * secant_squared * secant -
       area_force_factor_ * (drag.top_area - drag.front_area * tan_pitch));
  return {weight * secant * per_motor_,
          (weight_slope * secant + weight * tan_pitch * tan_slope_cosine) * per_motor_,
          tan_slope_cosine * secant};
}

double SteadyFlight::available_thrust(double available_power) const {
  double output = converter_output_power(design_->supply.converter,
                                         available_power - design_->drone.auxiliary_power);
  const Converter& converter = design_->supply.converter;
  if (converter.rated_output_power) output = std::min(output, *converter.rated_output_power);
  return design_->drone.motor.thrust(output / power_scale_);
}

}  // namespace tethercalc
