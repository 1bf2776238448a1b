// Notation: r conductor radius; T necessary thrust per motor; P drone power at the converter's
// input; R loop resistance; I tether current; y total power. From y = P + R·(y/U)² follows y'·(1 −
// 2RI/U) = P' + I²R' =: s, so s has the sign of the total power's slope. Where the line cannot
// deliver P, s with I² = P/R has the sign of (R·P)' and points back to where it can.

#include "tethercalc/solve/minimum_power.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double area_of(double radius) { return std::numbers::pi * radius * radius; }

/// Necessary thrust at a radius, and where the next tilt should be looked for.
struct ThrustAt {
  double radius = 0;
  SteadyFlight::Thrust thrust;
  double tan_pitch = 0;
};

ThrustAt thrust_at(const SteadyFlight& flight, double radius, double tan_guess) {
  const double tangent = flight.tan_pitch(radius, infinity, tan_guess);
  return {radius, flight.necessary_thrust_with_slope(radius, tangent), tangent};
}

/// The radius at which `thrust` is necessary; `from` starts Newton's method. The necessary thrust
/// rises and is convex in the radius, so that it converges from either side.
ThrustAt at_thrust(const SteadyFlight& flight, double thrust, ThrustAt from) {
  for (int step = 0; step < 50; ++step) {
    const double change = (thrust - from.thrust.value) / from.thrust.slope;
    const double radius = std::max(from.radius + change, 0.25 * from.radius);
    // Quadratic convergence: the thrust is then within 1e-16 of the vertex.
    const bool last = std::abs(change) <= 1e-9 * radius;
    from = thrust_at(flight, radius, from.tan_pitch);
    if (last) break;
  }
  return from;
}

/// One straight piece of a motor curve.
struct Piece {
  MotorPoint start;
  double slope = 0;  ///< W/N

  [[nodiscard]] double power(double thrust) const {
    return start.power + slope * (thrust - start.thrust);
  }
};

Piece piece_of(const MotorCurve& motor, std::size_t index) {
  return {motor.vertices()[index], motor.slope(index)};
}

/// +infinity where the motors cannot make the thrust or the line cannot deliver the power.
double total_power(const SteadyFlight& flight, const MotorCurve& motor, const ThrustAt& at) {
  const double total = supplied_power(flight.design().supply.voltage, flight.resistance(at.radius),
                                      flight.input_power(motor.power(at.thrust.value)));
  return total > 0 ? total : infinity;
}

/// Loss saved over power spent by a little more radius, −I²R'/P', were the motor curve to follow
/// `piece`: above 1 where the total power falls with the radius.
double saved_per_spent(const SteadyFlight& flight, const Piece& piece, const ThrustAt& at) {
  const double voltage = flight.design().supply.voltage;
  const double resistance = flight.resistance(at.radius);
  const double power = flight.input_power(piece.power(at.thrust.value));
  const double supplied = supplied_power(voltage, resistance, power);
  const double current = supplied / voltage;
  // With a constant efficiency the input power is linear in the motor's.
  const double input_slope = flight.input_power(1) - flight.input_power(0);
  const double current_squared = supplied > 0 ? current * current : power / resistance;
  return -current_squared * flight.resistance_slope(at.radius) /
         (input_slope * piece.slope * at.thrust.slope);
}

/// Between lo and hi, where the motor curve follows `piece` and saved_per_spent passes 1, the
/// radius at which it does.
ThrustAt smooth_bottom(const SteadyFlight& flight, const Piece& piece, ThrustAt lo, ThrustAt hi,
                       ThrustAt start) {
  // 1e-10 relative in the radius; the power at the bottom is flat to the square of that.
  constexpr double close_enough = 1e-10;
  double previous_radius = nan;
  double previous_gap = nan;
  ThrustAt at = start;
  for (int step = 0; step < 200; ++step) {
    const double gap = std::log(saved_per_spent(flight, piece, at));
    (gap > 0 ? lo : hi) = at;
    // Savings fall with 1/r³ while spending rises about with r, hence −4/r for a first slope.
    double slope = (gap - previous_gap) / (at.radius - previous_radius);
    if (!(slope < 0)) slope = -4 / at.radius;
    double next = at.radius - gap / slope;
    if (!(next > lo.radius && next < hi.radius)) next = 0.5 * (lo.radius + hi.radius);
    if (std::abs(next - at.radius) <= close_enough * at.radius) break;
    previous_radius = at.radius;
    previous_gap = gap;
    at = thrust_at(flight, next, at.tan_pitch);
  }
  return at;
}

/// The bottom between lo and hi on one piece, at an end where the power only rises or only falls.
ThrustAt bottom_on_piece(const SteadyFlight& flight, const Piece& piece, const ThrustAt& lo,
                         const ThrustAt& hi) {
  if (saved_per_spent(flight, piece, lo) <= 1) return lo;
  if (saved_per_spent(flight, piece, hi) >= 1) return hi;
  return smooth_bottom(flight, piece, lo, hi,
                       thrust_at(flight, 0.5 * (lo.radius + hi.radius), lo.tan_pitch));
}

/// The bottom between lo and hi of the total power along a convex motor curve, where it is one
/// valley: a binary search for the piece, then the bottom on it.
ThrustAt valley_bottom(const SteadyFlight& flight, const MotorCurve& convex, ThrustAt lo,
                       ThrustAt hi) {
  std::size_t first = convex.piece(lo.thrust.value);
  std::size_t last = convex.piece(hi.thrust.value);
  while (first < last) {
    const std::size_t middle = first + (last - first + 1) / 2;  // in (first, last]
    const ThrustAt vertex =
        at_thrust(flight, convex.vertices()[middle].thrust, last - first > 2 ? lo : hi);
    if (saved_per_spent(flight, piece_of(convex, middle), vertex) > 1) {
      first = middle;
      lo = vertex;
    } else {
      last = middle - 1;
      hi = vertex;
    }
  }
  return bottom_on_piece(flight, piece_of(convex, first), lo, hi);
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

  ThrustAt near = start;
  for (std::size_t i = home;; ++i) {  // to the right
    const ThrustAt far = i < last ? at_thrust(flight, measured.vertices()[i + 1].thrust, near) : hi;
    consider(bottom_on_piece(flight, piece_of(measured, i), near, far));
    near = far;
    if (i == last || total_power(flight, convex, far) >= least) break;
  }
  near = start;
  for (std::size_t i = home;; --i) {  // to the left
    const ThrustAt far = i > first ? at_thrust(flight, measured.vertices()[i].thrust, near) : lo;
    consider(bottom_on_piece(flight, piece_of(measured, i), far, near));
    near = far;
    if (i == first || total_power(flight, convex, far) >= least) break;
  }
  return best;
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
            return y < infinity ? y : 1e300 * flight.resistance(r) / flight.resistance(lo.radius);
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

/// The range of radii in which a point of least power can lie, from the range asked for: thick
/// enough to deliver what the lightest tether needs, light enough for the motors in still air.
Interval promising_radii(const SteadyFlight& flight, Interval radii) {
  const Design& design = flight.design();
  const double tangent = flight.tan_pitch(radii.lo, infinity);
  const double least_power = flight.drone_power(flight.necessary_thrust(radii.lo, tangent));
  const double voltage = design.supply.voltage;
  const double thinnest = flight.radius_of_resistance(voltage * voltage / (4 * least_power));
  const double heaviest = flight.radius_of_mass(
      design.drone.motor_count * design.drone.motor.max_thrust() / design.flight.gravity);
  return {std::max(radii.lo, thinnest), std::min(radii.hi, heaviest)};
}

MinimumPower minimum_within_tilt(const SteadyFlight& flight, Interval radii) {
  const MinimumPower none{nan, nan};
  radii = promising_radii(flight, radii);
  if (!(radii.lo <= radii.hi)) return none;
  const MotorCurve& motor = flight.design().drone.motor;
  const ThrustAt lo = thrust_at(flight, radii.lo, 0);
  ThrustAt hi = thrust_at(flight, radii.hi, lo.tan_pitch);
  if (lo.thrust.value > motor.max_thrust()) return none;
  // A hair below the last point, so that rounding does not push it over the motors' limit.
  const double most = motor.max_thrust() * (1 - 1e-14);
  if (hi.thrust.value > most) hi = at_thrust(flight, most, hi);

  ThrustAt best;
  if (flight.design().supply.converter.efficiency.size() > 1) {
    best = search_every_piece(flight, lo, hi);
  } else {
    const MotorCurve convex = motor.convex_hull();
    best = valley_bottom(flight, convex, lo, hi);
    if (motor.power(best.thrust.value) > convex.power(best.thrust.value)) {
      best = search_outwards(flight, motor, convex, lo, hi, best);
    }
  }
  const double power = total_power(flight, motor, best);
  return power < infinity ? MinimumPower{area_of(best.radius), power} : none;
}

}  // namespace

MinimumPower lesser(const MinimumPower& a, const MinimumPower& b) {
  return a.power <= b.power || std::isnan(b.power) ? a : b;
}

MinimumPower minimum_power(const SteadyFlight& flight, Interval within) {
  const Interval radii{conductor_radius(within.lo), conductor_radius(within.hi)};
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  if (!(beyond.lo < beyond.hi)) return minimum_within_tilt(flight, radii);
  MinimumPower best{nan, nan};
  for (const Interval& part : intersection({radii}, {{0, beyond.lo}, {beyond.hi, infinity}})) {
    const MinimumPower candidate = minimum_within_tilt(flight, part);
    best = lesser(best, candidate);
  }
  return best;
}

}  // namespace tethercalc
