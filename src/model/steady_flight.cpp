#include "tethercalc/model/steady_flight.hpp"

#include <algorithm>
#include <limits>

#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

/// Null where the curve of the motors is that of the design.
std::shared_ptr<const Drone> with_motors_in_flight(const Design& design) {
  const std::optional<double> measured = bench_air_density(design.drone);
  if (!measured || *measured == design.flight.air_density) return nullptr;
  return std::make_shared<const Drone>(drone_in_flight(design));
}

}  // namespace

SteadyFlight::SteadyFlight(const Design& design, const FlightState& state, ConductorsAsked asked)
    : design_(&design),
      rescaled_(with_motors_in_flight(design)),
      state_(state),
      wall_(insulation_wall(design.tether.insulation, design.supply.voltage)),
      tether_(design.tether, wall_, state, design.flight, asked),
      fixed_mass_(design.drone.mass + converter_mass(design.supply.converter)),
      has_battery_(design.drone.reserve_battery.specific_energy > 0),
      gravity_(design.flight.gravity),
      tan_pitch_limit_(std::tan(design.requirements.max_pitch)),
      per_motor_(1.0 / design.drone.motor_count) {
  deliverable_ = tethercalc::available_power(design.supply.voltage,
                                             lowest_input_voltage(design.supply.converter), 1.0);
  set_airspeed(state.airspeed);
  if (has_battery_) landing_ = landing_in_wind(design, wall_);
}

SteadyFlight::SteadyFlight(const Design& design, Condition condition, ConductorsAsked asked)
    : SteadyFlight(design, flight_state(design, condition), asked) {}

SteadyFlight SteadyFlight::in(Condition condition) const {
  SteadyFlight other = *this;
  other.state_ = flight_state(*design_, condition);
  other.tether_.set_state(other.state_, design_->flight);
  other.set_airspeed(other.state_.airspeed);
  return other;
}

void SteadyFlight::set_airspeed(double speed) {
  const Drone& drone = design_->drone;
  power_scale_ = drone.motor_count * drone.motor_power_factor;
  share_changes_ = drone.translational_lift.induced_share > 0 && speed != 0;
  area_force_factor_ = area_force_factor(drone.drag, design_->flight.air_density, speed);
}

SteadyFlight::LandingInWind SteadyFlight::landing_in_wind(const Design& design, double wall) {
  LandingInWind landing;
  landing.beside_tether = {.height = design.tether.length, .gravity = design.flight.gravity};
  const FlightState state = flight_state(design, Condition::hover);
  if (state.airspeed == 0) return landing;
  const Drone& drone = design.drone;
  landing.beside_tether.area_force_factor =
      area_force_factor(drone.drag, design.flight.air_density, state.airspeed);
  landing.beside_tether.airspeed = state.airspeed;
  const StraightTether tether(design.tether, wall, state, design.flight.air_density,
                              design.flight.gravity);
  landing.least_drag = tether.least_drag();
  landing.drag_slope = tether.drag_slope();
  landing.windy = true;
  return landing;
}

Landing SteadyFlight::landing(double radius) const {
  Landing landing = landing_.beside_tether;
  landing.tether_drag = landing_.least_drag + landing_.drag_slope * radius;
  return landing;
}

double SteadyFlight::mass_without_battery_at(double radius) const {
  return fixed_mass_ + tether_.straight().mass_of(design_->tether.length, radius);
}

double SteadyFlight::sized_battery(double radius) const {
  return reserve_battery_mass(drone(), mass_without_battery_at(radius), landing(radius));
}

std::size_t SteadyFlight::battery_piece(double radius) const {
  if (!has_battery_) return 0;
  const double landed = mass_without_battery_at(radius) + sized_battery(radius);
  if (!(landed < std::numeric_limits<double>::infinity())) {
    return motor().piece(landed);
  }
  return motor().piece(landing_thrust(drone(), landed, landing(radius)));
}

SteadyFlight::Weight SteadyFlight::weighed(double radius) const {
  const double slope = tether_.down_slope(radius);
  const double mass = fixed_mass_ + tether_.mass(radius);
  if (!has_battery_) return {lifted(radius, mass), slope};
  const Landing landing = this->landing(radius);
  const double bare = mass_without_battery_at(radius);
  const double battery = reserve_battery_mass(drone(), bare, landing);
  const double weight = lifted(radius, mass + battery);
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (!(battery < unlimited)) return {weight, slope, unlimited};
  const BatteryGrowth growth = reserve_battery_growth(drone(), bare + battery, landing);
  const double carried = tether_.straight().mass_slope(radius) * gravity_;
  const double blown = landing_.drag_slope * growth.by_drag * gravity_;
  const double grown =
      tether_.is_solved() ? slope + carried * growth.by_mass : slope * (1 + growth.by_mass);
  return {weight, grown + blown, growth.thrust};
}

double SteadyFlight::radius_of_weight(double weight) const {
  if (tether_.is_solved() || lands_in_wind()) return searched_radius(weight);
  const double takeoff = (weight - tether_.straight().winch_pull()) / gravity_;
  return tether_.straight().radius_of_mass(
      mass_without_battery(drone(), takeoff, design_->tether.length, gravity_) - fixed_mass_);
}

double SteadyFlight::searched_radius(double limit) const {
  constexpr double thinnest = 1e-6;
  if (!tether_.is_solved()) {
    // The thicker the heavier, and never lighter than without a battery.
    if (!(weight(thinnest) <= limit)) return -1;
    const StraightTether& tether = tether_.straight();
    const double takeoff = (limit - tether.winch_pull()) / gravity_;
    const double without_battery = tether.radius_of_mass(takeoff - fixed_mass_);
    if (!has_battery_) return radius_between(limit, thinnest, without_battery);
    const double guess = radius_of_takeoff(takeoff, without_battery);
    constexpr double rounding = 1e-12;
    if (weight(guess * (1 - rounding)) <= limit && !(weight(guess * (1 + rounding)) <= limit)) {
      return radius_between(limit, guess * (1 - rounding), guess * (1 + rounding));
    }
    return radius_between(limit, thinnest, without_battery);
  }
  const double thickest = std::min(1.0, tether_.radius_of_tension(limit));
  // From the thickest down, which is near: the cable's own weight is most of what it adds. Beyond
  // radii at which it cannot hang it may hang again.
  const double step = tether_.hangs_alike() ? 2 : hanging_step;
  double heavy = thickest;
  double light = thickest;
  while (light >= thinnest && !(weight(light) <= limit)) {
    heavy = light;
    light /= step;
  }
  if (light < thinnest) return -1;
  if (light == heavy) return heavy;
  if (!has_battery_ && weight(heavy) < std::numeric_limits<double>::infinity()) {
    return radius_between(limit, light, heavy);
  }
  // By ratios, then down to the last digit.
  while (heavy > light * (1 + 1e-3)) {
    const double middle = std::sqrt(light * heavy);
    (weight(middle) > limit ? heavy : light) = middle;
  }
  for (double middle = 0.5 * (light + heavy); middle > light && middle < heavy;
       middle = 0.5 * (light + heavy)) {
    (weight(middle) > limit ? heavy : light) = middle;
  }
  return light;
}

double SteadyFlight::radius_of_takeoff(double takeoff, double start) const {
  double radius = start;
  constexpr int most_steps = 20;  // the drag changes little with the radius
  for (int step = 0; step < most_steps; ++step) {
    const Landing landing = this->landing(radius);
    const double heaviest = std::min(takeoff, heaviest_landing(drone(), landing));
    const double bare = mass_beside_battery(drone(), heaviest, landing);
    const double before = radius;
    radius = tether_.straight().radius_of_mass(bare - fixed_mass_);
    if (!(std::abs(radius - before) > 1e-15 * radius)) break;
  }
  return radius;
}

double SteadyFlight::radius_between(double limit, double light, double heavy) const {
  // Newton's method in a bracket, which is halved where it leads out and, where it takes long,
  // every fourth step: a reserve battery may leap.
  constexpr int quick = 8;
  double radius = heavy;
  for (int step = 1; step < 300; ++step) {
    const Weight here = weighed(radius);
    (here.value > limit ? heavy : light) = radius;
    const double newton = radius + (limit - here.value) / here.slope;
    const bool inside = newton > light && newton < heavy && (step < quick || step % 4 != 0);
    const double middle = heavy > 4 * light ? std::sqrt(light * heavy) : 0.5 * (light + heavy);
    const double next = inside ? newton : middle;
    if (!(light < next && next < heavy)) break;
    if (inside && std::abs(next - radius) <= 1e-8 * radius) {
      // Exact but for rounding.
      for (double share = 0; share<1e-12; share = share> 0 ? 4 * share : 1e-16) {
        if (weight(next * (1 - share)) <= limit) return next * (1 - share);
      }
    }
    radius = next;
  }
  return light;
}

double SteadyFlight::tan_pitch(double radius, double weight, double tan_limit, double guess) const {
  const double against = tan_pitch_against(tether_.drag(radius), weight, tan_limit, guess);
  if (state_.wind_from == 0 || !(weight < std::numeric_limits<double>::infinity())) return against;
  const double tangent = std::hypot(against, tether_.across(radius) / weight);
  return tangent <= tan_limit ? tangent : std::numeric_limits<double>::infinity();
}

double SteadyFlight::tan_pitch_against(double tether_drag, double weight, double tan_limit,
                                       double guess) const {
  if (area_force_factor_ == 0 && tether_drag == 0) return 0;
  if (!(weight < std::numeric_limits<double>::infinity())) return weight;
  return equilibrium_tan_pitch(force_balance(tether_drag, weight), tan_limit, guess);
}

ForceBalance SteadyFlight::force_balance(double tether_drag, double weight) const {
  const AirframeDrag& drag = design_->drone.drag;
  return {weight, area_force_factor_, tether_drag, drag.front_area, drag.top_area};
}

SteadyFlight::Radii SteadyFlight::beyond_pitch_limit() const {
  // The tilt exceeds its limit where weight·t_max < drag at t_max: a·r² + b·r + c < 0.
  const double t = tan_pitch_limit_;
  const StraightTether& tether = tether_.straight();
  const double a = 0.5 * gravity_ * tether.mass_curvature() * t;
  const double b = gravity_ * tether.mass_slope(0) * t - tether.drag_slope();
  const double c = (gravity_ * (fixed_mass_ + tether.mass(0)) + tether.winch_pull()) * t -
                   tether.least_drag() - airframe_drag_at_pitch_limit();
  if (b >= 0 && c >= 0) return {};  // as in hover
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return {};
  const double root = std::sqrt(discriminant);
  // The root without cancellation first, the other from their product.
  const double far = b > 0 ? -(b + root) / (2 * a) : (root - b) / (2 * a);
  const double near = c / (a * far);
  return {std::max(0.0, std::min(far, near)), std::max(0.0, std::max(far, near))};
}

SteadyFlight::Thrust SteadyFlight::thrust_of(double radius, Weight weight, double tan_pitch) const {
  const InclinedThrust all = inclined_thrust(force_balance(tether_.drag(radius), weight.value),
                                             tan_pitch, weight.slope, tether_.drag_slope(radius));
  return {all.value * per_motor_, all.slope * per_motor_, all.tan_slope};
}

double SteadyFlight::least_tan_pitch(const Radii& between, double lighter, double of_drag) const {
  const double heaviest = weight(between.hi);
  if (!(heaviest < std::numeric_limits<double>::infinity())) return 0;
  ForceBalance balance = force_balance(tether_.drag(between.lo), heaviest + lighter);
  balance.tether_drag *= of_drag;
  return equilibrium_tan_pitch(balance, std::numeric_limits<double>::infinity());
}

double SteadyFlight::most_tan_pitch(const Radii& between, double lighter, double of_drag) const {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  const double least = weight(between.lo) - lighter;
  if (!(least > 0) || !(least < unlimited)) return unlimited;
  ForceBalance balance = force_balance(tether_.drag(between.hi), least);
  balance.tether_drag *= of_drag;
  return equilibrium_tan_pitch(balance, unlimited);
}

double SteadyFlight::available_thrust(double available_power, double share) const {
  double output = converter_output_power(design_->supply.converter,
                                         available_power - design_->drone.auxiliary_power);
  const Converter& converter = design_->supply.converter;
  if (converter.rated_output_power) output = std::min(output, *converter.rated_output_power);
  return motor().thrust(output / (power_scale_ * share));
}

}  // namespace tethercalc
