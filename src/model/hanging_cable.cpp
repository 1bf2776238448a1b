// Notation: t direction of the cable, T tension, r position, s length without tension; lengths in
// units of the cable's (or, where the winch decides it, of the distance), forces in units of the
// load on that length; σ with ds = T·dσ.
#include "tethercalc/model/hanging_cable.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/constants.hpp"
#include "model/planar_cable.hpp"
#include "tethercalc/model/catenary.hpp"

namespace tethercalc {
namespace {

/// How long a step along the cable is, in units of the way on which the load can turn it by a
/// radian: everywhere alike, but shorter where the wind comes along the cable, because drag by the
/// square of a speed that goes through zero has a corner there.
struct Accuracy {
  double step = 0;
  double shortest = 0;            ///< to that corner
  double shortest_to_height = 0;  ///< to a corner in the wind's profile
};
constexpr Accuracy coarse{1, 0.1, 1e-3};   ///< while the unknowns are far off
constexpr Accuracy fine{0.3, 1e-3, 1e-6};  ///< for forces to 1e-9 of the greatest
constexpr int most_steps_along = 4000;

/// Of the unknowns, in radians and logarithms: of it, derivatives that are wrong by a quarter leave
/// 2.5e-9, and those of Newton's method next to nothing.
constexpr double small_step = 1e-8;

double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }
Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector3 operator*(double k, const Vector3& a) { return {k * a.x, k * a.y, k * a.z}; }
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector3 unit(const Vector3& a) { return (1 / norm(a)) * a; }

Vector3 axis_direction(std::size_t axis) {
  return {axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
}

/// Two directions across `t` and each other.
std::array<Vector3, 2> across(const Vector3& t) {
  const Vector3 other = std::abs(t.z) < 0.7 ? Vector3{0, 0, 1} : Vector3{1, 0, 0};
  const Vector3 first = unit(cross(other, t));
  return {first, cross(t, first)};
}

/// Below this share of the reference height a power law, whose slope has no end at the ground, is
/// taken as a straight line to it.
constexpr double linear_below = 0.01;

/// Whether the wind is that at a height where there is none.
bool is_still(const MovingAir& air) {
  return air.profile == WindProfile::logarithmic && !(air.reference_height > air.roughness_length);
}

/// Heights in m over the station at which the slope of the wind's profile jumps.
std::array<double, 2> corner_heights(const MovingAir& air) {
  if (air.profile == WindProfile::power_law)
    return {-air.station_height, linear_below * air.reference_height - air.station_height};
  return {air.roughness_length - air.station_height, air.roughness_length - air.station_height};
}

/// Of the wind that is not the same at all heights, the part that there is at `height`.
double profile_share(const MovingAir& air, double height) {
  const double over_ground = height + air.station_height;
  switch (air.profile) {
    case WindProfile::uniform:
      return 1;
    case WindProfile::power_law:
      return over_ground > linear_below * air.reference_height
                 ? std::pow(over_ground / air.reference_height, air.exponent)
                 : std::max(over_ground / (linear_below * air.reference_height), 0.0) *
                       std::pow(linear_below, air.exponent);
    case WindProfile::logarithmic:
      return over_ground > air.roughness_length && !is_still(air)
                 ? std::log(over_ground / air.roughness_length) /
                       std::log(air.reference_height / air.roughness_length)
                 : 0;
  }
  return 1;
}

double profile_share_slope(const MovingAir& air, double height) {
  const double over_ground = height + air.station_height;
  if (over_ground <= 0) return 0;
  switch (air.profile) {
    case WindProfile::uniform:
      return 0;
    case WindProfile::power_law:
      return over_ground < linear_below * air.reference_height
                 ? profile_share(air, height) / over_ground
                 : air.exponent * profile_share(air, height) / over_ground;
    case WindProfile::logarithmic:
      return over_ground > air.roughness_length && !is_still(air)
                 ? 1 / (over_ground * std::log(air.reference_height / air.roughness_length))
                 : 0;
  }
  return 0;
}

double wind_share_slope(const MovingAir& air, double height) {
  return (1 - air.even_share) * profile_share_slope(air, height);
}

/// A point of the cable, and how it changes with something.
struct Point {
  Vector3 direction{};
  double tension = 0;
  Vector3 position{};
  double length = 0;
};

/// Numbers of a point.
constexpr int rows = 8;

/// A point and `columns` of its derivatives, one a column.
template <std::size_t columns>
using State = Eigen::Array<double, rows, 1 + static_cast<int>(columns)>;

Point operator*(double k, const Point& p) {
  return {k * p.direction, k * p.tension, k * p.position, k * p.length};
}

Point point_at(const double* n) { return {{n[0], n[1], n[2]}, n[3], {n[4], n[5], n[6]}, n[7]}; }

void put(double* n, const Point& p) {
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

constexpr std::size_t stages = 12;
/// Order 8 (Fehlberg 1968, NASA TR R-287) without the stage that his estimate of the error alone
/// uses: it is zero for an integral, and places are integrals of the direction.
constexpr std::array<std::array<double, stages - 1>, stages> stage_weights{{
    {},
    {2. / 27},
    {1. / 36, 1. / 12},
    {1. / 24, 0, 1. / 8},
    {5. / 12, 0, -25. / 16, 25. / 16},
    {1. / 20, 0, 0, 1. / 4, 1. / 5},
    {-25. / 108, 0, 0, 125. / 108, -65. / 27, 125. / 54},
    {31. / 300, 0, 0, 0, 61. / 225, -2. / 9, 13. / 900},
    {2, 0, 0, -53. / 6, 704. / 45, -107. / 9, 67. / 90, 3},
    {-91. / 108, 0, 0, 23. / 108, -976. / 135, 311. / 54, -19. / 60, 17. / 6, -1. / 12},
    {3. / 205, 0, 0, 0, 0, -6. / 41, -3. / 205, -3. / 41, 3. / 41, 6. / 41},
    {-1777. / 4100, 0, 0, -341. / 164, 4496. / 1025, -289. / 82, 2193. / 4100, 51. / 82, 33. / 164,
     12. / 41, 1},
}};
constexpr std::size_t first_weighed = 5;
constexpr std::array<double, stages> step_weights{
    0, 0, 0, 0, 0, 34. / 105, 9. / 35, 9. / 35, 9. / 280, 9. / 280, 41. / 840, 41. / 840};

/// One step of `h`. `change` writes how a state changes.
template <class StateType, class System>
void take_step(const System& change, StateType& state, double h) {
  constexpr Eigen::Index columns = StateType::ColsAtCompileTime;
  std::array<StateType, stages> changes;
  // Number by number: a pair of numbers that was just written one by one is slow to load at once.
  const auto take_stage = [&]<std::size_t stage, std::size_t... before>(
      std::integral_constant<std::size_t, stage>, std::index_sequence<before...>) {
    StateType at = state;
    for (Eigen::Index column = 0; column < columns; ++column) {
      for (Eigen::Index row = 0; row < rows; ++row) {
        double sum = 0;
        [[maybe_unused]] const auto add =
            [&]<std::size_t j>(std::integral_constant<std::size_t, j>) {
              constexpr double weight = stage_weights[stage][j];
              if constexpr (weight != 0) sum += weight * changes[j](row, column);
            };
        (add(std::integral_constant<std::size_t, before>()), ...);
        at(row, column) += h * sum;
      }
    }
    change(at, changes[stage]);
  };
  [&]<std::size_t... stage>(std::index_sequence<stage...>) {
    (take_stage(std::integral_constant<std::size_t, stage>(), std::make_index_sequence<stage>()),
     ...);
  }
  (std::make_index_sequence<stages>());
  for (Eigen::Index column = 0; column < columns; ++column) {
    for (Eigen::Index row = 0; row < rows; ++row) {
      double sum = 0;
      for (std::size_t j = first_weighed; j < stages; ++j) {
        sum += step_weights[j] * changes[j](row, column);
      }
      state(row, column) += h * sum;
    }
  }
}

/// In steps of order 8 from 0 to `end`, each as long as `longest_step` says of the state.
template <class StateType, class System, class LongestStep>
bool integrate(const System& change, StateType& state, double end,
               const LongestStep& longest_step) {
  double at = 0;
  for (int i = 0; i < most_steps_along; ++i) {
    const double rest = end - at;
    const double step = longest_step(state);
    if (!std::isfinite(step)) return false;
    // Two halves rather than a whole and a scrap.
    const double taken = step >= rest ? rest : 2 * step > rest ? 0.5 * rest : step;
    take_step(change, state, taken);
    if (taken == rest) return state.allFinite();
    at += taken;
  }
  return false;
}

}  // namespace

Vector3 level_wind(double speed, double from) {
  return {-speed * std::cos(from), speed * std::sin(from), 0};
}

double wind_share(const MovingAir& air, double height) {
  return air.even_share + (1 - air.even_share) * profile_share(air, height);
}

CylinderDrag cylinder_drag(double reynolds) {
  const double re = std::max(reynolds, 1.0);
  const double falls = 6.8 * std::pow(re, -0.89);
  const double root = 1.96 / std::sqrt(re);
  const double bend = 1 + 3.64e-7 * re * re;
  CylinderDrag drag{.coefficient = 1.18 + falls + root - 0.0004 * re / bend};
  if (reynolds > 1) {
    drag.slope = -(0.89 * falls + 0.5 * root) / re - 0.0004 * (2 - bend) / (bend * bend);
  }
  return drag;
}

double drag_across(const Cable& cable, const MovingAir& air, double speed) {
  const double by_cylinder =
      cable.cylinder_diameter
          ? cylinder_drag(*cable.cylinder_diameter * air.density / air.viscosity * speed)
                .coefficient
          : 1;
  return 0.5 * air.density * cable.drag_coefficient * by_cylinder * cable.diameter * speed * speed;
}

/// The cable in its own units.
struct CableSolver::Problem {
  double metre = 1;       ///< m, the unit of length
  double newton = 1;      ///< N, the unit of force
  Vector3 steady{};       ///< what of the load is the same everywhere: the weight
  double drag = 0;        ///< ½·ρ·C·d
  double reynolds = 0;    ///< s/m, Reynolds number by speed; 0: C is the same at all
  double compliance = 0;  ///< 1/EA
  MovingAir air{};
  Vector3 drone{};
  bool moves = false;
  int* steps_left = nullptr;      ///< of those that may be taken
  double length = 1;              ///< of the cable, but where the winch decides:
  std::optional<double> winch{};  ///< tension at the station

  [[nodiscard]] bool even() const { return air.profile == WindProfile::uniform && !moves; }
  [[nodiscard]] double chord_share(const Vector3& r) const {
    return dot(r, drone) / dot(drone, drone);
  }
  [[nodiscard]] Vector3 air_velocity(const Vector3& r) const {
    if (even()) return air.wind;
    Vector3 v = wind_share(air, r.z * metre) * air.wind;
    if (moves) v = v - chord_share(r) * air.drone_velocity;
    return v;
  }
  /// What the air does at a point of the cable.
  struct Wind {
    Vector3 velocity{};  ///< of the air past the cable
    double along = 0;
    Vector3 normal{};
    double speed = 0;       ///< across the cable
    double drag = 0;        ///< over `normal`
    double drag_slope = 0;  ///< of the drag, by the speed
    Vector3 load{};         ///< weight less drag: N' of the equilibrium
    double load_along = 0;
  };
  [[nodiscard]] Wind wind_at(const Point& p) const {
    Wind w;
    w.velocity = air_velocity(p.position);
    w.along = dot(w.velocity, p.direction);
    w.normal = w.velocity - w.along * p.direction;
    // The direction has the length 1. Its part along the wind is known before `normal`.
    w.speed = std::sqrt(std::max(0.0, dot(w.velocity, w.velocity) - w.along * w.along));
    w.drag = drag * w.speed;
    w.drag_slope = drag;
    if (reynolds > 0) {
      const CylinderDrag cylinder = cylinder_drag(reynolds * w.speed);
      w.drag *= cylinder.coefficient;
      w.drag_slope *= cylinder.coefficient + cylinder.slope * reynolds * w.speed;
    }
    w.load = steady - w.drag * w.normal;
    w.load_along = dot(steady, p.direction);  // drag is across the cable
    return w;
  }
  /// How far a step may go, towards the drone or (`sign` −1) towards the station, to the corner in
  /// the drag where the wind comes along the cable, and to those in the wind's profile.
  [[nodiscard]] double step_before_corner(const Point& p, double sign,
                                          const Accuracy& accuracy) const {
    const Wind w = wind_at(p);
    double step = accuracy.step;
    const double pressure = drag * dot(w.velocity, w.velocity);
    if (air.profile != WindProfile::uniform) {
      // To where the cable has risen by `height` at the earliest: it may turn that way and its
      // tension grow.
      const double turn = norm(steady) + pressure;
      const auto reach = [&](double height, double rise) {
        const double way = std::log1p(turn * height / metre / p.tension) / turn;
        const double root = std::sqrt(rise * rise + 2 * turn * way);
        return rise > 0 ? 2 * way / (rise + root) : (root - rise) / turn;
      };
      const auto shorten = [&](double to) {
        step = std::min(step, std::max(to, accuracy.shortest_to_height));
      };
      for (const double height : corner_heights(air)) {
        const double above = height - p.position.z * metre;
        const double rise = above < 0 ? -p.direction.z : p.direction.z;
        shorten(0.9 * reach(std::abs(above), sign * rise));
      }
      // Over the ground the profile has a singularity there.
      const double over_ground = p.position.z * metre + air.station_height;
      if (over_ground > 0) shorten(reach(0.3 * over_ground, std::abs(p.direction.z)));
    }
    if (pressure < 1e-9) return step;
    const double turn = norm(w.load - w.load_along * p.direction) + 0.02;
    return std::min(step, std::max(0.3 * w.speed / (norm(w.velocity) * turn), accuracy.shortest));
  }
  /// By σ.
  [[nodiscard]] Point change(const Point& p, const Wind& w) const {
    return {w.load - w.load_along * p.direction, p.tension * w.load_along,
            (p.tension * (1 + p.tension * compliance)) * p.direction, p.tension};
  }
  /// Derivative of the air's velocity at a place by the wind (`parameter` 0 to 2) and by the
  /// drone's own place (3 to 5).
  [[nodiscard]] Vector3 air_change(const Vector3& r, std::size_t parameter) const {
    const std::size_t axis = parameter % 3;
    const Vector3 e = axis_direction(axis);
    if (parameter < 3) return wind_share(air, r.z * metre) * e;
    // The share of the way along the chord, r·d/d², by d.
    const double share = (dot(r, e) - 2 * chord_share(r) * dot(drone, e)) / dot(drone, drone);
    return -share * air.drone_velocity;
  }
  /// Derivative of `change` by the state, times `d`, and by the air's velocity, times `dv`.
  [[nodiscard]] Point change_of_change(const Point& p, const Wind& w, const Point& d,
                                       const Vector3& dv) const {
    Vector3 velocity = dv;
    if (!even()) {
      const double slope = wind_share_slope(air, p.position.z * metre) * metre;
      velocity = velocity + (slope * d.position.z) * air.wind;
    }
    if (moves) velocity = velocity - chord_share(d.position) * air.drone_velocity;
    const Vector3 normal =
        velocity - (dot(velocity, p.direction) + dot(w.velocity, d.direction)) * p.direction -
        w.along * d.direction;
    const double faster = w.speed > 0 ? dot(w.normal, normal) / w.speed : 0.0;
    const Vector3 load = -w.drag * normal - (w.drag_slope * faster) * w.normal;
    return {load - (dot(load, p.direction) + dot(w.load, d.direction)) * p.direction -
                w.load_along * d.direction,
            d.tension * w.load_along + p.tension * dot(steady, d.direction),
            (d.tension * (1 + 2 * p.tension * compliance)) * p.direction +
                (p.tension * (1 + p.tension * compliance)) * d.direction,
            d.tension};
  }
};

namespace {

/// What Newton's method looks for: both ways of the direction, ln of σ and of the tension, and the
/// place (3). All by their change.
constexpr int unknown_count = 7;
using Unknowns = Eigen::Matrix<double, unknown_count, 1>;
using Square = Eigen::Matrix<double, unknown_count, unknown_count>;
/// Derivatives that a state carries for them: σ's is the change along the cable.
constexpr std::size_t columns_of_unknowns = unknown_count - 1;

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
  if (!integrate(system, state, std::abs(sigma), longest_step)) return std::nullopt;
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
Unknowns equations(const Vector3& station, const Vector3& drone, double held) {
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
Vector3 change_of_pull(const Point& at, const Point& change) {
  return change.tension * at.direction + at.tension * change.direction;
}

/// The largest of the angle by which the direction turns, the changes of logarithms, and the way
/// of the place.
double size_of(const Unknowns& step) {
  return std::max(std::hypot(step(0), step(1)),
                  step.tail<unknown_count - 2>().cwiseAbs().maxCoeff());
}

template <class Start>
Start moved(const Start& from, const Unknowns& step) {
  Start to = from;
  const auto sideways = across(from.direction);
  to.direction = unit(from.direction + step(0) * sideways[0] + step(1) * sideways[1]);
  to.sigma *= std::exp(step(2));
  to.tension *= std::exp(step(3));
  to.position = to.position + Vector3{step(4), step(5), step(6)};
  return to;
}

/// The inverse `of` how misses follow unknowns, made to hold for a step and the change of the miss
/// that it led to (Broyden's method).
void learn(std::array<double, 49>& of, const Unknowns& step, const Unknowns& change) {
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
  at.ends = {station.tension * unit(station.direction), drone.tension * unit(drone.direction),
             drone.length - station.length};
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
  for (int i = 0; i < most_steps_along; ++i) {
    if (problem.steps_left && --*problem.steps_left < 0) return std::nullopt;
    const Point p = point_at(state.data());
    if (!(p.tension > 0 && std::isfinite(p.tension))) return std::nullopt;
    const double left = rest(p, sigma);
    if (std::abs(left) < next_to_nothing) return sigma + left;
    const double step = std::min(0.5, problem.step_before_corner(p, sign, accuracy));
    const double taken = std::clamp(left, -step, step);
    take_step(system, state, taken);
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

}  // namespace

CableSolver::Problem CableSolver::problem() const {
  Problem p;
  p.metre = paid_out_.length ? *paid_out_.length : norm(drone_);
  const double speed = norm(air_.wind) + norm(air_.drone_velocity);
  const double drag = 0.5 * air_.density * cable_.drag_coefficient * cable_.diameter;
  p.newton = (cable_.weight + drag * speed * speed) * p.metre;
  p.steady = {0, 0, cable_.weight * p.metre / p.newton};
  p.drag = drag * p.metre / p.newton;
  if (cable_.cylinder_diameter) {
    p.reynolds = *cable_.cylinder_diameter * air_.density / air_.viscosity;
  }
  p.compliance = cable_.axial_stiffness ? p.newton / *cable_.axial_stiffness : 0;
  p.air = air_;
  p.moves = !(air_.drone_velocity == Vector3{});
  p.drone = (1 / p.metre) * drone_;
  if (!paid_out_.length) p.winch = *paid_out_.winch_tension / p.newton;
  return p;
}

namespace {

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
    up = weight > 0 ? unit(load) : Vector3{0, 0, 1};
    z = dot(p.drone, up);
    const Vector3 level = p.drone - z * up;
    // A cable along its load hangs as a fold, which has no direction to start from.
    x = std::max(norm(level), 1e-3 * norm(p.drone));
    ahead = norm(level) > 0 ? unit(level) : across(up)[0];
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
  out.direction = unit(tension);
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
                        out.direction = unit(p.direction);
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
  const Vector3 chord = unit(problem.drone);
  const Vector3 normal = cross(chord, load);
  const Vector3 first = load + aside * (norm(normal) > 1e-6 ? unit(normal) : across(chord)[0]);
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
  constexpr double most_sigma = 0.1 * most_steps_along;
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
  return problem.wind_at({unit(problem.drone), 1, share * problem.drone, 0}).load;
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
  const double across_load = norm(cross(unit(load), unit(problem.drone)));
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

/// A solution in another problem's units.
template <class Problem, class Last>
Last in_units_of(const Problem& now, const Problem& before, Last last) {
  const double newtons = before.newton / now.newton;
  const double metres = before.metre / now.metre;
  last.position = metres * last.position;
  last.tension *= newtons;
  last.sigma *= metres / newtons;
  for (auto& by : last.by_unknowns) {
    by = {newtons * by.at_station, newtons * by.at_drone, metres * by.length};
  }
  return last;
}

void check(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

void check(const Cable& cable, const MovingAir& air, const PaidOut& paid_out,
           const Vector3& drone) {
  check(cable.weight >= 0 && cable.diameter >= 0 && cable.drag_coefficient >= 0 && air.density >= 0,
        "weight, diameter, drag coefficient and air density of a cable are not negative");
  check(cable.cylinder_diameter.value_or(1) > 0 && air.viscosity > 0,
        "a cylinder has a diameter and air is viscous");
  check(!cable.axial_stiffness || *cable.axial_stiffness > 0, "an axial stiffness is positive");
  check(paid_out.length.has_value() != paid_out.winch_tension.has_value(),
        "either the length or the winch's tension is given");
  check(paid_out.length.value_or(1) > 0, "a cable has a length");
  check(paid_out.winch_tension.value_or(1) > 0, "a winch that decides the length pulls");
  check(norm(drone) > 0, "the drone is not at the station");
  check(air.profile != WindProfile::logarithmic || air.roughness_length > 0,
        "a logarithmic wind profile has a roughness length");
  check(air.profile == WindProfile::uniform || air.reference_height > 0,
        "a wind profile has a reference height above ground");
}

}  // namespace

CableOutcome CableSolver::solve(const Cable& cable, const MovingAir& moving,
                                const PaidOut& paid_out, const Vector3& drone) {
  check(cable, moving, paid_out, drone);
  MovingAir air = moving;
  if (is_still(air)) {
    air.wind = air.even_share * air.wind;
    air.profile = WindProfile::uniform;
  }
  const Problem before = last_ ? problem() : Problem();
  const bool alike = last_ && paid_out.length.has_value() == paid_out_.length.has_value() &&
                     air.profile == air_.profile &&
                     (air.drone_velocity == Vector3{}) == (air_.drone_velocity == Vector3{});
  const bool only_the_drone_moved = cable == cable_ && air == air_ && paid_out == paid_out_;
  cable_ = cable;
  air_ = air;
  paid_out_ = paid_out;
  drone_ = drone;
  still_.reset();
  if (!alike) planar_ends_.reset();
  if (!alike || !can_go_on_) last_.reset();
  can_go_on_ = true;
  Problem p = problem();
  int steps_left = most_steps_;
  p.steps_left = &steps_left;
  const bool loaded = p.newton > 0;
  if (!loaded || (paid_out.length && !cable.axial_stiffness && !(*paid_out.length > norm(drone)))) {
    last_.reset();
    return loaded ? CableOutcome::too_short : CableOutcome::not_found;
  }
  const bool in_still_air =
      p.drag * (dot(air.wind, air.wind) + dot(air.drone_velocity, air.drone_velocity)) == 0;
  if (in_still_air && paid_out.length) {
    last_.reset();
    still_ = catenary(std::hypot(drone.x, drone.y), drone.z, *paid_out.length, cable.weight,
                      cable.axial_stiffness);
    return still_ ? CableOutcome::hangs : CableOutcome::not_found;
  }
  if (const auto known = in_a_plane<Last>(p, in_still_air, planar_ends_)) {
    const auto& [hangs, in_plane] = *known;
    last_ = hangs ? std::optional(in_plane) : std::nullopt;
    can_go_on_ = false;
    return hangs ? CableOutcome::hangs : CableOutcome::tension_too_low;
  }
  if (last_) {
    last_ = in_units_of(p, before, *last_);
    std::optional<Unknowns> miss;
    if (only_the_drone_moved) {
      miss = equations({}, (before.metre / p.metre) * before.drone - p.drone, 0);
    }
    last_ = refined(p, *last_, miss);
  }
  CableOutcome why_not = CableOutcome::not_found;
  if (!last_ && p.winch) last_ = held_by_winch<Last>(p, why_not);
  if (!last_ && !p.winch) last_ = anew<Last>(p);
  return last_ ? CableOutcome::hangs : why_not;
}

Vector3 CableSolver::ahead() const {
  const double distance = std::hypot(drone_.x, drone_.y);
  return distance > 0 ? Vector3{drone_.x / distance, drone_.y / distance, 0} : Vector3{1, 0, 0};
}

HangingCable CableSolver::result() const {
  if (still_) {
    const Vector3 level = still_->horizontal * ahead();
    return {*paid_out_.length, Vector3{-level.x, -level.y, -still_->vertical_at_end},
            Vector3{level.x, level.y, still_->vertical_at_start},
            std::hypot(still_->horizontal, still_->vertical_at_end),
            std::hypot(still_->horizontal, still_->vertical_at_start)};
  }
  const Problem p = problem();
  const Last::Ends& ends = last_->ends;
  return {ends.length * p.metre, -p.newton * ends.at_drone, p.newton * ends.at_station,
          p.newton * norm(ends.at_drone), p.newton * norm(ends.at_station)};
}

namespace {

/// Where the cable is, at the lengths `at` from the start (all on one side of it, in order).
template <class Problem>
void follow_by_length(const Problem& problem, Point from, const std::vector<double>& at,
                      std::vector<Point>& out) {
  State<0> state;
  put(state.data(), from);
  for (const double target : at) {
    const double way = target - point_at(state.data()).length;
    const double sign = way < 0 ? -1 : 1;
    const auto system = [&problem, sign](const State<0>& s, State<0>& change) {
      const Point p = point_at(s.data());
      put(change.data(), (sign / p.tension) * problem.change(p, problem.wind_at(p)));
    };
    const auto longest_step = [&](const State<0>& s) {
      const Point p = point_at(s.data());
      return p.tension * std::min(fine.step, problem.step_before_corner(p, sign, fine));
    };
    integrate(system, state, std::abs(way), longest_step);
    out.push_back(point_at(state.data()));
  }
}

CableShape with_extremes(std::vector<CablePoint> points) {
  CableShape shape{std::move(points), {}, {}, {}};
  const auto by = [&shape](const auto& value) {
    return *std::min_element(
        shape.points.begin(), shape.points.end(),
        [&value](const CablePoint& a, const CablePoint& b) { return value(a) < value(b); });
  };
  shape.lowest = by([](const CablePoint& p) { return p.position.z; });
  shape.slackest = by([](const CablePoint& p) { return p.tension; });
  shape.tautest = by([](const CablePoint& p) { return -p.tension; });
  return shape;
}

}  // namespace

CableShape CableSolver::catenary_shape(int pieces) const {
  const Vector3 direction = ahead();
  const double length = *paid_out_.length;
  const auto point = [&](double s) {
    const CatenaryPoint at = catenary_point(*still_, s, cable_.weight, cable_.axial_stiffness);
    return CablePoint{s, {at.x * direction.x, at.x * direction.y, at.z}, at.tension};
  };
  std::vector<CablePoint> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(point(length * k / pieces));
  CableShape shape = with_extremes(std::move(points));
  const double bottom = -still_->vertical_at_start / cable_.weight;
  if (bottom > 0 && bottom < length) shape.lowest = shape.slackest = point(bottom);
  return shape;
}

CableShape CableSolver::shape(int pieces) const {
  check(pieces >= 1, "a shape has at least one piece");
  if (still_) return catenary_shape(pieces);
  const Problem p = problem();
  const auto ends = ends_of<0>(p, *last_, fine);
  const Point station = point_at(ends->station.data());
  std::vector<double> before;
  std::vector<double> after;
  for (int k = 0; k <= pieces; ++k) {
    const double s = last_->ends.length * k / pieces + station.length;
    (s < 0 ? before : after).push_back(s);
  }
  std::reverse(before.begin(), before.end());
  const Point place{last_->direction, last_->tension, last_->position, 0};
  std::vector<Point> found;
  follow_by_length(p, place, before, found);
  std::reverse(found.begin(), found.end());
  follow_by_length(p, place, after, found);
  std::vector<CablePoint> points;
  for (int k = 0; k <= pieces; ++k) {
    const Point& at = found[static_cast<std::size_t>(k)];
    points.push_back({last_->ends.length * p.metre * k / pieces,
                      p.metre * (at.position - station.position), at.tension * p.newton});
  }
  return with_extremes(std::move(points));
}

CableSolver::Derivatives CableSolver::catenary_derivatives() const {
  const CatenaryStiffness k =
      catenary_stiffness(*still_, *paid_out_.length, cable_.weight, cable_.axial_stiffness);
  const Vector3 e = ahead();
  const double distance = std::hypot(drone_.x, drone_.y);
  // Across its plane the cable turns with it.
  const double sideways = distance > 0 ? still_->horizontal / distance : k.horizontal_by_x;
  const double xx = k.horizontal_by_x * e.x * e.x + sideways * e.y * e.y;
  const double xy = (k.horizontal_by_x - sideways) * e.x * e.y;
  const double yy = k.horizontal_by_x * e.y * e.y + sideways * e.x * e.x;
  Derivatives out;
  out.by_position = {Vector3{-xx, -xy, -k.horizontal_by_z * e.x},
                     Vector3{-xy, -yy, -k.horizontal_by_z * e.y},
                     Vector3{-k.horizontal_by_z * e.x, -k.horizontal_by_z * e.y, -k.vertical_by_z}};
  return out;  // drag goes with the square of the wind: nothing at first
}

CableSolver::Derivatives CableSolver::derivatives() const {
  if (still_) return catenary_derivatives();
  const Problem p = problem();
  const auto ends = ends_of<columns_of_unknowns + 6>(p, *last_, fine);
  const Point station = point_at(ends->station.data());
  const Point drone = point_at(ends->drone.data());
  const auto at_station = [&](std::size_t k) { return point_at(column_of(ends->station, k)); };
  const auto at_drone = [&](std::size_t k) { return point_at(column_of(ends->drone, k)); };
  const auto by = by_each_unknown(p, *ends, *last_);
  const Square inverse = changes_of_miss(p, station, by).inverse();
  const auto force = [&](std::size_t column, const Vector3& moved) {
    const Unknowns change =
        change_of_miss(p, station, at_station(column), at_drone(column)) - equations({}, moved, 0);
    const Unknowns unknowns = -(inverse * change);
    Vector3 sum = change_of_pull(drone, at_drone(column));
    for (std::size_t k = 0; k < unknown_count; ++k) {
      sum = sum + unknowns(static_cast<Eigen::Index>(k)) * change_of_pull(drone, by[k].drone);
    }
    return -p.newton * sum;
  };
  Derivatives out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.by_wind[axis] = force(unknown_count + axis, {});
    out.by_position[axis] = (1 / p.metre) * force(unknown_count + 3 + axis, axis_direction(axis));
  }
  return out;
}

}  // namespace tethercalc
