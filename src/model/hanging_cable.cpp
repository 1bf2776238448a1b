// Notation: t direction of the cable, T tension, r position, s length without tension; lengths in
// units of the cable's (or, where the winch decides it, of the distance), forces in units of the
// load on that length; σ with ds = T·dσ.
#include "tethercalc/model/hanging_cable.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/cable_newton.hpp"
#include "model/cable_start.hpp"
#include "model/runge_kutta.hpp"
#include "model/vector3.hpp"
#include "model/wind_profile.hpp"
#include "tethercalc/model/catenary.hpp"

namespace tethercalc {

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
  using Point = hanging::Point;

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
                                          const hanging::Accuracy& accuracy) const {
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
  if (const auto known = hanging::in_a_plane<Last>(p, in_still_air, planar_ends_)) {
    const auto& [hangs, in_plane] = *known;
    last_ = hangs ? std::optional(in_plane) : std::nullopt;
    can_go_on_ = false;
    return hangs ? CableOutcome::hangs : CableOutcome::tension_too_low;
  }
  if (last_) {
    last_ = in_units_of(p, before, *last_);
    std::optional<hanging::Unknowns> miss;
    if (only_the_drone_moved) {
      miss = hanging::equations({}, (before.metre / p.metre) * before.drone - p.drone, 0);
    }
    last_ = hanging::refined(p, *last_, miss);
  }
  CableOutcome why_not = CableOutcome::not_found;
  if (!last_ && p.winch) last_ = hanging::held_by_winch<Last>(p, why_not);
  if (!last_ && !p.winch) last_ = hanging::anew<Last>(p);
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
void follow_by_length(const Problem& problem, hanging::Point from, const std::vector<double>& at,
                      std::vector<hanging::Point>& out) {
  hanging::State<0> state;
  hanging::put(state.data(), from);
  for (const double target : at) {
    const double way = target - hanging::point_at(state.data()).length;
    const double sign = way < 0 ? -1 : 1;
    const auto system = [&problem, sign](const hanging::State<0>& s, hanging::State<0>& change) {
      const hanging::Point p = hanging::point_at(s.data());
      hanging::put(change.data(), (sign / p.tension) * problem.change(p, problem.wind_at(p)));
    };
    const auto longest_step = [&](const hanging::State<0>& s) {
      const hanging::Point p = hanging::point_at(s.data());
      return p.tension *
             std::min(hanging::fine.step, problem.step_before_corner(p, sign, hanging::fine));
    };
    runge_kutta::integrate(system, state, std::abs(way), longest_step);
    out.push_back(hanging::point_at(state.data()));
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
  const auto ends = hanging::ends_of<0>(p, *last_, hanging::fine);
  const hanging::Point station = hanging::point_at(ends->station.data());
  std::vector<double> before;
  std::vector<double> after;
  for (int k = 0; k <= pieces; ++k) {
    const double s = last_->ends.length * k / pieces + station.length;
    (s < 0 ? before : after).push_back(s);
  }
  std::reverse(before.begin(), before.end());
  const hanging::Point place{last_->direction, last_->tension, last_->position, 0};
  std::vector<hanging::Point> found;
  follow_by_length(p, place, before, found);
  std::reverse(found.begin(), found.end());
  follow_by_length(p, place, after, found);
  std::vector<CablePoint> points;
  for (int k = 0; k <= pieces; ++k) {
    const hanging::Point& at = found[static_cast<std::size_t>(k)];
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
  const auto ends = hanging::ends_of<hanging::columns_of_unknowns + 6>(p, *last_, hanging::fine);
  const hanging::Point station = hanging::point_at(ends->station.data());
  const hanging::Point drone = hanging::point_at(ends->drone.data());
  const auto at_station = [&](std::size_t k) {
    return hanging::point_at(hanging::column_of(ends->station, k));
  };
  const auto at_drone = [&](std::size_t k) {
    return hanging::point_at(hanging::column_of(ends->drone, k));
  };
  const auto by = hanging::by_each_unknown(p, *ends, *last_);
  const hanging::Square inverse = hanging::changes_of_miss(p, station, by).inverse();
  const auto force = [&](std::size_t column, const Vector3& moved) {
    const hanging::Unknowns change =
        hanging::change_of_miss(p, station, at_station(column), at_drone(column)) -
        hanging::equations({}, moved, 0);
    const hanging::Unknowns unknowns = -(inverse * change);
    Vector3 sum = hanging::change_of_pull(drone, at_drone(column));
    for (std::size_t k = 0; k < hanging::unknown_count; ++k) {
      sum = sum +
            unknowns(static_cast<Eigen::Index>(k)) * hanging::change_of_pull(drone, by[k].drone);
    }
    return -p.newton * sum;
  };
  Derivatives out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.by_wind[axis] = force(hanging::unknown_count + axis, {});
    out.by_position[axis] =
        (1 / p.metre) * force(hanging::unknown_count + 3 + axis, axis_direction(axis));
  }
  return out;
}

}  // namespace tethercalc
