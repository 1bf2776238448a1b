// Notation: v with v²/2 = ln(T/least T)/m, negative where the cable still goes down; m =
// w/hypot(w, 2·D). Ways aside are counted from where the cable would end that lies straight in the
// direction in which load and tension balance.
#include "model/winched_cable.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
  /// On which the points miss by 1e-9 or less. Directions have a pole at exp(v²/2) = −q; where that
  /// is far they turn back at |v| = 2.5.
  [[nodiscard]] double piece_for_points() const {
    const double drag = std::abs(cable_.drag);
    const double q = 2 * drag * (1 + std::abs(limit_cos_)) / (cable_.weight + root_ - 2 * drag);
    const double log_q = std::log(q);
    const double beside = std::sqrt(std::hypot(log_q, std::numbers::pi) - log_q);
    return std::min(1.5, 0.8 * beside);
  }

 public:
  explicit Plane(const WinchedCable& cable)
      : cable_(cable),
        root_(std::hypot(cable.weight, 2 * cable.drag)),
        m_(cable.weight / root_),
        limit_cos_(-2 * cable.drag / (cable.weight + root_)),
        limit_sin_(std::sqrt(1 - limit_cos_ * limit_cos_)),
        widest_piece_(piece_for_points()),
        rise_(2 / m_ * std::log1p(cable.weight * cable.height / cable.tension)) {}

  /// Of v² from the winch to the drone.
  [[nodiscard]] double rise() const { return rise_; }
  /// How far aside a straight cable would end.
  [[nodiscard]] double straight_aside() const { return cable_.height * limit_cos_ / limit_sin_; }
  [[nodiscard]] double v_at_drone(double v) const { return std::sqrt(v * v + rise_); }
  [[nodiscard]] double least_tension(double v) const {
    return cable_.tension * std::exp(-0.5 * m_ * v * v);
  }

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
    const double least = cable_.weight + root_ - 2 * drag;
    const double growth = std::expm1(0.5 * v * v);
    const double below = (1 + growth) * least / (1 - limit) + 2 * drag;
    const double from_1 = least * growth / below;
    const double from_limit = (cable_.weight + root_ - 2 * drag * limit) / below;
    const double sin = std::sqrt(from_1 * (2 - from_1));
    const double cos = 1 - from_1;
    const double turn =
        from_limit * (limit_sin_ + limit * (cos + limit) / (sin + limit_sin_)) / limit_sin_;
    return {cos, sign * sin, turn};
  }

  /// Over the least tension, with v or over a part of it: the way aside and the length; and σ.
  struct Ways {
    double aside = 0;
    double length = 0;
    double sigma = 0;
    void add(const Ways& more, double share = 1) {
      aside += share * more.aside;
      length += share * more.length;
      sigma += share * more.sigma;
    }
  };
  // Called at many places, from which copies would only swell the program.
  [[nodiscard, gnu::noinline]] Ways change(double v) const {
    const Direction at = direction(v);
    const double sigma = m_ * v / (cable_.weight * at.sin);
    const double length = std::exp(0.5 * m_ * v * v) * sigma;
    return {at.turn * length, length, sigma};
  }
  /// Over a part that goes one way.
  [[nodiscard]] Ways ways(double from, double to) const {
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
  /// From `v` at the winch to the drone.
  [[nodiscard, gnu::noinline]] Ways to_drone(double v) const {
    const double end = v_at_drone(v);
    const double straight = std::max(v, std::min(end, straight_beyond));
    Ways sum = ways(std::max(v, 0.0), straight);
    if (v < 0) sum.add(ways(v, 0));
    const double rises = cable_.weight * limit_sin_;
    const auto growth = [this](double at) { return std::exp(0.5 * m_ * at * at); };
    sum.add({0, (growth(end) - growth(straight)) / rises,
             0.5 * m_ * (end * end - straight * straight) / rises});
    return sum;
  }

  /// ln of the way aside, and its slope.
  struct Aside {
    double v = 0;
    double value = 0;
    double slope = 0;
  };
  [[nodiscard]] Aside aside(double v) const {
    const double least = least_tension(v);
    const double way = to_drone(v).aside;
    const double end = v_at_drone(v);
    // About v = 0 its limit.
    const double at_winch = change(std::abs(v) < 1e-6 ? 1e-6 : v).aside;
    const double slope = change(end).aside * v / end - at_winch - m_ * v * way;
    return {v, std::log(least * way), slope / way};
  }

 private:
  WinchedCable cable_;
  double root_;
  double m_;
  double limit_cos_;
  double limit_sin_;
  double widest_piece_;
  double rise_;
};

struct AtWinch {
  bool hangs = false;  ///< else no way aside is as far
  double v = 0;
};

/// The tauter cable: where ln of the way aside falls through `wanted`. That falls wherever the
/// cable goes up at the winch; where it goes down it is concave, with its greatest value (both seen
/// of thousands of drawn cables).
std::optional<AtWinch> taut_at_winch(const Plane& plane, double wanted) {
  constexpr double little = 1e-10;
  constexpr int most_steps = 60;
  constexpr double longest_step = 1.5;
  constexpr double back_to_falling = 0.5;
  std::optional<Plane::Aside> rising;
  std::optional<Plane::Aside> falling;
  bool reached = false;
  double v = 0;
  for (int i = 0; i < most_steps && std::abs(v) < straight_beyond; ++i) {
    const Plane::Aside here = plane.aside(v);
    const double excess = here.value - wanted;
    if (!std::isfinite(excess) || !std::isfinite(here.slope)) return std::nullopt;
    const double to_wanted = -excess / here.slope;
    if (here.slope < 0 && std::abs(to_wanted) < little * (1 + std::abs(v))) return AtWinch{true, v};
    if (excess > 0) {
      reached = true;
      v += here.slope < 0 ? std::min(to_wanted, longest_step) : back_to_falling;
      rising.reset();
      continue;
    }
    (here.slope < 0 ? falling : rising) = here;
    if (!rising) {
      v += std::max(to_wanted, -longest_step);
    } else if (falling) {
      // Where it is concave both tangents lie above.
      const double apart = falling->v - rising->v;
      const double bend = rising->slope - falling->slope;
      const double to_crossing = (falling->value - rising->value - falling->slope * apart) / bend;
      if (!reached && rising->value + rising->slope * to_crossing < wanted) return AtWinch{};
      v = rising->v + rising->slope / bend * apart;
    } else {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<TautCable> taut_cable(const WinchedCable& cable) {
  constexpr double least_weight_to_drag = 1e-2;
  constexpr double least_height = 1e-9;  // of the way aside
  // Of the load: below, rounding leaves 1e-9 of the directions.
  constexpr double most_tension = 1e5;
  constexpr double most_rise = 800;  // of v², whose exponential is a number
  constexpr double least_aside = 1e-9;
  const double load = std::hypot(cable.weight, cable.drag) * std::hypot(cable.aside, cable.height);
  if (!(cable.height > least_height * std::abs(cable.aside)) ||
      !(cable.weight > least_weight_to_drag * std::abs(cable.drag)) ||
      !(cable.tension < most_tension * load)) {
    return std::nullopt;
  }
  Plane plane(cable);
  if (!(plane.rise() < most_rise)) return std::nullopt;
  double wanted = cable.aside - plane.straight_aside();
  const bool mirrored = wanted < 0;
  if (mirrored) {
    wanted = -wanted;
    plane = Plane({cable.weight, -cable.drag, cable.tension, -cable.aside, cable.height});
  }
  const bool in_line = wanted < least_aside * cable.height;
  const auto at_winch =
      in_line ? AtWinch{true, straight_beyond} : taut_at_winch(plane, std::log(wanted));
  if (!at_winch) return std::nullopt;
  if (!at_winch->hangs) return TautCable{};
  const double v = at_winch->v;
  const double least = plane.least_tension(v);
  const auto place = [&](double at, double tension) {
    const Plane::Direction there = plane.direction(at);
    return TautCable::Place{mirrored ? -there.cos : there.cos, there.sin, tension};
  };
  TautCable out;
  out.hangs = true;
  out.at_winch = place(v, cable.tension);
  out.at_drone = place(plane.v_at_drone(v), cable.tension + cable.weight * cable.height);
  out.slackest = v < 0 ? place(0, least) : out.at_winch;
  const Plane::Ways all = plane.to_drone(v);
  out.length = least * all.length;
  out.sigma = all.sigma;
  out.before = v < 0 ? plane.ways(v, 0).sigma / all.sigma : 0;
  return out;
}

}  // namespace tethercalc
