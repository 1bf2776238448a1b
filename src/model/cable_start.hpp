// Where Newton's method on a hanging cable starts when there is no solution beside it: from the
// cable under even load, which is led to the true one where that does not do.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "model/cable_newton.hpp"
#include "model/planar_cable.hpp"
#include "tethercalc/model/catenary.hpp"
#include "tethercalc/model/hanging_cable.hpp"

namespace tethercalc::hanging {

/// The cable under the load that it would have along the chord, which is even: a catenary in the
/// plane of that load, with (0, 0) at the station and `up` against the load.
struct EvenLoad {
  double weight = 0;
  Vector3 up{};
  Vector3 ahead{};
  double x = 0;
  double z = 0;
  std::optional<double> stiffness{};

  template <class Problem>
  EvenLoad(const Problem& p, const Vector3& load) {
    weight = norm(load);
    up = weight > 0 ? direction_of(load) : Vector3{0, 0, 1};
    z = dot(p.drone, up);
    const Vector3 level = p.drone - z * up;
    // A cable along its load hangs as a fold, which has no direction to start from.
    x = std::max(norm(level), 1e-3 * norm(p.drone));
    ahead = norm(level) > 0 ? direction_of(level) : across(up)[0];
    // With a known tension the stretch, a few thousandths, is left to Newton's method.
    if (p.compliance > 0 && !p.winch) stiffness = 1 / p.compliance;
  }
  [[nodiscard]] double distance() const { return std::hypot(x, z); }
  [[nodiscard]] std::optional<Catenary> hung(double length) const {
    return catenary(x, z, length, weight, stiffness);
  }
  [[nodiscard]] double tension_at_station(double length) const {
    const auto c = hung(length);
    return c ? std::hypot(c->horizontal, c->vertical_at_start) : infinity;
  }
  /// With this tension at the station; of two lengths the tauter, and the one with the least
  /// tension where that is more.
  [[nodiscard]] double length_with_tension(double tension) const {
    const auto at = [this](double slack) { return tension_at_station(distance() * (1 + slack)); };
    double taut = 1e-9;
    double slack = taut;
    double least = at(slack);
    // From taut to slack the tension falls and, with much cable out, rises again.
    while (least > tension && slack < 4) {
      const double next = at(1.5 * slack);
      if (next > least) break;
      taut = slack;
      slack *= 1.5;
      least = next;
    }
    for (int i = 0; i < 40 && least <= tension; ++i) {
      const double middle = std::sqrt(taut * slack);
      (at(middle) < tension ? slack : taut) = middle;
    }
    return distance() * (1 + slack);
  }
};

template <class Start, class Problem>
std::optional<Start> under_even_load(const Problem& p, const Vector3& load) {
  const EvenLoad even(p, load);
  if (!(even.weight > 0)) return std::nullopt;
  const double known = even.stiffness ? p.length : std::max(p.length, even.distance() * (1 + 1e-9));
  const auto c = even.hung(p.winch ? even.length_with_tension(*p.winch) : known);
  if (!c || !(c->horizontal > 0)) return std::nullopt;
  // From the place with the least tension both ways: from elsewhere, what lies behind it is lost
  // in the rounding of the start.
  const double first = std::asinh(c->vertical_at_start / c->horizontal);
  const double last = std::asinh(c->vertical_at_end / c->horizontal);
  const double middle = std::clamp(0.0, first, last);
  const Vector3 tension =
      c->horizontal * even.ahead + (c->horizontal * std::sinh(middle)) * even.up;
  Start out;
  out.direction = direction_of(tension);
  out.tension = norm(tension);
  out.sigma = (last - first) / even.weight;
  out.before = (middle - first) / (last - first);
  return out;
}

/// The same cable, to be followed from where its tension is least.
template <class Start, class Problem>
Start from_slackest(const Problem& problem, const Start& at) {
  Start out = at;
  for (const double sign : {-1.0, 1.0}) {
    const double end = (sign < 0 ? at.before : 1 - at.before) * at.sigma;
    followed_as_far(problem, {at.direction, at.tension, at.position, 0}, sign, coarse,
                    [&](const Point& p, double sigma) {
                      if (p.tension < out.tension) {
                        out.direction = direction_of(p.direction);
                        out.tension = p.tension;
                        out.position = p.position;
                        out.before = at.before + sign * sigma / at.sigma;
                      }
                      return end - sigma;
                    });
  }
  return out;
}

/// Whether less tension at the station goes with more cable: of two lengths with one tension the
/// tauter. Where both become one, the unknowns follow no more from what is held.
template <class Problem, class Start>
bool is_tauter(const Problem& problem, const Start& at) {
  return !problem.winch || Eigen::Map<const Square>(at.inverse.data()).determinant() > 0;
}

/// Follows a solution while `changed` turns its problem from share 1 of a known one into share 0,
/// by as much at a time as leads on; the last that was found, and what is left there.
template <class Start, class Changed>
std::pair<Start, double> led_on(const Changed& changed, Start at) {
  double left = 1;
  double part = 0.5;
  while (left > 0 && part < 0.99) {
    const double next = part < 0.01 ? 0 : left * part;
    const auto problem = changed(next);
    const auto found = newton(problem, at, 8);
    if (found && is_tauter(problem, *found)) {
      at = from_slackest(problem, *found);
      left = next;
      part *= part;
    } else {
      part = std::sqrt(part);
    }
  }
  return {at, left};
}

/// From the cable under an even load, which also presses it `aside`: where load and chord are about
/// in line the cable folds, and turns from one side to the other past that, not through it.
template <class Start, class Problem>
std::optional<Start> led_from(const Problem& problem, const Vector3& load, double aside) {
  const Vector3 chord = direction_of(problem.drone);
  const Vector3 normal = cross(chord, load);
  const Vector3 first =
      load + aside * (norm(normal) > 1e-6 ? direction_of(normal) : across(chord)[0]);
  const auto changed = [&](double share) {
    Problem p = problem;
    p.steady = (1 - share) * p.steady + share * first;
    p.drag *= 1 - share;
    return p;
  };
  auto at = under_even_load<Start>(problem, first);
  if (at) at = newton(changed(1), *at, 30);
  if (!at) return std::nullopt;
  const auto [found, left] = led_on(changed, *at);
  return left > 0 ? std::nullopt : std::optional<Start>(found);
}

/// From a cable that is nearly straight, by a winch that gives way; or how much of the logarithm of
/// its tension is left where it holds the cable up no more.
template <class Start, class Problem>
std::optional<std::pair<Start, double>> let_out(const Problem& problem, const Vector3& load) {
  constexpr double taut = 30;  // of the load
  const auto changed = [&](double share) {
    Problem p = problem;
    p.winch = std::pow(std::max(taut, *p.winch), share) * std::pow(*p.winch, 1 - share);
    return p;
  };
  const Problem first = changed(1);
  auto at = under_even_load<Start>(first, load);
  if (at) at = newton(first, *at, 30);
  if (!at) return std::nullopt;
  return led_on(changed, *at);
}

/// A cable as long as it is, and what the tension at its station does as it grows longer.
template <class Start>
struct LetOut {
  double log_slack = 0;  ///< ln(length/chord − 1)
  Start at;
  double excess = 0;  ///< ln(tension/the winch's)
  double slope = 0;   ///< of that, by `log_slack`
};

/// How the unknowns change with the length, where that is held.
template <class Start>
Unknowns change_by_length(const Start& at) {
  constexpr int held = 3;
  return Eigen::Map<const Square>(at.inverse.data()).col(held);
}

/// With `log_slack`, from the `last` one or, where there is none, from `start`.
template <class Problem, class Start>
std::optional<LetOut<Start>> let_out_to(const Problem& problem, double log_slack, Start start,
                                        const std::optional<LetOut<Start>>& last, Digits wanted) {
  const double slack = norm(problem.drone) * std::exp(log_slack);
  Problem of_length = problem;
  of_length.winch.reset();
  of_length.length = norm(problem.drone) + slack;
  if (last) {
    const double longer = slack - norm(problem.drone) * std::exp(last->log_slack);
    const Unknowns step = longer * change_by_length(last->at);
    start = moved(last->at, std::min(1.0, 0.5 / size_of(step)) * step);
  }
  const auto found = newton(of_length, start, 30, wanted);
  if (!found) return std::nullopt;
  const double tension = norm(found->ends.at_station);
  Vector3 by_length;
  const Unknowns unknowns = change_by_length(*found);
  for (int k = 0; k < unknown_count; ++k) {
    by_length =
        by_length + unknowns(k) * found->by_unknowns[static_cast<std::size_t>(k)].at_station;
  }
  const double slope = slack * dot(by_length, found->ends.at_station) / (tension * tension);
  return LetOut<Start>{log_slack, *found, std::log(tension / *problem.winch), slope};
}

/// The cable of a winch by its length, from that under an even load, until the tension is the
/// winch's. Where it falls no more before that, the winch is too weak: between a cable whose
/// tension falls and one whose tension rises the logarithm lies above both of its tangents. That
/// holds where the slack is more than what stretches: less is left to who lets it out by its
/// tension. Roughly first, until it may hang on the rest.
template <class Start, class Problem>
std::optional<Start> by_length(const Problem& problem, const Vector3& load, CableOutcome& why_not) {
  constexpr double longest_step = 1.5;
  constexpr double close = 1e-3;
  constexpr double near = 0.2;
  constexpr double error_of_few = 0.02;
  constexpr double least_log_slack = -12;
  constexpr double most_log_slack = 2;
  std::optional<LetOut<Start>> tauter;   // its tension falls to the winch's, or may
  std::optional<LetOut<Start>> slacker;  // it has fallen too far, or rises
  const auto start = under_even_load<Start>(problem, load);
  if (!start) return std::nullopt;
  const EvenLoad even(problem, load);
  double log_slack = std::log(even.length_with_tension(*problem.winch) / even.distance() - 1);
  Digits wanted = Digits::few;
  std::optional<LetOut<Start>> last;
  for (int i = 0; i < 40 && log_slack > least_log_slack && log_slack < most_log_slack; ++i) {
    const auto here = let_out_to(problem, log_slack, *start, last, wanted);
    if (!here) return std::nullopt;
    last = here;
    const bool falls = here->slope < 0;
    if (falls && std::abs(here->excess / here->slope) < close) {
      const auto found = newton(problem, here->at, 8);
      if (found && is_tauter(problem, *found)) return found;
    }
    (falls && here->excess > 0 ? tauter : slacker) = here;
    double next = falls ? log_slack - here->excess / here->slope : log_slack - longest_step;
    if (tauter && slacker) {
      const double apart = slacker->log_slack - tauter->log_slack;
      const double bend = slacker->slope - tauter->slope;
      const bool rises = slacker->slope >= 0;
      const double crossing = (tauter->excess - slacker->excess + slacker->slope * apart) / bend;
      const double least = tauter->excess + tauter->slope * crossing;
      // Tangents that cross high above the winch's tension say so from afar: the logarithm falls by
      // less than ln of the slack, of a taut cable by half of it.
      if (rises && slacker->excess > 0 && (apart < near || least > apart)) {
        if (least > (wanted == Digits::few ? error_of_few : 0)) {
          why_not = CableOutcome::tension_too_low;
          return std::nullopt;
        }
        if (wanted == Digits::few) {
          wanted = Digits::all;
          log_slack = tauter->log_slack;
          last = tauter;
          tauter.reset();
          slacker.reset();
          continue;
        }
      }
      if (rises && slacker->excess > 0) next = tauter->log_slack - tauter->slope / bend * apart;
      const double edge = 0.05 * apart;
      if (!(next > tauter->log_slack + edge && next < slacker->log_slack - edge)) {
        next = tauter->log_slack + 0.5 * apart;
      }
    }
    if (!std::isfinite(next)) return std::nullopt;
    log_slack += std::clamp(next - log_slack, -longest_step, longest_step);
  }
  return std::nullopt;
}

/// The cable where that is known but for integrals, or that there is none; nothing where it lies in
/// no plane with weight, wind and drone. From the `ends` of the last such cable to its own.
template <class Start, class Problem>
std::optional<std::pair<bool, Start>> in_a_plane(const Problem& p, bool in_still_air,
                                                 std::optional<PlanarEnds>& ends) {
  const Vector3& wind = p.air.wind;
  const double speed = std::hypot(wind.x, wind.y);
  const double aside = std::hypot(p.drone.x, p.drone.y);
  const Vector3 ahead = aside > 0   ? Vector3{p.drone.x / aside, p.drone.y / aside, 0}
                        : speed > 0 ? Vector3{wind.x / speed, wind.y / speed, 0}
                                    : Vector3{1, 0, 0};
  const double along = dot(wind, ahead);
  constexpr double digits = 1e-12;
  const bool plane = wind.z == 0 && std::abs(wind.x * ahead.y - wind.y * ahead.x) <= digits * speed;
  const bool even = plane && p.even() && p.reynolds == 0;
  if (!(in_still_air || even) || (!p.winch && p.compliance > 0)) return std::nullopt;
  const PlanarCable cable{.weight = p.steady.z,
                          .drag = p.drag * speed * along,
                          .compliance = p.compliance,
                          .aside = aside,
                          .height = p.drone.z};
  const auto shape =
      p.winch ? held_by_winch(cable, *p.winch, ends) : of_length(cable, p.length, ends);
  // Whoever asks for a shape follows it in steps of a third of σ's unit or less.
  constexpr double most_sigma = 0.1 * runge_kutta::most_steps;
  if (!shape || shape->sigma > most_sigma) return std::nullopt;
  if (shape->hangs) ends = shape->ends;
  const auto direction = [&ahead](const PlanarShape::Place& place) {
    return place.along_x * ahead + Vector3{0, 0, place.along_z};
  };
  Start at;
  at.direction = direction(shape->slackest);
  at.tension = shape->slackest.tension;
  at.sigma = shape->sigma;
  at.before = shape->before;
  at.ends = {shape->at_station.tension * direction(shape->at_station),
             shape->at_drone.tension * direction(shape->at_drone), shape->length};
  return std::pair{shape->hangs, at};
}

/// Where the cable has come that share of the way.
template <class Problem>
Vector3 load_along_chord(const Problem& problem, double share) {
  return problem.wind_at({direction_of(problem.drone), 1, share * problem.drone, 0}).load;
}

/// From the cable under an even load.
template <class Start, class Problem>
std::optional<Start> from_even_load(const Problem& problem, const Vector3& load) {
  auto at = under_even_load<Start>(problem, load);
  if (at) at = newton(problem, *at, 30);
  return at;
}

template <class Start, class Problem>
std::optional<Start> held_by_winch(const Problem& problem, CableOutcome& why_not) {
  const Vector3 load = load_along_chord(problem, 0.6);
  // One that takes more is found sooner by its length.
  constexpr int steps_of_usual_cable = 250;
  int steps = std::min(steps_of_usual_cable, *problem.steps_left);
  *problem.steps_left -= steps;
  Problem soon = problem;
  soon.steps_left = &steps;
  const auto at = from_even_load<Start>(soon, load);
  *problem.steps_left += std::max(0, steps);
  if (at && is_tauter(problem, *at)) return at;
  // Where load and chord are in line, a tension may be that of cables to either side.
  constexpr double in_line = 0.03;
  const double across_load = norm(cross(direction_of(load), direction_of(problem.drone)));
  if (across_load > in_line) {
    if (const auto found = by_length<Start>(problem, load, why_not)) return found;
    if (why_not == CableOutcome::tension_too_low) return std::nullopt;
  }
  const auto found = let_out<Start>(problem, load);
  if (found && found->second == 0) return found->first;
  const bool looked_everywhere = *problem.steps_left > 0;
  if (found && found->second < 1 && looked_everywhere) why_not = CableOutcome::tension_too_low;
  return std::nullopt;
}

template <class Start, class Problem>
std::optional<Start> anew(const Problem& problem) {
  // The load along the chord, where that is the same all along; else also nearer to the ends.
  std::vector<Vector3> loads;
  for (const double share : {0.6, 0.3, 1.0}) {
    loads.push_back(load_along_chord(problem, share));
    if (problem.even()) break;
  }
  for (const Vector3& load : loads) {
    if (const auto at = from_even_load<Start>(problem, load)) return at;
  }
  for (const Vector3& load : loads) {
    for (const double aside : {0.1, -0.1}) {
      if (const auto at = led_from<Start>(problem, load, aside)) return at;
    }
  }
  return std::nullopt;
}

}  // namespace tethercalc::hanging
