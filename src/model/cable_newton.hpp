// Newton's method on a hanging cable: followed from a place on it both ways, it has to end at the
// station and at the drone. `Problem` is that of CableSolver, `Start` what it keeps of its last
// solution; notation and units are those of hanging_cable.cpp.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "model/constants.hpp"
#include "model/runge_kutta.hpp"
#include "model/vector3.hpp"

namespace tethercalc::hanging {

/// How long a step along the cable is, in units of the way on which the load can turn it by a
/// radian: everywhere alike, but shorter where the wind comes along the cable, because drag by the
/// square of a speed that goes through zero has a corner there.
struct Accuracy {
  double step = 0;
  double shortest = 0;            ///< to that corner
  double shortest_to_height = 0;  ///< to a corner in the wind's profile
};
inline constexpr Accuracy coarse{1, 0.1, 1e-3};   ///< while the unknowns are far off
inline constexpr Accuracy fine{0.3, 1e-3, 1e-6};  ///< for forces to 1e-9 of the greatest

/// Of the unknowns, in radians and logarithms: of it, derivatives that are wrong by a quarter leave
/// 2.5e-9, and those of Newton's method next to nothing.
inline constexpr double small_step = 1e-8;

/// A point of the cable, and how it changes with something.
struct Point {
  Vector3 direction{};
  double tension = 0;
  Vector3 position{};
  double length = 0;
};

/// Numbers of a point.
inline constexpr int rows = 8;

/// A point and `columns` of its derivatives, one a column.
template <std::size_t columns>
using State = Eigen::Array<double, rows, 1 + static_cast<int>(columns)>;

inline Point operator*(double k, const Point& p) {
  return {k * p.direction, k * p.tension, k * p.position, k * p.length};
}

inline Point point_at(const double* n) {
  return {{n[0], n[1], n[2]}, n[3], {n[4], n[5], n[6]}, n[7]};
}

inline void put(double* n, const Point& p) {
  n[0] = p.direction.x;
  n[1] = p.direction.y;
  n[2] = p.direction.z;
  n[3] = p.tension;
  n[4] = p.position.x;
  n[5] = p.position.y;
  n[6] = p.position.z;
  n[7] = p.length;
}

/// The numbers of a column.
template <class StateType>
auto* column_of(StateType& state, std::size_t k) {
  return state.data() + rows * k;
}

/// What Newton's method looks for: both ways of the direction, ln of σ and of the tension, and the
/// place (3). All by their change.
inline constexpr int unknown_count = 7;
using Unknowns = Eigen::Matrix<double, unknown_count, 1>;
using Square = Eigen::Matrix<double, unknown_count, unknown_count>;
/// Derivatives that a state carries for them: σ's is the change along the cable.
inline constexpr std::size_t columns_of_unknowns = unknown_count - 1;

/// Follows the cable from `start` to one of its ends, with derivatives by the unknowns there and,
/// of six more, three by the wind and three by the drone's place.
template <std::size_t columns, class Problem, class Start>
std::optional<State<columns>> followed(const Problem& problem, const Start& start, double sigma,
                                       const Accuracy& accuracy) {
  State<columns> state = State<columns>::Zero();
  put(state.data(), {start.direction, start.tension, start.position, 0});
  if constexpr (columns > 0) {
    const auto sideways = across(start.direction);
    put(&state(0, 1), {sideways[0], 0, {}, 0});
    put(&state(0, 2), {sideways[1], 0, {}, 0});
    put(&state(0, 3), {{}, start.tension, {}, 0});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(column_of(state, 4 + axis), {{}, 0, axis_direction(axis), 0});
    }
  }
  if (sigma == 0) return state;
  const double sign = sigma < 0 ? -1 : 1;
  const auto system = [&problem, sign](const State<columns>& at, State<columns>& change) {
    const Point p = point_at(at.data());
    const auto wind = problem.wind_at(p);
    put(change.data(), sign * problem.change(p, wind));
    for (std::size_t k = 1; k <= columns; ++k) {
      Vector3 air_change;
      if (k > columns_of_unknowns) {
        air_change = problem.air_change(p.position, k - 1 - columns_of_unknowns);
      }
      put(column_of(change, k),
          sign * problem.change_of_change(p, wind, point_at(column_of(at, k)), air_change));
    }
  };
  const double longest = std::min(accuracy.step, std::abs(sigma) / 3);
  const auto longest_step = [&](const State<columns>& at) {
    if (problem.steps_left && --*problem.steps_left < 0) return nan;
    return std::min(longest, problem.step_before_corner(point_at(at.data()), sign, accuracy));
  };
  if (!runge_kutta::integrate(system, state, std::abs(sigma), longest_step)) return std::nullopt;
  return state;
}

/// Both ends of the cable.
template <std::size_t columns>
struct EndStates {
  State<columns> station;
  State<columns> drone;
};

template <std::size_t columns, class Problem, class Start>
std::optional<EndStates<columns>> ends_of(const Problem& problem, const Start& start,
                                          const Accuracy& accuracy) {
  const double before = start.before * start.sigma;
  const auto station = followed<columns>(problem, start, -before, accuracy);
  if (!station) return std::nullopt;
  const auto drone = followed<columns>(problem, start, start.sigma - before, accuracy);
  if (!drone) return std::nullopt;
  return EndStates<columns>{*station, *drone};
}

/// How far the ends are from where they should be, or how that changes; the length or the tension
/// at the station is what else is `held`.
inline Unknowns equations(const Vector3& station, const Vector3& drone, double held) {
  Unknowns out;
  out << drone.x, drone.y, drone.z, held, station.x, station.y, station.z;
  return out;
}

template <class Problem, std::size_t columns>
Unknowns miss_of(const Problem& problem, const EndStates<columns>& ends) {
  const Point station = point_at(ends.station.data());
  const Point drone = point_at(ends.drone.data());
  const double held = problem.winch ? std::log(station.tension / *problem.winch)
                                    : drone.length - station.length - problem.length;
  return equations(station.position, drone.position - problem.drone, held);
}

/// For a change of both ends.
template <class Problem>
Unknowns change_of_miss(const Problem& problem, const Point& station_at, const Point& station,
                        const Point& drone) {
  const double held =
      problem.winch ? station.tension / station_at.tension : drone.length - station.length;
  return equations(station.position, drone.position, held);
}

/// Both ends, or how they change with something.
struct BothEnds {
  Point station;
  Point drone;
};

/// How the ends change with each unknown.
template <std::size_t columns, class Problem, class Start>
std::array<BothEnds, unknown_count> by_each_unknown(const Problem& problem,
                                                    const EndStates<columns>& ends,
                                                    const Start& start) {
  const auto derivative = [&ends](std::size_t k) {
    return BothEnds{point_at(column_of(ends.station, k)), point_at(column_of(ends.drone, k))};
  };
  const Point station = point_at(ends.station.data());
  const Point drone = point_at(ends.drone.data());
  const double before = start.before * start.sigma;
  std::array<BothEnds, unknown_count> by{
      derivative(1), derivative(2),
      BothEnds{-before * problem.change(station, problem.wind_at(station)),
               (start.sigma - before) * problem.change(drone, problem.wind_at(drone))}};
  for (std::size_t k = 3; k < unknown_count; ++k) by[k] = derivative(k);
  return by;
}

/// How `miss_of` changes with the unknowns.
template <class Problem>
Square changes_of_miss(const Problem& problem, const Point& station,
                       const std::array<BothEnds, unknown_count>& by) {
  Square out;
  for (int k = 0; k < unknown_count; ++k) {
    const BothEnds& one = by[static_cast<std::size_t>(k)];
    out.col(k) = change_of_miss(problem, station, one.station, one.drone);
  }
  return out;
}

/// How the tension along the cable changes at a point.
inline Vector3 change_of_pull(const Point& at, const Point& change) {
  return change.tension * at.direction + at.tension * change.direction;
}

/// The largest of the angle by which the direction turns, the changes of logarithms, and the way
/// of the place.
inline double size_of(const Unknowns& step) {
  return std::max(std::hypot(step(0), step(1)),
                  step.tail<unknown_count - 2>().cwiseAbs().maxCoeff());
}

template <class Start>
Start moved(const Start& from, const Unknowns& step) {
  Start to = from;
  const auto sideways = across(from.direction);
  to.direction = direction_of(from.direction + step(0) * sideways[0] + step(1) * sideways[1]);
  to.sigma *= std::exp(step(2));
  to.tension *= std::exp(step(3));
  to.position = to.position + Vector3{step(4), step(5), step(6)};
  return to;
}

/// The inverse `of` how misses follow unknowns, made to hold for a step and the change of the miss
/// that it led to (Broyden's method).
inline void learn(std::array<double, 49>& of, const Unknowns& step, const Unknowns& change) {
  constexpr double of_rounding = 1e-7;
  if (step.norm() < of_rounding) return;
  Eigen::Map<Square> inverse(of.data());
  const Unknowns expected = inverse * change;
  const double along = step.dot(expected);
  if (!(std::abs(along) > 0.5 * step.squaredNorm())) return;
  const Square correction = (step - expected) * (step.transpose() * inverse) / along;
  inverse += correction;
}

/// After a last step, taken at the ends by their derivatives.
template <class Start>
Start arrived(const Start& from, const Unknowns& step, const Point& station, const Point& drone) {
  Start at = moved(from, step);
  at.position = at.position - station.position;
  at.ends = {station.tension * direction_of(station.direction),
             drone.tension * direction_of(drone.direction), drone.length - station.length};
  for (int k = 0; k < unknown_count; ++k) {
    const auto& by = at.by_unknowns[static_cast<std::size_t>(k)];
    at.ends = {at.ends.at_station + step(k) * by.at_station,
               at.ends.at_drone + step(k) * by.at_drone, at.ends.length + step(k) * by.length};
  }
  return at;
}

/// Steps with one inverse, corrected by what they led to, as long as each is less than a quarter of
/// the one before. The last is taken at the ends by their derivatives. The first may be known
/// beforehand by the `miss` that it is to mend.
template <class Problem, class Start>
std::optional<Start> refined(const Problem& problem, Start at,
                             std::optional<Unknowns> miss = std::nullopt) {
  double before = 0.3;
  Unknowns last_step = Unknowns::Zero();
  Unknowns last_miss = Unknowns::Zero();
  for (int i = 0; i < 12; ++i) {
    std::optional<EndStates<0>> ends;
    if (!miss) {
      ends = ends_of<0>(problem, at, fine);
      if (!ends) return std::nullopt;
      miss = miss_of(problem, *ends);
      if (i > 0) learn(at.inverse, last_step, *miss - last_miss);
    }
    const Unknowns step = -(Eigen::Map<const Square>(at.inverse.data()) * *miss);
    const double size = size_of(step);
    if (!(size < 0.25 * before)) return std::nullopt;
    if (ends && size < small_step) {
      return arrived(at, step, point_at(ends->station.data()), point_at(ends->drone.data()));
    }
    at = moved(at, step);
    last_step = step;
    last_miss = *miss;
    miss.reset();
    // A step that was known beforehand is not the size of an error.
    before = ends ? size : std::max(size, 0.1 * before);
  }
  return std::nullopt;
}

/// Follows the cable from a place, towards the drone or (`sign` −1) the station, as far as `rest`
/// of a point and its σ says, and gives the σ of the end; nothing where it does not get there.
template <class Problem, class Rest>
std::optional<double> followed_as_far(const Problem& problem, const Point& place, double sign,
                                      const Accuracy& accuracy, const Rest& rest) {
  constexpr double next_to_nothing = 1e-4;
  State<0> state;
  put(state.data(), place);
  const auto system = [&problem, sign](const State<0>& s, State<0>& change) {
    const Point p = point_at(s.data());
    put(change.data(), sign * problem.change(p, problem.wind_at(p)));
  };
  double sigma = 0;
  for (int i = 0; i < runge_kutta::most_steps; ++i) {
    if (problem.steps_left && --*problem.steps_left < 0) return std::nullopt;
    const Point p = point_at(state.data());
    if (!(p.tension > 0 && std::isfinite(p.tension))) return std::nullopt;
    const double left = rest(p, sigma);
    if (std::abs(left) < next_to_nothing) return sigma + left;
    const double step = std::min(0.5, problem.step_before_corner(p, sign, accuracy));
    const double taken = std::clamp(left, -step, step);
    runge_kutta::take_step(system, state, taken);
    sigma += taken;
  }
  return std::nullopt;
}

/// By a step of the unknowns, of which lengths and the tension, as a vector, follow next to
/// linearly: a fold opens from one side to the other through a tension of nothing, of which the
/// logarithm knows nothing.
template <class Problem, class Start>
std::optional<Start> moved_evenly(const Problem& problem, const Start& from, const BothEnds& ends,
                                  const std::array<BothEnds, unknown_count>& by,
                                  const Unknowns& step, const Accuracy& accuracy) {
  Start to = from;
  const auto sideways = across(from.direction);
  const Vector3 pull =
      step(0) * sideways[0] + step(1) * sideways[1] + (1 + step(3)) * from.direction;
  const double ratio = norm(pull);
  to.direction = (1 / ratio) * pull;
  to.tension *= ratio;
  to.position = to.position + Vector3{step(4), step(5), step(6)};
  double before = -ends.station.length;
  double after = ends.drone.length;
  for (int k = 0; k < unknown_count; ++k) {
    const BothEnds& one = by[static_cast<std::size_t>(k)];
    before -= step(k) * one.station.length;
    after += step(k) * one.drone.length;
  }
  const auto sigma_to = [&](double length, double sign) {
    return followed_as_far(
        problem, {to.direction, to.tension, to.position, 0}, sign, accuracy,
        [&](const Point& p, double) { return (length - sign * p.length) / p.tension; });
  };
  const auto first = sigma_to(before, -1);
  const auto second = sigma_to(after, 1);
  if (!first || !second || !(*first + *second > 0)) return std::nullopt;
  to.sigma = *first + *second;
  to.before = *first / to.sigma;
  return to;
}

enum class Digits {
  all,
  few,  ///< two at least, by coarse steps
};

/// Newton's method, halved where it would lead away, until `refined` can take over or a step is
/// short enough.
template <class Problem, class Start>
std::optional<Start> newton(const Problem& problem, Start at, int most_iterations,
                            Digits wanted = Digits::all) {
  constexpr double short_step = 0.01;  // whose square is left
  Accuracy accuracy = coarse;
  auto ends = ends_of<columns_of_unknowns>(problem, at, accuracy);
  if (!ends) return std::nullopt;
  for (int i = 0; i < most_iterations; ++i) {
    const Unknowns miss = miss_of(problem, *ends);
    const BothEnds at_ends{point_at(ends->station.data()), point_at(ends->drone.data())};
    const auto by = by_each_unknown(problem, *ends, at);
    const Square inverse = changes_of_miss(problem, at_ends.station, by).inverse();
    const Unknowns step = -(inverse * miss);
    if (!step.allFinite()) return std::nullopt;
    Eigen::Map<Square>(at.inverse.data()) = inverse;
    for (std::size_t k = 0; k < unknown_count; ++k) {
      at.by_unknowns[k] = {change_of_pull(at_ends.station, by[k].station),
                           change_of_pull(at_ends.drone, by[k].drone),
                           by[k].drone.length - by[k].station.length};
    }
    const double size = size_of(step);
    if (wanted == Digits::few && size < short_step) {
      return arrived(at, step, at_ends.station, at_ends.drone);
    }
    if (size < 0.03) {
      if (const auto found = refined(problem, moved(at, step))) return found;
      if (accuracy.step > fine.step) {  // whose own error may stand in the way
        accuracy = fine;
        ends = ends_of<columns_of_unknowns>(problem, at, accuracy);
        if (!ends) return std::nullopt;
        continue;
      }
    }
    double part = std::min(1.0, 3 / size);
    std::optional<Start> next;
    for (int halvings = 0; halvings < 7 && !next; ++halvings, part *= 0.4) {
      const auto tried = moved_evenly(problem, at, at_ends, by, Unknowns(part * step), accuracy);
      if (!tried) continue;
      ends = ends_of<columns_of_unknowns>(problem, *tried, accuracy);
      if (ends && miss_of(problem, *ends).norm() < miss.norm()) next = tried;
    }
    if (!next) {
      if (accuracy.step <= fine.step) return std::nullopt;
      accuracy = fine;
      ends = ends_of<columns_of_unknowns>(problem, at, accuracy);
      if (!ends) return std::nullopt;
      continue;
    }
    at = *next;
  }
  return std::nullopt;
}

}  // namespace tethercalc::hanging
