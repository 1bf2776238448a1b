// Notation: r conductor radius; TA available, TN necessary thrust per motor; k required headroom.
// TA(r) and TN(r) both rise with r. TA has a kink at each radius where the available power feeds
// the motors at exactly one of the motor curve's points ("vertex radius"), and a closed form for
// it; from the last of them on TA stays the same.
// Φ(r) is the radius that would make k·TN(r) available. It rises with r, and r is feasible exactly
// where Φ(r) ≤ r. So if r is infeasible, everything in [r, Φ(r)) is; if r is feasible, everything
// in [Φ(r), r] is: steps r → Φ(r) cannot jump over an edge.

#include "tethercalc/solve/headroom.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "solve/thrust_at.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double area_of(double radius) { return std::numbers::pi * radius * radius; }

struct Sample {
  double radius = 0;
  double available = 0;
  double necessary = 0;  ///< times the required headroom
  double tan_pitch = 0;  ///< start for the next tilt nearby

  [[nodiscard]] double margin() const { return available - necessary; }
  [[nodiscard]] double ratio() const { return available / necessary; }
};

/// Thrust margin over the radius between two radii, sampled at will or at the vertex radii.
class MarginCurve {
 public:
  MarginCurve(const SteadyFlight& flight, double required, double lo, double hi)
      : flight_(flight), required_(required), lo_(lo), hi_(hi) {}

  /// Sample indices are those of the motor curve's vertices; the last stands for the last radius.
  [[nodiscard]] std::size_t last_index() const {
    return flight_.design().drone.motor.vertices().size() - 1;
  }

  [[nodiscard]] Sample at_vertex(std::size_t index, double tan_guess) const {
    if (index == last_index()) return at_radius(hi_, tan_guess);
    const MotorPoint& vertex = flight_.design().drone.motor.vertices()[index];
    const double radius = flight_.radius_of_available_power(flight_.input_power(vertex.power));
    if (!(radius > lo_)) return at_radius(lo_, tan_guess);
    if (!(radius < hi_)) return at_radius(hi_, tan_guess);
    return with_available(radius, vertex.thrust, tan_guess);
  }

  [[nodiscard]] Sample at_radius(double radius, double tan_guess) const {
    const double power = flight_.available_power(flight_.tether().resistance(radius));
    return with_available(radius, flight_.available_thrust(power), tan_guess);
  }

  /// Φ: the radius that would make what is necessary at `sample` available; +infinity where no
  /// radius does.
  [[nodiscard]] double needed_radius(const Sample& sample) const {
    return flight_.radius_of_available_power(flight_.drone_power(sample.necessary));
  }

  /// A sample without its available thrust.
  [[nodiscard]] Sample necessary_at(double radius, double tan_guess) const {
    return with_available(radius, 0, tan_guess);
  }

  [[nodiscard]] const SteadyFlight& flight() const { return flight_; }

  /// Radii of the converter's efficiency points strictly between two samples, rising.
  [[nodiscard]] std::vector<double> converter_radii(const Sample& a, const Sample& b) const {
    std::vector<double> radii;
    const Converter& converter = flight_.design().supply.converter;
    if (converter.efficiency.size() == 1) return radii;
    for (const EfficiencyPoint& point : converter.efficiency) {
      const double input =
          point.output_power / point.efficiency + flight_.design().drone.auxiliary_power;
      const double radius = flight_.radius_of_available_power(input);
      if (radius > a.radius && radius < b.radius) radii.push_back(radius);
    }
    return radii;
  }

 private:
  [[nodiscard]] Sample with_available(double radius, double available, double tan_guess) const {
    const double tangent = flight_.tan_pitch(radius, infinity, tan_guess);
    return {radius, available, required_ * flight_.necessary_thrust(radius, tangent), tangent};
  }

  const SteadyFlight& flight_;
  double required_;
  double lo_;
  double hi_;
};

/// About the radius between two samples of opposite margin, on a smooth piece, at which the margin
/// vanishes, and about dΦ/dr there.
struct CrossingGuess {
  double radius = 0;
  double needed_slope = 0;
};

/// Exact where the tilt is that of `a` all the way and contacts have no resistance: then available
/// thrust is linear in r², and necessary thrust proportional to the weight.
CrossingGuess guess_crossing(const SteadyFlight& flight, const Sample& a, const Sample& b) {
  const double width = b.radius - a.radius;
  const double per_square = (b.available - a.available) / (width * (b.radius + a.radius));
  const double per_weight = a.necessary / flight.weight(a.radius);
  // Margin over x = r − a.radius: a.margin + slope·x + curvature·x².
  const double slope = 2 * per_square * a.radius - per_weight * flight.weight_slope(a.radius);
  const double curvature = per_square - 0.5 * per_weight * flight.tether().mass_curvature() *
                                            flight.design().flight.gravity;
  const double root = std::sqrt(slope * slope - 4 * curvature * a.margin());
  const double x = -2 * a.margin() / (slope + (a.margin() < 0 ? root : -root));
  const double share = a.margin() / (a.margin() - b.margin());
  const double radius = a.radius + (x > 0 && x < width ? x : width * share);
  const double needed_slope = per_weight * flight.weight_slope(radius) / (2 * per_square * radius);
  return {radius,
          needed_slope < 1 ? needed_slope : 0};  // 1 and more only where there are two edges
}

/// The radius between two samples of opposite margin, on a smooth piece, at which the margin
/// vanishes: the root of Φ(r) − r by secants, which Φ's small slope makes quick.
double crossing(const MarginCurve& curve, const Sample& a, const Sample& b) {
  if (a.margin() == 0) return a.radius;
  if (b.margin() == 0) return b.radius;
  const bool enters = a.margin() < 0;
  // A secant's error is less than the product of its two points' errors: 1e-17 relative. That is
  // not so of a step without a secant, the first and those to the middle, which end the search only
  // where they are as short as the accuracy asked for.
  constexpr double last_secant = 1e-10;
  constexpr double last_other = 1e-14;
  double lo = a.radius;
  double hi = b.radius;
  double previous = 0;
  double previous_gap = std::numeric_limits<double>::quiet_NaN();
  double tangent = a.tan_pitch;
  const CrossingGuess guess = guess_crossing(curve.flight(), a, b);
  double radius = guess.radius;
  for (int step = 0; step < 100; ++step) {
    const Sample sample = curve.necessary_at(radius, tangent);
    tangent = sample.tan_pitch;
    const double gap = curve.needed_radius(sample) - radius;
    if (gap == 0) return radius;
    ((gap > 0) == enters ? lo : hi) = radius;
    const double slope = (gap - previous_gap) / (radius - previous);
    // Where the motors could not make the thrust, there was no gap to draw a secant through.
    const bool secant = std::isfinite(slope);
    const double next = radius - gap / (secant ? slope : guess.needed_slope - 1);
    // Rounding may take the last one out of the bracket, the end of which is then the root.
    const double last_step = secant ? last_secant : last_other;
    if (std::abs(next - radius) <= last_step * radius) return std::clamp(next, lo, hi);
    previous = radius;
    previous_gap = gap;
    radius = next > lo && next < hi ? next : 0.5 * (lo + hi);
    if (!(lo < radius && radius < hi)) break;  // no number is left between them
  }
  return radius;
}

/// Sample of largest `score` between a and b, where score is smooth and has one hump at most.
template <typename Score>
Sample highest(const MarginCurve& curve, const Sample& a, const Sample& b, Score score) {
  // Half of the digits: at a smooth maximum the value is then exact to all of them.
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  const auto [radius, negative] = boost::math::tools::brent_find_minima(
      [&](double r) { return -score(curve.at_radius(r, a.tan_pitch)); }, a.radius, b.radius, bits);
  (void)negative;
  return curve.at_radius(radius, a.tan_pitch);
}

/// Where the margin keeps its sign at both ends of a smooth piece, a sample between them at which
/// it has the other sign, if there is one: steps to Φ(r), from the left through what is infeasible
/// or from the right through what is feasible, until they leave the piece or find it. Steps become
/// short where an edge is close; what is left is then searched for one hump or dip.
std::optional<Sample> opposite_between(const MarginCurve& curve, Sample a, Sample b) {
  const bool feasible = a.margin() >= 0;
  Sample& from = feasible ? b : a;
  for (int step = 0; step < 8; ++step) {
    const double next = curve.needed_radius(from);
    if (feasible ? next <= a.radius : next >= b.radius) return std::nullopt;
    from = curve.at_radius(next, from.tan_pitch);
    if ((from.margin() >= 0) != feasible) return from;
  }
  const double sign = feasible ? -1 : 1;
  const Sample extreme =
      highest(curve, a, b, [sign](const Sample& s) { return sign * s.margin(); });
  return (extreme.margin() >= 0) != feasible ? std::optional(extreme) : std::nullopt;
}

void append_radii(IntervalSet& radii, double lo, double hi) { append(radii, {lo, hi}); }

void collect_from_smooth_piece(const MarginCurve& curve, const Sample& a, const Sample& b,
                               IntervalSet& feasible) {
  const bool starts = a.margin() >= 0;
  const bool ends = b.margin() >= 0;
  if (starts != ends) {
    const double edge = crossing(curve, a, b);
    starts ? append_radii(feasible, a.radius, edge) : append_radii(feasible, edge, b.radius);
    return;
  }
  const std::optional<Sample> opposite = opposite_between(curve, a, b);
  if (!opposite) {
    if (starts) append_radii(feasible, a.radius, b.radius);
    return;
  }
  const double first = crossing(curve, a, *opposite);
  const double second = crossing(curve, *opposite, b);
  if (starts) {
    append_radii(feasible, a.radius, first);
    append_radii(feasible, second, b.radius);
  } else {
    append_radii(feasible, first, second);
  }
}

void collect_feasible(const MarginCurve& curve, std::size_t first, const Sample& a,
                      std::size_t last, const Sample& b, IntervalSet& feasible) {
  if (!(b.radius > a.radius)) return;
  // Both thrusts rise, so these two tests hold for everything between a and b.
  if (b.available < a.necessary) return;
  if (a.available >= b.necessary) return append_radii(feasible, a.radius, b.radius);
  if (last - first > 1) {
    const std::size_t middle = first + (last - first) / 2;
    const Sample m = curve.at_vertex(middle, a.tan_pitch);
    collect_feasible(curve, first, a, middle, m, feasible);
    collect_feasible(curve, middle, m, last, b, feasible);
    return;
  }
  Sample from = a;
  for (const double radius : curve.converter_radii(a, b)) {
    const Sample to = curve.at_radius(radius, a.tan_pitch);
    collect_from_smooth_piece(curve, from, to, feasible);
    from = to;
  }
  collect_from_smooth_piece(curve, from, b, feasible);
}

void improve_best(const MarginCurve& curve, std::size_t first, const Sample& a, std::size_t last,
                  const Sample& b, Sample& best) {
  if (!(b.radius > a.radius) || b.available / a.necessary <= best.ratio()) return;
  if (last - first > 1) {
    const std::size_t middle = first + (last - first) / 2;
    const Sample m = curve.at_vertex(middle, a.tan_pitch);
    if (m.ratio() > best.ratio()) best = m;
    improve_best(curve, middle, m, last, b, best);
    improve_best(curve, first, a, middle, m, best);
    return;
  }
  std::vector<double> ends = curve.converter_radii(a, b);
  ends.push_back(b.radius);
  Sample from = a;
  for (const double radius : ends) {
    const Sample to = curve.at_radius(radius, a.tan_pitch);
    const Sample top = highest(curve, from, to, [](const Sample& s) { return s.ratio(); });
    for (const Sample& candidate : {to, top}) {
      if (candidate.ratio() > best.ratio()) best = candidate;
    }
    from = to;
  }
}

/// The two ranges of radii up to `hi` at which the tilt is within its limit; empty ones have hi ≤
/// lo.
std::array<Interval, 2> radii_within_tilt(const SteadyFlight& flight, double hi) {
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  if (!(beyond.lo < beyond.hi)) return {{{0, hi}, {hi, hi}}};
  return {{{0, std::min(beyond.lo, hi)}, {std::min(beyond.hi, hi), hi}}};
}

/// Radius from which on the available power is more than the motors can use; +infinity where
/// contacts keep it below.
double saturation_radius(const SteadyFlight& flight) {
  return flight.radius_of_available_power(
      flight.input_power(flight.design().drone.motor.max_power()));
}

/// Radius above which the necessary thrust, even in still air, exceeds 1/`headroom` of the most the
/// motors can make. Not positive where that holds for the thinnest tether.
double heaviest_radius(const SteadyFlight& flight, double headroom) {
  const Design& design = flight.design();
  return flight.radius_of_weight(design.drone.motor_count * design.drone.motor.max_thrust() /
                                 headroom);
}

}  // namespace

IntervalSet headroom_areas(const SteadyFlight& flight, double required) {
  const MotorCurve& motor = flight.design().drone.motor;
  const double heaviest = heaviest_radius(flight, required);
  IntervalSet radii;
  if (!(heaviest > 0)) return radii;
  const double saturated = saturation_radius(flight);
  for (const Interval& range : radii_within_tilt(flight, heaviest)) {
    if (!(range.lo < range.hi)) continue;
    const double hi = std::clamp(saturated, range.lo, range.hi);
    const MarginCurve curve(flight, required, range.lo, hi);
    const Sample a = curve.at_vertex(0, 0);
    const Sample b = curve.at_vertex(curve.last_index(), a.tan_pitch);
    collect_feasible(curve, 0, a, curve.last_index(), b, radii);
    if (hi < range.hi && b.margin() >= 0) {  // from here on only the weight grows
      const ThrustAt end = at_thrust(flight, motor.max_thrust() / required,
                                     thrust_at(flight, range.hi, b.tan_pitch));
      append_radii(radii, hi, std::min(end.radius, range.hi));
    }
  }
  for (Interval& range : radii) range = {area_of(range.lo), area_of(range.hi)};
  return radii;
}

BestHeadroom best_headroom(const SteadyFlight& flight) {
  const BestHeadroom none{0, std::numeric_limits<double>::quiet_NaN()};
  const double saturated = saturation_radius(flight);
  // Where contacts keep the motors from saturating, the search ends where the tether is so heavy
  // that not even a millionth is left.
  const double heaviest = heaviest_radius(flight, 1e-6);
  if (!(heaviest > 0)) return none;
  Sample best;
  best.necessary = 1;
  for (const Interval& range : radii_within_tilt(flight, heaviest)) {
    if (!(range.lo < range.hi)) continue;
    // Beyond saturation the headroom only falls.
    const double hi = std::clamp(saturated, range.lo, range.hi);
    const MarginCurve curve(flight, 1, range.lo, hi);
    const Sample a = curve.at_vertex(0, 0);
    const Sample b = curve.at_vertex(curve.last_index(), a.tan_pitch);
    for (const Sample& end : {a, b}) {
      if (end.ratio() > best.ratio()) best = end;
    }
    improve_best(curve, 0, a, curve.last_index(), b, best);
  }
  return best.available > 0 ? BestHeadroom{best.ratio(), area_of(best.radius)} : none;
}

}  // namespace tethercalc
