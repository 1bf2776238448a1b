// Notation: r conductor radius; T necessary thrust per motor; R loop resistance; I tether current.

#include "tethercalc/solve/minimum_power.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <vector>

#include "model/constants.hpp"
#include "solve/valley_search.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/tether_heat.hpp"

namespace tethercalc {
namespace {

/// +infinity where the motors cannot make the thrust or the line cannot deliver the power.
double total_power(const SteadyFlight& flight, const WarmTether& tether, const ThrustAt& at) {
  const double voltage = flight.design().supply.voltage;
  const double power = flight.drone_power(at.thrust.value);
  if (is_heated(flight.design().tether)) {
    const TetherHeatState state = tether.state(power, at.radius, at.radius);
    return state.steady ? state.current * voltage : infinity;
  }
  const double total = supplied_power(voltage, flight.tether().resistance(at.radius), power);
  return total > 0 ? total : infinity;
}

/// The least power between two radii, by the bound that it is no less than that of the drone at the
/// lower over the cold resistance at the upper. Stretches on which that may be less than the best
/// known are split until they are one valley.
class LeastPowerSearch {
 public:
  LeastPowerSearch(const SteadyFlight& flight, const WarmTether& tether, const ThrustAt& first)
      : flight_(flight), tether_(tether) {
    consider(first);
  }

  void search(const ThrustAt& a, const ThrustAt& b) {
    consider(a);
    consider(b);
    improve(a, b);
  }

  void consider(const ThrustAt& candidate) {
    const double power = total_power(flight_, tether_, candidate);
    if (power < power_) {
      power_ = power;
      best_ = candidate;
    }
  }

  [[nodiscard]] const ThrustAt& best() const { return best_; }
  [[nodiscard]] double power() const { return power_; }

 private:
  void improve(const ThrustAt& a, const ThrustAt& b) {
    constexpr int most_stretches = 5000;  // a hundred times more than usual
    constexpr double same_radius = 1 + 1e-13;
    const MotorCurve& motor = flight_.design().drone.motor;
    if (!(b.radius > a.radius * same_radius) || ++stretches_ > most_stretches) return;
    const auto power_over = [&](double resistance) {
      return supplied_power(flight_.design().supply.voltage, resistance,
                            flight_.drone_power(a.thrust.value));
    };
    if (!(power_over(flight_.tether().resistance(b.radius)) < power_)) return;
    if (!(power_over(least_resistance(tether_, flight_, a.radius, a.thrust.value, b.radius)) <
          power_)) {
      return;
    }
    if (one_valley(a, b)) {
      const Pieces pieces = pieces_between(motor, a.thrust.value, b.thrust.value);
      return consider(valley_bottom(flight_, tether_, motor, pieces, {a.radius, b.radius}, a));
    }
    const ThrustAt middle = split(a, b);
    consider(middle);
    // The more promising side first.
    const bool right = best_.radius > middle.radius;
    if (right) improve(middle, b);
    improve(a, middle);
    if (!right) improve(middle, b);
  }

  /// At a kink between a and b, if there is one, else half-way.
  [[nodiscard]] ThrustAt split(const ThrustAt& a, const ThrustAt& b) const {
    const MotorCurve& motor = flight_.design().drone.motor;
    const Pieces pieces = pieces_between(motor, a.thrust.value, b.thrust.value);
    double thrust = motor.vertices()[pieces.first + (pieces.last - pieces.first + 1) / 2].thrust;
    if (motor.is_convex() || pieces.first == pieces.last) {
      const double per_output = 1 / flight_.output_power(1);
      thrust = motor.thrust(per_output *
                            converter_kink(flight_.design().supply.converter,
                                           flight_.output_power(motor.power(a.thrust.value)),
                                           flight_.output_power(motor.power(b.thrust.value))));
    }
    if (a.thrust.value < thrust && thrust < b.thrust.value) {
      const ThrustAt kink = at_thrust(flight_, thrust, a.radius, b.radius, a);
      if (a.radius < kink.radius && kink.radius < b.radius) return kink;
    }
    const double radius = std::sqrt(a.radius * b.radius);
    return thrust_at(flight_, radius, a.tan_guess(radius));
  }

  [[nodiscard]] bool one_valley(const ThrustAt& a, const ThrustAt& b) const {
    if (!smooth_but_for_motors(a, b)) return false;
    // Nothing is proved of warm cables, but their power bends no more sharply than its parts.
    constexpr double narrow = 1.5;
    constexpr double very_narrow = 1.01;
    if (is_heated(flight_.design().tether)) {
      const bool steady = total_power(flight_, tether_, a) < infinity &&
                          total_power(flight_, tether_, b) < infinity;
      return b.radius < (steady ? narrow : very_narrow) * a.radius;
    }
    if (is_proportional(flight_.design().supply.converter)) return true;
    // Where the slope vanishes, the power bends up by 3/r for the losses, and down by what the
    // efficiency gains twice over where it rises with the load.
    const MotorCurve& motor = flight_.design().drone.motor;
    const double lo = motor.power(a.thrust.value);
    const double hi = motor.power(b.thrust.value);
    const Converter& converter = flight_.design().supply.converter;
    const double low = efficiency_at(converter, flight_.output_power(lo));
    const double high = efficiency_at(converter, flight_.output_power(hi));
    const double gain = std::max(0.0, (high - low) / (hi - lo));
    const double more_power =
        motor.slope(pieces_between(motor, a.thrust.value, b.thrust.value).last) * b.thrust.slope;
    return b.radius < narrow * a.radius || !(3 * low < 2 * gain * more_power * b.radius);
  }

  /// A convex motor curve keeps one valley one.
  [[nodiscard]] bool smooth_but_for_motors(const ThrustAt& a, const ThrustAt& b) const {
    const Design& design = flight_.design();
    const MotorCurve& motor = design.drone.motor;
    if (!motor.is_convex()) return on_one_piece(flight_, a, b);
    return std::isnan(converter_kink(design.supply.converter,
                                     flight_.output_power(motor.power(a.thrust.value)),
                                     flight_.output_power(motor.power(b.thrust.value))));
  }

  const SteadyFlight& flight_;
  const WarmTether& tether_;
  ThrustAt best_;
  double power_ = infinity;
  int stretches_ = 0;
};

/// About the radius at which the loss saved by more conductor, I²·2(R − R_contact)/r, equals the
/// power spent on carrying it. `thrust` and `power` are about those at the radius `lightest`.
double first_guess(const SteadyFlight& flight, double lightest, double thrust, double power) {
  const Design& design = flight.design();
  const MotorCurve& motor = design.drone.motor;
  const double voltage = design.supply.voltage;
  // With the current and the price of thrust of the lightest tether, and as if only the conductor
  // had mass: r⁴ = I²·saved/(price·curvature).
  const double current = power / voltage;
  const double price = (flight.input_power(1) - flight.input_power(0)) *
                       motor.slope(motor.piece(thrust)) * design.flight.gravity /
                       design.drone.motor_count;
  const double saved = -flight.tether().resistance_slope(1);
  const double bare =
      std::sqrt(current * std::sqrt(saved / (price * flight.tether().mass_curvature())));
  // Then with the insulation's mass, the loss in the line and the weight there; a propeller's power
  // grows with thrust to the 3/2.
  const double share = flight.tether().mass_curvature() * bare / flight.tether().mass_slope(bare);
  const double growth = flight.weight(bare) / flight.weight(lightest);
  const double root_growth = std::sqrt(growth);
  const double supplied =
      supplied_power(voltage, flight.tether().resistance(bare), power * growth * root_growth);
  const double more_current = supplied > 0 ? supplied / power : 2;
  return bare * std::sqrt(more_current * std::sqrt(share / root_growth));
}

/// Whether the power over the convex hull of the motor curve is one valley, all along the radius.
bool hull_is_one_valley(const Design& design) {
  return is_proportional(design.supply.converter) && !is_heated(design.tether) &&
         design.drone.reserve_battery.specific_energy == 0;
}

MinimumPower minimum_within_tilt(const SteadyFlight& flight, Interval radii) {
  const MinimumPower none{nan, nan};
  const Design& design = flight.design();
  const MotorCurve& motor = design.drone.motor;
  // Thick enough to deliver what the lightest tether needs in still air, light enough for the
  // motors there.
  const double lightest = radii.lo;
  radii.hi =
      std::min(radii.hi, flight.radius_of_weight(design.drone.motor_count * motor.max_thrust()));
  if (!(lightest <= radii.hi)) return none;
  const double hover_power = flight.drone_power(flight.necessary_thrust(lightest, 0));
  if (!(hover_power < infinity)) return none;
  const double voltage = design.supply.voltage;
  radii.lo = std::max(lightest,
                      flight.tether().radius_of_resistance(voltage * voltage / (4 * hover_power)));
  if (!(radii.lo <= radii.hi)) return none;

  const double thrust = std::min(
      motor.max_thrust(), flight.necessary_thrust(lightest, flight.level_drag_tan_pitch(lightest)));
  const double guess = first_guess(flight, lightest, thrust, flight.drone_power(thrust));
  const double start = guess > radii.lo && guess < radii.hi ? guess : 0.5 * (radii.lo + radii.hi);
  const MotorCurve& convex = motor.convex_hull();
  const WarmTether tether(flight);
  ThrustAt best = thrust_at(flight, start, 0);
  const bool one_valley = hull_is_one_valley(design);
  if (one_valley) {
    best = valley_bottom(flight, tether, convex, {0, convex.vertices().size() - 2, 0}, radii, best);
  }
  LeastPowerSearch search(flight, tether, best);
  if (!(search.power() < infinity) || !one_valley ||
      motor.power(best.thrust.value) > convex.power(best.thrust.value)) {
    const ThrustAt first = thrust_at(flight, radii.lo, 0);
    if (!(first.thrust.value <= motor.max_thrust() * (1 + 1e-12))) return none;
    ThrustAt last = thrust_at(flight, radii.hi, best.tan_pitch);
    if (last.thrust.value > motor.max_thrust()) {
      last = at_thrust(flight, motor.max_thrust(), radii.lo, radii.hi, last);
    }
    search.search(first, last);
  }
  if (!(search.power() < infinity)) return none;
  // The root of a square may miss its end by rounding, beyond which a warm cable runs away or a
  // reserve battery grows by leaps.
  const double area = conductor_area(search.best().radius);
  for (const double inside : {area, std::nextafter(area, 0), std::nextafter(area, 1),
                              area * (1 - 1e-15), area * (1 + 1e-15)}) {
    if (one_valley) break;
    const ThrustAt there = thrust_at(flight, conductor_radius(inside), search.best().tan_pitch);
    if (total_power(flight, tether, there) <= search.power() * (1 + 1e-9))
      return {inside, search.power()};
  }
  return {area, search.power()};
}

}  // namespace

MinimumPower lesser(const MinimumPower& a, const MinimumPower& b) {
  return a.power <= b.power || std::isnan(b.power) ? a : b;
}

bool is_cheapest_beyond(const SteadyFlight& flight, double area) {
  if (!hull_is_one_valley(flight.design())) return false;
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  if (beyond.lo < beyond.hi) return false;
  const MotorCurve& motor = flight.design().drone.motor;
  if (motor.is_convex()) return true;
  const double radius = conductor_radius(area);
  const double thrust = flight.necessary_thrust(radius, flight.tan_pitch(radius, infinity));
  constexpr double rounding = 1e-14;
  return motor.power(thrust) <= motor.convex_hull().power(thrust) * (1 + rounding);
}

MinimumPower minimum_power(const SteadyFlight& flight, Interval within) {
  const double heaviest = flight.radius_of_weight(flight.design().drone.motor_count *
                                                  flight.design().drone.motor.max_thrust());
  const Interval radii{conductor_radius(within.lo), conductor_radius(within.hi)};
  MinimumPower best{nan, nan};
  for (const Interval& part : intersection({radii}, radii_within_tilt(flight, heaviest))) {
    best = lesser(best, minimum_within_tilt(flight, part));
  }
  // Squaring the root of an end of the range may miss it by rounding.
  if (best.power > 0) best.area = std::clamp(best.area, within.lo, within.hi);
  return best;
}

}  // namespace tethercalc
