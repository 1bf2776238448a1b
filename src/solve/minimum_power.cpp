// Notation: r conductor radius; T necessary thrust per motor; R loop resistance; I tether current.

#include "tethercalc/solve/minimum_power.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "solve/valley_search.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double area_of(double radius) { return std::numbers::pi * radius * radius; }

/// +infinity where the motors cannot make the thrust or the line cannot deliver the power.
double total_power(const SteadyFlight& flight, const MotorCurve& motor, const ThrustAt& at) {
  const double total =
      supplied_power(flight.design().supply.voltage, flight.tether().resistance(at.radius),
                     flight.input_power(motor.power(at.thrust.value)));
  return total > 0 ? total : infinity;
}

/// The least power on the pieces of the measured curve between lo and hi on which the convex
/// curve's power, a lower bound with one valley at `start`, is below the best known.
ThrustAt search_outwards(const SteadyFlight& flight, const MotorCurve& measured,
                         const MotorCurve& convex, const ThrustAt& lo, const ThrustAt& hi,
                         const ThrustAt& start) {
  ThrustAt best = start;
  double least = total_power(flight, measured, start);
  const auto consider = [&](const ThrustAt& candidate) {
    const double power = total_power(flight, measured, candidate);
    if (power < least) {
      least = power;
      best = candidate;
    }
  };
  const std::size_t first = measured.piece(lo.thrust.value);
  const std::size_t last = measured.piece(hi.thrust.value);
  const std::size_t home = measured.piece(start.thrust.value);

  // Away from the valley's bottom a piece's own bottom is mostly at its nearer end: look there
  // first.
  const auto search_piece = [&](std::size_t piece, const ThrustAt& near, const ThrustAt& far) {
    const auto [from, to] = std::minmax(near.radius, far.radius);
    if (from < to) consider(valley_bottom(flight, measured, {piece, piece}, {from, to}, near));
    consider(far);
  };

  ThrustAt near = start;
  for (std::size_t i = home;; ++i) {  // to the right
    const ThrustAt far = i < last ? at_thrust(flight, measured.vertices()[i + 1].thrust, near) : hi;
    search_piece(i, near, far);
    near = far;
    if (i == last || total_power(flight, convex, far) >= least) break;
  }
  near = start;
  for (std::size_t i = home;; --i) {  // to the left
    const ThrustAt far = i > first ? at_thrust(flight, measured.vertices()[i].thrust, near) : lo;
    search_piece(i, near, far);
    near = far;
    if (i == first || total_power(flight, convex, far) >= least) break;
  }
  return best;
}

/// `at`, or the radius below it at which the motors end.
ThrustAt within_motors(const SteadyFlight& flight, const ThrustAt& at) {
  const double most = flight.design().drone.motor.max_thrust();
  return at.thrust.value > most ? at_thrust(flight, most, at) : at;
}

/// For a converter whose efficiency varies: the smooth pieces between all kinks, one by one.
ThrustAt search_every_piece(const SteadyFlight& flight, const ThrustAt& lo, const ThrustAt& hi) {
  const Design& design = flight.design();
  const MotorCurve& motor = design.drone.motor;
  std::vector<double> kinks;
  for (const MotorPoint& vertex : motor.vertices()) kinks.push_back(vertex.thrust);
  const double motor_power_per_output = 1 / (flight.output_power(1));
  for (const EfficiencyPoint& point : design.supply.converter.efficiency) {
    kinks.push_back(motor.thrust(point.output_power * motor_power_per_output));
  }
  std::sort(kinks.begin(), kinks.end());

  const auto power_at = [&](const ThrustAt& at) { return total_power(flight, motor, at); };
  ThrustAt best = lo;
  double least = infinity;
  const auto consider = [&](const ThrustAt& candidate) {
    const double power = power_at(candidate);
    if (power < least) {
      least = power;
      best = candidate;
    }
  };
  // Efficiency that rises with load bends a piece the wrong way; parts of it are still one valley.
  constexpr int parts = 4;
  // Half of the digits: at a smooth minimum the value is then exact to all of them.
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  ThrustAt from = lo;
  const auto search_up_to = [&](const ThrustAt& to) {
    const double width = (to.radius - from.radius) / parts;
    for (int part = 0; part < parts && width > 0; ++part) {
      const double start = from.radius + part * width;
      const auto [radius, power] = boost::math::tools::brent_find_minima(
          [&](double r) {
            const double y = power_at(thrust_at(flight, r, from.tan_pitch));
            // Far above any power, and falling towards the radii that can deliver.
            return y < infinity ? y
                                : 1e300 * flight.tether().resistance(r) /
                                      flight.tether().resistance(lo.radius);
          },
          start, start + width, bits);
      (void)power;
      consider(thrust_at(flight, radius, from.tan_pitch));
    }
    consider(to);
    from = to;
  };
  consider(lo);
  for (const double kink : kinks) {
    if (kink > from.thrust.value && kink < hi.thrust.value) {
      search_up_to(at_thrust(flight, kink, from));
    }
  }
  search_up_to(hi);
  return best;
}

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

MinimumPower minimum_within_tilt(const SteadyFlight& flight, Interval radii) {
  const MinimumPower none{nan, nan};
  const Design& design = flight.design();
  const MotorCurve& motor = design.drone.motor;
  // Thick enough to deliver what the lightest tether needs in still air, light enough for the
  // motors there.
  const double lightest = radii.lo;
  const double hover_power = flight.drone_power(flight.necessary_thrust(lightest, 0));
  if (!(hover_power < infinity)) return none;
  const double voltage = design.supply.voltage;
  radii.lo = std::max(lightest,
                      flight.tether().radius_of_resistance(voltage * voltage / (4 * hover_power)));
  radii.hi =
      std::min(radii.hi, flight.radius_of_weight(design.drone.motor_count * motor.max_thrust()));
  if (!(radii.lo <= radii.hi)) return none;

  const auto at_radius = [&](double radius) {
    return within_motors(flight, thrust_at(flight, radius, 0));
  };
  ThrustAt best;
  if (!is_proportional(design.supply.converter)) {
    best = search_every_piece(flight, at_radius(radii.lo), at_radius(radii.hi));
  } else {
    const double thrust =
        std::min(motor.max_thrust(),
                 flight.necessary_thrust(lightest, flight.level_drag_tan_pitch(lightest)));
    const double guess = first_guess(flight, lightest, thrust, flight.drone_power(thrust));
    const MotorCurve& convex = motor.convex_hull();
    best = valley_bottom(flight, convex, {0, convex.vertices().size() - 2}, radii,
                         at_radius(std::clamp(guess, radii.lo, radii.hi)));
    if (!motor.is_convex() && motor.power(best.thrust.value) > convex.power(best.thrust.value)) {
      best = search_outwards(flight, motor, convex, at_radius(radii.lo), at_radius(radii.hi), best);
    }
  }
  if (best.radius < radii.lo * (1 - 1e-12)) return none;  // the motors end before the range begins
  const double power = total_power(flight, motor, best);
  return power < infinity ? MinimumPower{area_of(best.radius), power} : none;
}

}  // namespace

MinimumPower lesser(const MinimumPower& a, const MinimumPower& b) {
  return a.power <= b.power || std::isnan(b.power) ? a : b;
}

bool is_cheapest_beyond(const SteadyFlight& flight, double area) {
  const Design& design = flight.design();
  if (!is_proportional(design.supply.converter)) return false;
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  if (beyond.lo < beyond.hi) return false;
  const MotorCurve& motor = design.drone.motor;
  if (motor.is_convex()) return true;
  const double radius = conductor_radius(area);
  const double thrust = flight.necessary_thrust(radius, flight.tan_pitch(radius, infinity));
  constexpr double rounding = 1e-14;
  return motor.power(thrust) <= motor.convex_hull().power(thrust) * (1 + rounding);
}

MinimumPower minimum_power(const SteadyFlight& flight, Interval within) {
  const Interval radii{conductor_radius(within.lo), conductor_radius(within.hi)};
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  MinimumPower best{nan, nan};
  if (!(beyond.lo < beyond.hi)) {
    best = minimum_within_tilt(flight, radii);
  } else {
    for (const Interval& part : intersection({radii}, {{0, beyond.lo}, {beyond.hi, infinity}})) {
      best = lesser(best, minimum_within_tilt(flight, part));
    }
  }
  // Squaring the root of an end of the range may miss it by rounding.
  if (best.power > 0) best.area = std::clamp(best.area, within.lo, within.hi);
  return best;
}

}  // namespace tethercalc
