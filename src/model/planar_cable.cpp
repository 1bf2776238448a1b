// Notation: v with v²/2 = ln(T/least T)/m, negative where the cable still goes down; m =
// w/hypot(w, 2·D). Ways aside are counted from where the cable would end that lies straight in the
// direction in which load and tension balance.
#include "model/planar_cable.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tethercalc/model/catenary.hpp"

namespace tethercalc {
namespace {

/// Gauss and Legendre's 8 points on −1 to 1, by halves, and their weights.
constexpr std::array<std::array<double, 2>, 4> points{{{0.18343464249564980, 0.36268378337836198},
                                                       {0.52553240991632899, 0.31370664587788729},
                                                       {0.79666647741362674, 0.22238103445337447},
                                                       {0.96028985649753623, 0.10122853629037626}}};
/// Beyond which directions are the limit's, to the last digit.
constexpr double straight_beyond = 8.5;

class Plane {
  /// Their sum with the root less `part`, of which (w + root)² less its square is 2·w·(w + root).
  [[nodiscard]] double both_less(double part) const {
    return part > 0 ? 2 * cable_.weight * both_ / (both_ + part) : both_ - part;
  }
  /// On which the points miss by 1e-9 or less. Directions have a pole at exp(v²/2) = −q; where that
  /// is far they turn back at |v| = 2.5.
  [[nodiscard]] double piece_for_points() const {
    const double drag = std::abs(cable_.drag);
    const double q = 2 * drag * (1 + std::abs(limit_cos_)) / both_less(2 * drag);
    const double log_q = std::log(q);
    const double beside = std::sqrt(std::hypot(log_q, std::numbers::pi) - log_q);
    return std::min(1.5, 0.8 * beside);
  }

 public:
  explicit Plane(const PlanarCable& cable)
      : cable_(cable),
        root_(std::hypot(cable.weight, 2 * cable.drag)),
        m_(cable.weight / root_),
        both_(cable.weight + root_),
        limit_cos_(-2 * cable.drag / both_),
        limit_sin_(std::sqrt(2 * cable.weight / both_)),
        widest_piece_(piece_for_points()) {}

  [[nodiscard]] double m() const { return m_; }
  [[nodiscard]] double limit_cotangent() const { return limit_cos_ / limit_sin_; }
  [[nodiscard]] const PlanarCable& cable() const { return cable_; }
  /// How far aside of a straight cable the drone stands.
  [[nodiscard]] double beside_straight() const {
    return cable_.aside - cable_.height * limit_cotangent();
  }
  /// Tension over the least.
  [[nodiscard]] double growth(double v) const { return std::exp(0.5 * m_ * v * v); }

  /// Direction where the cable goes up, or down for a negative `v`.
  struct Direction {
    double cos = 0;
    double sin = 0;
    double turn = 0;  ///< its cotangent over the limit's, times the sine
  };
  [[nodiscard]] Direction direction(double v) const {
    const double sign = v < 0 ? -1 : 1;
    const double drag = sign * cable_.drag;
    const double limit = sign * limit_cos_;
    const double least = both_less(2 * drag);
    const double growth = std::expm1(0.5 * v * v);
    const double below = (1 + growth) * least * least / (2 * cable_.weight) + 2 * drag;
    const double from_1 = least * growth / below;
    const double from_limit = (both_ - 2 * drag * limit) / below;
    const double sin = std::sqrt(from_1 * (from_limit + least / both_));
    const double cos = 1 - from_1;
    const double turn =
        from_limit * (limit_sin_ + limit * (cos + limit) / (sin + limit_sin_)) / limit_sin_;
    return {cos, sign * sin, turn};
  }
  /// Where the cable has this direction, or about the last of those that it may have.
  [[nodiscard]] double place_of(double cos, double sin) const {
    constexpr double last = 4;  // where the tension is thousands of times the least
    const double sign = sin < 0 ? -1 : 1;
    const double drag = sign * cable_.drag;
    const double least = both_less(2 * drag);
    const double ratio = least * least / (2 * cable_.weight);
    const double from_1 = 1 - cos;
    const double growth = from_1 * (ratio + 2 * drag) / (least - from_1 * ratio);
    return sign * (growth >= 0 ? std::min(last, std::sqrt(2 * std::log1p(growth))) : last);
  }

  /// Over the least tension, with v or over a part of it: the way aside, what stretches it (by the
  /// least tension over EA), the height, and the length; and σ.
  struct Ways {
    double aside = 0;
    double stretched = 0;
    double height = 0;
    double length = 0;
    double sigma = 0;
    void add(const Ways& more, double share = 1) {
      aside += share * more.aside;
      stretched += share * more.stretched;
      height += share * more.height;
      length += share * more.length;
      sigma += share * more.sigma;
    }
  };
  // Called at many places, from which copies would only swell the program.
  [[nodiscard, gnu::noinline]] Ways change(double v) const {
    constexpr double about_zero = 1e-6;
    if (std::abs(v) < about_zero) v = about_zero;
    const Direction at = direction(v);
    const double sigma = m_ * v / (cable_.weight * at.sin);
    const double tension = growth(v);
    const double length = tension * sigma;
    return {at.turn * length, at.turn * length * tension, at.sin * length, length, sigma};
  }
  [[nodiscard, gnu::noinline]] Ways between(double from, double to) const {
    const auto straight = [](double v) { return std::clamp(v, -straight_beyond, straight_beyond); };
    Ways sum = going_one_way(std::max(straight(from), 0.0), std::max(straight(to), 0.0));
    sum.add(going_one_way(std::min(straight(from), 0.0), std::min(straight(to), 0.0)));
    // What is straight, counted from there to the end of the cable.
    const auto beyond = [&](double end) {
      const double last = straight(end);
      const double rises = (last < 0 ? -1 : 1) * cable_.weight * limit_sin_;
      const double grows = growth(end) - growth(last);
      return Ways{0, 0, grows / cable_.weight, grows / rises,
                  0.5 * m_ * (end * end - last * last) / rises};
    };
    sum.add(beyond(to));
    sum.add(beyond(from), -1);
    return sum;
  }

 private:
  [[nodiscard]] Ways going_one_way(double from, double to) const {
    Ways sum;
    const double pieces = std::ceil((to - from) / widest_piece_);
    const double half = 0.5 * (to - from) / pieces;
    for (double piece = 0; piece < pieces; ++piece) {
      const double middle = from + (2 * piece + 1) * half;
      for (const auto& [place, weight] : points) {
        for (const double side : {-half, half})
          sum.add(change(middle + side * place), half * weight);
      }
    }
    return sum;
  }

  PlanarCable cable_;
  double root_;
  double m_;
  double both_;  ///< weight and root
  double limit_cos_;
  double limit_sin_;
  double widest_piece_;
};

/// From its station with v to the drone with v.
struct EndsInPlane {
  double station = 0;
  double drone = 0;
};

/// `all` between the ends.
PlanarShape shape_of(const Plane& plane, const EndsInPlane& v, const Plane::Ways& all, double least,
                     bool mirrored) {
  const auto place = [&](double at) {
    const Plane::Direction there = plane.direction(at);
    return PlanarShape::Place{mirrored ? -there.cos : there.cos, there.sin,
                              least * plane.growth(at)};
  };
  const double slackest = std::clamp(0.0, v.station, v.drone);
  return {.hangs = true,
          .at_station = place(v.station),
          .at_drone = place(v.drone),
          .slackest = place(slackest),
          .length = least * all.length,
          .sigma = all.sigma,
          .before = slackest > v.station ? plane.between(v.station, slackest).sigma / all.sigma : 0,
          .ends = {v.station, v.drone}};
}

/// Seen from the side from which it turns up.
struct Seen {
  Plane plane;
  double beside = 0;  ///< a straight cable, ≥ 0
  bool mirrored = false;

  explicit Seen(PlanarCable cable) : plane(cable), beside(plane.beside_straight()) {
    if (beside >= 0) return;
    mirrored = true;
    beside = -beside;
    cable.drag = -cable.drag;
    cable.aside = -cable.aside;
    plane = Plane(cable);
  }
};

// A winch.

/// A cable with this tension at its winch.
struct OnWinch {
  Plane plane;
  double tension = 0;
  double at_drone = 0;  ///< tension
  double rise = 0;      ///< of v² from the winch to the drone

  OnWinch(const Plane& in, double at_winch) : plane(in), tension(at_winch) {
    const PlanarCable& cable = in.cable();
    // Heights over the tensions: ∫ (1 + T/EA)·dT = w·h.
    const double before = tension + 0.5 * cable.compliance * tension * tension;
    const double after = before + cable.weight * cable.height;
    at_drone = 2 * after / (1 + std::sqrt(1 + 2 * cable.compliance * after));
    const double stretch = 1 + 0.5 * cable.compliance * (tension + at_drone);
    rise = 2 / in.m() * std::log1p(cable.weight * cable.height / stretch / tension);
  }
  [[nodiscard]] double v_at_drone(double v) const { return std::sqrt(v * v + rise); }
  [[nodiscard]] double least_tension(double v) const { return tension / plane.growth(v); }

  /// ln of the way aside, and its slope.
  struct Aside {
    double v = 0;
    double value = 0;
    double slope = 0;
  };
  [[nodiscard]] Aside aside(double v) const {
    const double least = least_tension(v);
    const double stretch = plane.cable().compliance * least;
    const double end = v_at_drone(v);
    const auto stretched = [stretch](const Plane::Ways& ways) {
      return ways.aside + stretch * ways.stretched;
    };
    const Plane::Ways ways = plane.between(v, end);
    const double way = stretched(ways);
    const double slope = stretched(plane.change(end)) * v / end - stretched(plane.change(v)) -
                         plane.m() * v * (way + stretch * ways.stretched);
    return {v, std::log(least * way), slope / way};
  }
};

struct AtWinch {
  bool hangs = false;  ///< else no way aside is as far
  double v = 0;
};

/// The tauter cable: where ln of the way aside falls through `wanted`. That falls wherever the
/// cable goes up at the winch; where it goes down it is concave, with its greatest value (both seen
/// of thousands of drawn cables).
std::optional<AtWinch> taut_at_winch(const OnWinch& cable, double wanted, double start) {
  constexpr double little = 1e-10;
  constexpr int most_steps = 60;
  constexpr double longest_step = 1.5;
  constexpr double back_to_falling = 0.5;
  // GCC 12 takes what an optional holds here for uninitialised.
  struct Side {
    bool known = false;
    OnWinch::Aside at;
  };
  Side rising;
  Side falling;
  bool reached = false;
  double v = start;
  for (int i = 0; i < most_steps && std::abs(v) < straight_beyond; ++i) {
    const OnWinch::Aside here = cable.aside(v);
    const double excess = here.value - wanted;
    if (!std::isfinite(excess) || !std::isfinite(here.slope)) return std::nullopt;
    const double to_wanted = -excess / here.slope;
    if (here.slope < 0 && std::abs(to_wanted) < little * (1 + std::abs(v))) {
      return AtWinch{true, v + to_wanted};
    }
    if (excess > 0) {
      reached = true;
      v += here.slope < 0 ? std::min(to_wanted, longest_step) : back_to_falling;
      rising = {};
      continue;
    }
    (here.slope < 0 ? falling : rising) = {true, here};
    if (!rising.known) {
      v += std::max(to_wanted, -longest_step);
    } else if (falling.known) {
      // Where it is concave both tangents lie above.
      const OnWinch::Aside& lo = rising.at;
      const OnWinch::Aside& hi = falling.at;
      const double apart = hi.v - lo.v;
      const double bend = lo.slope - hi.slope;
      const double to_crossing = (hi.value - lo.value - hi.slope * apart) / bend;
      if (!reached && lo.value + lo.slope * to_crossing < wanted) return AtWinch{};
      v = lo.v + lo.slope / bend * apart;
    } else {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Where ln of the way aside is greatest, and its slope there by ln of the tension at the winch.
struct Farthest {
  double value = 0;
  double by_tension = 0;
};
/// By bisection and secants of the slope: to 1e-6 of v, by which the value changes by the square.
std::optional<Farthest> farthest_aside(const OnWinch& cable) {
  constexpr double step = 0.5;
  constexpr int enough_bits = 20;
  const auto slope = [&](double v) { return cable.aside(v).slope; };
  double rising = -step;
  while (!(slope(rising) > 0)) {
    rising -= step;
    if (rising < -straight_beyond) return std::nullopt;
  }
  std::uintmax_t most_calls = 60;
  const auto [from, to] = boost::math::tools::toms748_solve(
      slope, rising, rising + step, boost::math::tools::eps_tolerance<double>(enough_bits),
      most_calls);
  const OnWinch::Aside here = cable.aside(0.5 * (from + to));
  const PlanarCable& plane = cable.plane.cable();
  const double end = cable.v_at_drone(here.v);
  const double way = std::exp(here.value) / cable.least_tension(here.v);
  const double rise_by_tension = -2 / cable.plane.m() * plane.weight * plane.height /
                                 (cable.tension + plane.weight * plane.height);
  return Farthest{here.value,
                  1 + cable.plane.change(end).aside * rise_by_tension / (2 * end * way)};
}

// A known length.

/// Of the cable under the load that it would have along its chord, which is a catenary across that.
std::optional<EndsInPlane> under_even_load(const Plane& plane, double length) {
  constexpr double least_across = 1e-3;  // a cable along its load is a fold
  const PlanarCable& cable = plane.cable();
  const double chord = std::hypot(cable.aside, cable.height);
  const double cos = cable.aside / chord;
  const double sin = cable.height / chord;
  const double drag = cable.drag * sin * std::abs(sin);
  const double load = std::hypot(drag * sin, cable.weight + drag * cos);
  const double up_x = -drag * sin / load;
  const double up_z = (cable.weight + drag * cos) / load;
  const double up = up_x * cos + up_z * sin;
  const double ahead = std::max(up_z * cos - up_x * sin, least_across);
  const auto hung = catenary(chord * ahead, chord * up, length, load);
  if (!hung || !(hung->horizontal > 0)) return std::nullopt;
  const auto place = [&](double vertical) {
    const double tension = std::hypot(hung->horizontal, vertical);
    return plane.place_of((hung->horizontal * up_z + vertical * up_x) / tension,
                          (vertical * up_z - hung->horizontal * up_x) / tension);
  };
  return EndsInPlane{place(hung->vertical_at_start), place(hung->vertical_at_end)};
}

/// Where a cable leads: in which direction, as seen from the straight one, and with how much slack,
/// by its logarithm; or how these change with something.
struct Lead {
  double direction = 0;
  double slack = 0;
};
double true_aside(const Plane& plane, const Plane::Ways& ways) {
  return ways.aside + plane.limit_cotangent() * ways.height;
}
/// 1 less the square of the chord over the length.
double slack_of(const Plane& plane, const Plane::Ways& all) {
  const double x = true_aside(plane, all) / all.length;
  const double z = all.height / all.length;
  return 1 - x * x - z * z;
}
Lead lead_of(const Plane& plane, const Plane::Ways& all) {
  return {std::asinh(all.height / all.aside), std::log(slack_of(plane, all))};
}
Lead change_of_lead(const Plane& plane, const Plane::Ways& all, const Plane::Ways& change) {
  const double x = true_aside(plane, all);
  const double chords = x * x + all.height * all.height;
  const double along = x * true_aside(plane, change) + all.height * change.height;
  return {
      (change.height - all.height / all.aside * change.aside) / std::hypot(all.aside, all.height),
      2 * (chords * change.length / all.length - along) /
          (all.length * all.length * slack_of(plane, all))};
}

/// Newton's method by the middle of both v and the logarithm of their difference.
std::optional<EndsInPlane> ends_of_length(const Plane& plane, double beside, double length,
                                          const std::optional<EndsInPlane>& near) {
  constexpr int most_steps = 40;
  constexpr double little = 1e-10;
  constexpr double of_rounding = 1e-15;
  constexpr double least_slack = 1e-8;
  constexpr double longest_step = 1;
  constexpr double farthest = 20;
  const Plane::Ways wanted_ways{.aside = beside, .height = plane.cable().height, .length = length};
  const double slack = slack_of(plane, wanted_ways);
  if (!(slack > least_slack)) return std::nullopt;
  const auto start = near ? near : under_even_load(plane, length);
  if (!start) return std::nullopt;
  const Lead wanted = lead_of(plane, wanted_ways);
  EndsInPlane v = *start;
  // Where both lie beyond what may be.
  if (!(v.drone > v.station)) v.station = v.drone - std::min(1.0, 3 * std::sqrt(slack));
  for (int i = 0; i < most_steps && std::max(-v.station, v.drone) < farthest; ++i) {
    const Plane::Ways all = plane.between(v.station, v.drone);
    const Lead here = lead_of(plane, all);
    const Lead by_station = change_of_lead(plane, all, plane.change(v.station));
    const Lead by_drone = change_of_lead(plane, all, plane.change(v.drone));
    const double half = 0.5 * (v.drone - v.station);
    const Lead by_middle{by_drone.direction - by_station.direction,
                         by_drone.slack - by_station.slack};
    const Lead by_apart{half * (by_drone.direction + by_station.direction),
                        half * (by_drone.slack + by_station.slack)};
    const Lead miss{wanted.direction - here.direction, wanted.slack - here.slack};
    const double determinant =
        by_middle.direction * by_apart.slack - by_middle.slack * by_apart.direction;
    const double middle =
        (miss.direction * by_apart.slack - miss.slack * by_apart.direction) / determinant;
    const double log_apart =
        (by_middle.direction * miss.slack - by_middle.slack * miss.direction) / determinant;
    const double size = std::max(std::abs(middle), std::abs(log_apart));
    if (!std::isfinite(size)) return std::nullopt;
    const double part = longest_step / std::max(longest_step, size);
    const double center = 0.5 * (v.station + v.drone) + part * middle;
    const double half_next = half * std::exp(part * log_apart);
    v = {center - half_next, center + half_next};
    if (size < little + of_rounding / slack) return v;
  }
  return std::nullopt;
}

/// Down to there both methods agree to 1e-8; the general one finds few lighter cables.
bool outweighs_the_wind(const PlanarCable& cable) {
  constexpr double least_weight_to_drag = 1e-4;
  return cable.weight > least_weight_to_drag * std::abs(cable.drag);
}
constexpr double most_rise = 800;  // of v², whose exponential is a number

/// Whether the drone stands where a straight cable ends.
bool is_in_line(const Seen& seen) {
  constexpr double least_aside = 1e-9;
  return seen.beside < least_aside * seen.plane.cable().height;
}

}  // namespace

std::optional<PlanarShape> held_by_winch(const PlanarCable& cable, double tension,
                                         const std::optional<PlanarEnds>& near) {
  constexpr double least_height = 1e-9;  // of the way aside
  // Of the load: below, rounding leaves 1e-9 of the directions.
  constexpr double most_tension = 1e5;
  const double load = std::hypot(cable.weight, cable.drag) * std::hypot(cable.aside, cable.height);
  if (!(cable.height > least_height * std::abs(cable.aside)) || !outweighs_the_wind(cable) ||
      !(tension * (1 + cable.compliance * tension) < most_tension * load)) {
    return std::nullopt;
  }
  const Seen seen(cable);
  const OnWinch winched(seen.plane, tension);
  if (!(winched.rise < most_rise)) return std::nullopt;
  std::optional<AtWinch> at_winch;
  if (is_in_line(seen)) {
    at_winch = {true, straight_beyond};
  } else {
    const double wanted = std::log(seen.beside);
    if (near) at_winch = taut_at_winch(winched, wanted, near->front());
    if (!at_winch || !at_winch->hangs) at_winch = taut_at_winch(winched, wanted, 0);
  }
  if (!at_winch) return std::nullopt;
  if (!at_winch->hangs) return PlanarShape{};
  const EndsInPlane v{at_winch->v, winched.v_at_drone(at_winch->v)};
  return shape_of(seen.plane, v, seen.plane.between(v.station, v.drone),
                  winched.least_tension(v.station), seen.mirrored);
}

std::optional<double> least_winch_tension(const PlanarCable& cable) {
  constexpr int most_steps = 60;
  constexpr double little = 1e-11;
  constexpr double longest_step = 1.5;  // of Newton's method
  const Seen seen(cable);
  if (!outweighs_the_wind(cable) || is_in_line(seen)) return std::nullopt;
  double log_tension = std::log(cable.weight * cable.height);
  for (int i = 0; i < most_steps; ++i) {
    const OnWinch winched(seen.plane, std::exp(log_tension));
    if (!(winched.rise < most_rise)) return std::nullopt;
    const auto farthest = farthest_aside(winched);
    if (!farthest) return std::nullopt;
    const double step = (std::log(seen.beside) - farthest->value) / farthest->by_tension;
    if (!std::isfinite(step)) return std::nullopt;
    log_tension += std::clamp(step, -longest_step, longest_step);
    if (std::abs(step) < little) return std::exp(log_tension);
  }
  return std::nullopt;
}

std::optional<PlanarShape> of_length(const PlanarCable& cable, double length,
                                     const std::optional<PlanarEnds>& near) {
  if (!outweighs_the_wind(cable)) return std::nullopt;
  const Seen seen(cable);
  std::optional<EndsInPlane> v;
  if (near)
    v = ends_of_length(seen.plane, seen.beside, length, EndsInPlane{(*near)[0], (*near)[1]});
  if (!v) v = ends_of_length(seen.plane, seen.beside, length, std::nullopt);
  if (!v) return std::nullopt;
  const Plane::Ways all = seen.plane.between(v->station, v->drone);
  return shape_of(seen.plane, *v, all, length / all.length, seen.mirrored);
}

}  // namespace tethercalc
