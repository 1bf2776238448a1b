#include "tethercalc/model/hanging_cable.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "support/lumped_cable.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"

using namespace tethercalc;
using test::each_random;
using test::Random;

namespace {

double length_of(const Vector3& v) { return std::hypot(v.x, v.y, v.z); }

Vector3 vector_of(const nlohmann::json& list) { return {list[0], list[1], list[2]}; }

void check_close(const Vector3& found, const Vector3& expected, double margin) {
  CHECK(found.x == Approx(expected.x).margin(margin));
  CHECK(found.y == Approx(expected.y).margin(margin));
  CHECK(found.z == Approx(expected.z).margin(margin));
}

/// Drag coefficient of a smooth cylinder: points of measurements (Wieselsberger 1921, and Tritton
/// 1959 below 100, as read from the usual log-log plot), joined by straight lines in it.
double measured_cylinder_drag(double reynolds) {
  constexpr std::array<std::array<double, 2>, 10> points{{{1, 10.5},
                                                          {3, 5.0},
                                                          {10, 2.8},
                                                          {30, 1.9},
                                                          {100, 1.4},
                                                          {300, 1.2},
                                                          {1000, 1.0},
                                                          {3000, 0.95},
                                                          {10000, 1.1},
                                                          {100000, 1.2}}};
  if (reynolds <= points.front()[0]) return points.front()[1];
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [re_0, c_0] = points[i - 1];
    const auto& [re_1, c_1] = points[i];
    if (reynolds > re_1) continue;
    return c_0 * std::pow(c_1 / c_0, std::log(reynolds / re_0) / std::log(re_1 / re_0));
  }
  return points.back()[1];
}

PaidOut of_length(double length) { return {.length = length, .winch_tension = {}}; }

/// A cable, its air and its drone, drawn over what tethers of drones may be.
struct Drawn {
  Cable cable;
  MovingAir air;
  Vector3 drone;
  PaidOut paid_out;

  [[nodiscard]] double distance() const { return length_of(drone); }
};

Drawn drawn(Random& random) {
  Drawn d;
  d.cable = {.weight = random.uniform(0.02, 0.5),
             .diameter = random.uniform(0.002, 0.01),
             .drag_coefficient = random.uniform(0.7, 1.3)};
  if (random.chance(0.3)) d.cable.cylinder_diameter = random.uniform(0.5, 1) * d.cable.diameter;
  d.air.wind = {random.uniform(-15, 15), random.uniform(-15, 15), random.uniform(-2, 2)};
  d.drone = {random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(5, 100)};
  d.paid_out = of_length(d.distance() * (1 + random.magnitude(1e-3, 0.5)));
  return d;
}

/// A drone aside, in the wind under which the load of the cable lies about along its chord: nearly
/// a fold, which opens to the one side or the other.
Drawn drawn_about_balance(Random& random) {
  Drawn d = drawn(random);
  d.cable.cylinder_diameter.reset();
  const double height = random.uniform(5, 150);
  const double aside = height * random.magnitude(0.01, 1.5);
  d.drone = {aside, 0, height};
  const double by_speed_squared = drag_across(d.cable, d.air, 1);
  const double balanced =
      std::sqrt(d.cable.weight * aside * d.distance() / by_speed_squared) / height;
  d.air.wind = {-balanced * random.magnitude(0.7, 1.4), 0, 0};
  if (random.chance(0.5)) {
    d.air.profile = random.chance(0.5) ? WindProfile::power_law : WindProfile::logarithmic;
    d.air.reference_height = random.chance(0.5) ? height : 10;
  }
  if (random.chance(0.2)) d.cable.axial_stiffness = random.magnitude(1e3, 1e6);
  d.paid_out = of_length(d.distance() * (1 + random.magnitude(2e-3, 0.2)));
  return d;
}

/// That what pulls at both ends is what weight and wind put on the cable between them, and that it
/// ends at the drone. The sum's own error: pieces of 1/3000 of the length, near the ground across
/// the profile's corner.
void check_balance(const CableSolver& solver, const Drawn& d) {
  const CableShape shape = solver.shape(3000);
  const HangingCable found = solver.result();
  Vector3 load{0, 0, -d.cable.weight * found.length};
  for (std::size_t i = 0; i + 1 < shape.points.size(); ++i) {
    const CablePoint& a = shape.points[i];
    const CablePoint& b = shape.points[i + 1];
    const Vector3 way{b.position.x - a.position.x, b.position.y - a.position.y,
                      b.position.z - a.position.z};
    const double distance = length_of(way);
    const double share = wind_share(d.air, 0.5 * (a.position.z + b.position.z));
    const Vector3 wind{share * d.air.wind.x, share * d.air.wind.y, share * d.air.wind.z};
    const double along = (wind.x * way.x + wind.y * way.y + wind.z * way.z) / distance;
    const Vector3 across{wind.x - along * way.x / distance, wind.y - along * way.y / distance,
                         wind.z - along * way.z / distance};
    const double speed = length_of(across);
    const double pressed = speed > 0 ? drag_across(d.cable, d.air, speed) / speed * (b.s - a.s) : 0;
    load = {load.x + pressed * across.x, load.y + pressed * across.y, load.z + pressed * across.z};
  }
  const double greatest = std::max(found.tension_at_drone, found.tension_at_station);
  check_close({found.on_drone.x + found.on_station.x, found.on_drone.y + found.on_station.y,
               found.on_drone.z + found.on_station.z},
              load, 1e-4 * greatest);
  check_close(shape.points.back().position, d.drone, 1e-6 * found.length);
}

}  // namespace

TEST_CASE("exact cables in wind come out to 1e-8 of the greatest force") {
  const auto file = test::reference_json("data/shape/drag.json");
  if (!file) return;
  for (const auto& c : file->at("cases")) {
    INFO(c["id"]);
    const auto& in = c["input"];
    const auto& expected = c["expect"];
    Cable cable{
        .weight = in["w_N_per_m"], .diameter = in["diameter_m"], .drag_coefficient = in["Cd"]};
    if (!in["EA_N"].is_null()) cable.axial_stiffness = in["EA_N"].get<double>();
    MovingAir air;
    air.density = in["rho_kg_m3"];
    air.wind = vector_of(in["wind_m_s"]);
    const double length = in["L_m"];
    CableSolver solver;
    REQUIRE(solver.solve(cable, air, of_length(length), vector_of(in["drone_m"])) ==
            CableOutcome::hangs);
    const HangingCable found = solver.result();
    const double greatest =
        std::max(expected["T_drone_N"].get<double>(), expected["T_anchor_N"].get<double>());
    check_close(found.on_drone, vector_of(expected["F_on_drone_N"]), 1e-8 * greatest);
    check_close(found.on_station, vector_of(expected["F_on_anchor_N"]), 1e-8 * greatest);
    const CableShape shape = solver.shape(4000);
    CHECK(shape.slackest.tension ==
          Approx(expected["T_min_N"].get<double>()).margin(1e-8 * greatest));
    CHECK(std::min(shape.lowest.position.z, 0.0) ==
          Approx(expected["z_low_m"].get<double>()).margin(1e-7 * length));
    for (std::size_t k = 0; k < 11; ++k) {
      const auto& station = expected["stations"][k];
      const CablePoint& at = shape.points[400 * k];
      check_close(at.position, {station[1], station[2], station[3]}, 1e-7 * length);
      CHECK(at.tension == Approx(station[4].get<double>()).margin(1e-8 * greatest));
    }
  }
}

TEST_CASE("a cable in even wind gains its weight times the height in tension, whatever the wind") {
  each_random(60, [](Random& random) {
    const Drawn d = drawn(random);
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const HangingCable found = solver.result();
    const double greatest = std::max(found.tension_at_drone, found.tension_at_station);
    CHECK(found.tension_at_drone - found.tension_at_station ==
          Approx(d.cable.weight * d.drone.z).margin(1e-8 * greatest));
    CHECK(length_of(found.on_drone) == Approx(found.tension_at_drone).epsilon(1e-9));
  });
}

TEST_CASE("what pulls at both ends is what weight and wind put on the cable between them") {
  each_random(20, [](Random& random) {
    Drawn d = drawn(random);
    d.air.profile = random.chance(0.5) ? WindProfile::power_law : WindProfile::logarithmic;
    d.air.station_height = random.uniform(0, 3);
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    check_balance(solver, d);
  });
}

TEST_CASE("where wind and weight about balance on a cable to a drone aside, it has a shape") {
  each_random(test::draws(100), [](Random& random) {
    const Drawn d = drawn_about_balance(random);
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    check_balance(solver, d);
    // With this tension at the station there is a cable, too, and none that is longer.
    const HangingCable found = solver.result();
    CableSolver by_tension;
    REQUIRE(by_tension.solve(d.cable, d.air,
                             {.length = {}, .winch_tension = found.tension_at_station},
                             d.drone) == CableOutcome::hangs);
    check_balance(by_tension, d);
    CHECK(by_tension.result().length <= found.length * (1 + 1e-6));
  });
}

TEST_CASE("masses on springs come to rest with the solver's forces") {
  // 40 pieces leave about 1/40² of a bent cable's forces; its swinging dies out within 60 of its
  // times.
  each_random(test::draws(20), [](Random& random) {
    Drawn d = drawn(random);
    d.air.wind.z = 0;
    d.drone = {random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(10, 60)};
    const double length = d.distance() * (1 + random.uniform(0.02, 0.3));
    d.paid_out = of_length(length);
    d.cable.axial_stiffness = 300 * d.cable.weight * length;
    d.air.profile = random.chance(0.5) ? WindProfile::power_law : WindProfile::logarithmic;
    const MovingAir profiled = d.air;
    if (random.chance(0.3)) d.air.even_share = random.uniform(0, 1.5);
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const auto settled = test::settled_force_on_end(
        {.length = length,
         .weight = d.cable.weight,
         .stiffness = *d.cable.axial_stiffness,
         .drag_width = 0.5 * d.air.density * d.cable.drag_coefficient * d.cable.diameter,
         .coefficient =
             [&](double speed) {
               return d.cable.cylinder_diameter ? cylinder_drag(speed * *d.cable.cylinder_diameter *
                                                                d.air.density / 1.81e-5)
                                                      .coefficient
                                                : 1;
             },
         .end = {d.drone.x, d.drone.y, d.drone.z},
         .wind = [&](double height) -> std::array<double, 3> {
           const double even = d.air.even_share;
           const double share = even + (1 - even) * wind_share(profiled, height);
           return {share * d.air.wind.x, share * d.air.wind.y, 0.0};
         }});
    const HangingCable found = solver.result();
    const double greatest = std::max(found.tension_at_drone, found.tension_at_station);
    check_close(found.on_drone, {settled[0], settled[1], settled[2]}, 0.01 * greatest);
  });
}

TEST_CASE("a cylinder's drag is as measured, and its slope that of differences") {
  for (const double reynolds : {1.0, 10.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0, 100000.0}) {
    INFO(reynolds);
    const CylinderDrag drag = cylinder_drag(reynolds);
    // Measurements scatter by 5 %, the plot was read to as much.
    CHECK(drag.coefficient == Approx(measured_cylinder_drag(reynolds)).epsilon(0.1));
    const double step = 1e-5 * reynolds;
    const double above = cylinder_drag(1.5 * reynolds + step).coefficient;
    const double below = cylinder_drag(1.5 * reynolds - step).coefficient;
    CHECK(cylinder_drag(1.5 * reynolds).slope ==
          Approx((above - below) / (2 * step)).epsilon(1e-4).margin(1e-12));
  }
  CHECK(cylinder_drag(0).coefficient == cylinder_drag(1).coefficient);
  CHECK(cylinder_drag(0.5).slope == 0);
}

TEST_CASE("mirrored air mirrors the forces") {
  each_random(20, [](Random& random) {
    Drawn d = drawn(random);
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const Vector3 force = solver.result().on_drone;
    d.air.wind.y = -d.air.wind.y;
    d.drone.y = -d.drone.y;
    CableSolver mirrored;
    REQUIRE(mirrored.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    check_close(mirrored.result().on_drone, {force.x, -force.y, force.z}, 1e-8 * length_of(force));
  });
}

TEST_CASE("in next to no wind a cable is the catenary, above the station a fold") {
  each_random(30, [](Random& random) {
    Drawn d = drawn(random);
    d.air.wind = {};
    CableSolver still;
    REQUIRE(still.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    d.air.wind = {1e-4, 0, 0};
    CableSolver breeze;
    REQUIRE(breeze.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const Vector3 force = still.result().on_drone;
    check_close(breeze.result().on_drone, force, 1e-6 * length_of(force));
  });
  CableSolver above;
  REQUIRE(above.solve({.weight = 0.2}, {}, of_length(32), {0, 0, 30}) == CableOutcome::hangs);
  // One metre hangs down each way from the middle of what is to spare: 31 m of 32 on the drone.
  check_close(above.result().on_drone, {0, 0, -6.2}, 1e-12);
  CHECK(above.result().tension_at_station == Approx(0.2));
  CHECK(above.shape(64).lowest.position.z == Approx(-1));
}

TEST_CASE("a weightless cable across the wind is a bow whose pull its sag decides") {
  // A parabola-like arc: with even load q across a chord D and slack e, the tension is
  // q·D/√(24·e) for small e.
  const double slack = 1e-4;
  CableSolver solver;
  MovingAir air;
  air.wind = {0, 10, 0};
  const Cable cable{.weight = 0, .diameter = 0.005, .drag_coefficient = 1.1};
  REQUIRE(solver.solve(cable, air, of_length(50 * (1 + slack)), {30, 0, 40}) ==
          CableOutcome::hangs);
  const double load = 0.5 * 1.225 * 1.1 * 0.005 * 100;
  CHECK(solver.result().tension_at_drone ==
        Approx(load * 50 / std::sqrt(24 * slack)).epsilon(1e-3));
}

TEST_CASE("a winch's tension and the length it pays out are one answer") {
  each_random(60, [](Random& random) {
    Drawn d = drawn(random);
    d.paid_out = of_length(d.distance() * (1 + random.magnitude(1e-3, 0.02)));
    if (random.chance(0.3)) d.air.profile = WindProfile::logarithmic;
    CableSolver by_length;
    REQUIRE(by_length.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const double tension = by_length.result().tension_at_station;
    CableSolver by_tension;
    const CableOutcome outcome =
        by_tension.solve(d.cable, d.air, {.length = {}, .winch_tension = tension}, d.drone);
    REQUIRE(outcome == CableOutcome::hangs);
    // Two lengths may have one tension; the winch takes the shorter.
    CHECK(by_tension.result().length <= *d.paid_out.length * (1 + 1e-6));
    CHECK(by_tension.result().tension_at_station == Approx(tension).epsilon(1e-8));
  });
}

TEST_CASE("a winch is called too weak only where no length that it pays out has its tension") {
  each_random(test::draws(60), [](Random& random) {
    Drawn d = drawn(random);
    d.cable.axial_stiffness.reset();
    if (random.chance(0.3)) d.air.profile = WindProfile::logarithmic;
    if (random.chance(0.5)) {  // in one plane with its wind
      d.cable.cylinder_diameter.reset();
      d.air.profile = WindProfile::uniform;
      d.air.wind.y = d.air.wind.z = d.drone.y = 0;
    }
    // From taut on, until the tension falls no more.
    CableSolver by_length;
    double least = std::numeric_limits<double>::infinity();
    for (double slack = 1e-4; slack < 3; slack *= 1.1) {
      REQUIRE(by_length.solve(d.cable, d.air, of_length(d.distance() * (1 + slack)), d.drone) ==
              CableOutcome::hangs);
      const double tension = by_length.result().tension_at_station;
      if (tension > least) break;
      least = tension;
    }
    const double share = random.magnitude(0.3, 3);
    CableSolver by_tension;
    const CableOutcome outcome =
        by_tension.solve(d.cable, d.air, {.length = {}, .winch_tension = share * least}, d.drone);
    if (share >= 1) REQUIRE(outcome == CableOutcome::hangs);
    if (outcome == CableOutcome::hangs) {
      CHECK(by_tension.result().tension_at_station == Approx(share * least).epsilon(1e-8));
    } else {
      CHECK(outcome == CableOutcome::tension_too_low);
    }
  });
}

TEST_CASE("the derivatives of the force are those of differences") {
  each_random(30, [](Random& random) {
    Drawn d = drawn(random);
    d.paid_out = of_length(d.distance() * (1 + random.uniform(0.02, 0.3)));
    if (random.chance(0.5)) d.air.drone_velocity = {random.uniform(-8, 8), 0, 0};
    if (random.chance(0.5)) d.air.profile = WindProfile::power_law;
    CableSolver solver;
    REQUIRE(solver.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
    const double force = length_of(solver.result().on_drone);
    const auto derivatives = solver.derivatives();
    const auto check = [&](const Vector3& found, const Drawn& more, const Drawn& less,
                           double step) {
      CableSolver one;
      CableSolver other;
      REQUIRE(one.solve(more.cable, more.air, more.paid_out, more.drone) == CableOutcome::hangs);
      REQUIRE(other.solve(less.cable, less.air, less.paid_out, less.drone) == CableOutcome::hangs);
      const Vector3 a = one.result().on_drone;
      const Vector3 b = other.result().on_drone;
      const Vector3 slope{(a.x - b.x) / (2 * step), (a.y - b.y) / (2 * step),
                          (a.z - b.z) / (2 * step)};
      // Error of a central difference, and 1e-9 of the force over the step.
      check_close(found, slope, 2e-3 * length_of(slope) + 1e-8 * force / step);
    };
    double Vector3::*const axes[] = {&Vector3::x, &Vector3::y, &Vector3::z};
    for (std::size_t k = 0; k < 3; ++k) {
      Drawn more = d;
      Drawn less = d;
      const double step = 1e-4 * d.distance();
      more.drone.*axes[k] += step;
      less.drone.*axes[k] -= step;
      check(derivatives.by_position[k], more, less, step);
      more = less = d;
      more.air.wind.*axes[k] += 1e-3;
      less.air.wind.*axes[k] -= 1e-3;
      check(derivatives.by_wind[k], more, less, 1e-3);
    }
  });
}

TEST_CASE("a solver that goes on from its last cable answers as a fresh one") {
  each_random(20, [](Random& random) {
    Drawn d = drawn(random);
    CableSolver going_on;
    for (int i = 0; i < 10; ++i) {
      d.drone.x += random.uniform(-0.2, 0.2);
      d.air.wind.y += random.uniform(-0.5, 0.5);
      d.paid_out = of_length(1.05 * d.distance());
      CableSolver fresh;
      REQUIRE(fresh.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
      REQUIRE(going_on.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
      const Vector3 force = fresh.result().on_drone;
      check_close(going_on.result().on_drone, force, 1e-8 * length_of(force));
    }
  });
}

TEST_CASE(
    "whether a winch's cable lies in a plane or not, a solver goes on from it as a fresh one") {
  each_random(20, [](Random& random) {
    Drawn d = drawn(random);
    d.cable.cylinder_diameter.reset();
    CableSolver going_on;
    for (int i = 0; i < 10; ++i) {
      const double wind = random.uniform(-8, 8);
      d.drone = {random.uniform(1, 20), 0, random.uniform(20, 60)};
      d.air.wind = {wind, random.chance(0.5) ? 0 : random.uniform(-5, 5), 0};
      d.paid_out = random.chance(0.3) ? of_length(1.05 * d.distance())
                                      : PaidOut{.length = {}, .winch_tension = 60};
      CableSolver fresh;
      REQUIRE(fresh.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
      REQUIRE(going_on.solve(d.cable, d.air, d.paid_out, d.drone) == CableOutcome::hangs);
      const Vector3 force = fresh.result().on_drone;
      check_close(going_on.result().on_drone, force, 1e-8 * length_of(force));
      const CableShape shape = going_on.shape(20);
      check_close(shape.points.back().position, d.drone, 1e-6 * d.distance());
      CHECK(shape.points.back().tension == Approx(length_of(force)).epsilon(1e-6));

      Vector3 up = d.drone;
      up.z += 1e-3;
      const Vector3 slope = going_on.derivatives().by_position[2];
      REQUIRE(fresh.solve(d.cable, d.air, d.paid_out, up) == CableOutcome::hangs);
      const Vector3 there = fresh.result().on_drone;
      check_close({there.x - force.x, there.y - force.y, there.z - force.z},
                  {1e-3 * slope.x, 1e-3 * slope.y, 1e-3 * slope.z},
                  1e-2 * 1e-3 * length_of(slope) + 1e-8 * length_of(force));
    }
  });
}

TEST_CASE("a shape is followed wherever a solver says that the cable hangs, however light it is") {
  Cable cable{.weight = 1, .diameter = 0.004, .drag_coefficient = 1};
  MovingAir air;
  air.wind = {-20, 0, 0};
  const double drag = drag_across(cable, air, 20);
  cable.weight = 0.011 * drag;
  const double balanced = 2 * drag / (cable.weight + std::hypot(cable.weight, 2 * drag));
  const double height = 50 * std::sqrt(1 - balanced * balanced);
  const double tension = 0.1 * cable.weight * height;
  CableSolver solver;
  const CableOutcome outcome = solver.solve(cable, air, {.length = {}, .winch_tension = tension},
                                            {50 * balanced, 0, height});
  if (outcome == CableOutcome::hangs) CHECK(solver.shape(4).points.size() == 5);
  CHECK(outcome != CableOutcome::too_short);
}

TEST_CASE("every cable hangs to its drone or has a name for why not") {
  const int count = test::draws(400);
  int not_found = 0;
  each_random(count, [&not_found](Random& random) {
    Drawn d = drawn(random);
    if (random.chance(0.3)) d.cable.axial_stiffness = random.magnitude(1e3, 1e6);
    d.air.profile = static_cast<WindProfile>(random.integer(0, 2));
    if (random.chance(0.2)) d.air.drone_velocity = {random.uniform(-10, 10), 3, 0};
    if (random.chance(0.2)) d.air.wind = {};
    if (random.chance(0.2)) d.drone.x = d.drone.y = 0;
    d.paid_out = of_length(d.distance() * (1 + random.magnitude(1e-4, 0.5)));
    if (random.chance(0.3)) {
      d.paid_out = {.length = {}, .winch_tension = random.magnitude(0.5, 60)};
    }
    CableSolver solver;
    const CableOutcome outcome = solver.solve(d.cable, d.air, d.paid_out, d.drone);
    if (outcome == CableOutcome::tension_too_low) {
      CHECK(d.paid_out.winch_tension);
      return;
    }
    not_found += outcome == CableOutcome::not_found ? 1 : 0;
    if (outcome == CableOutcome::not_found) return;
    REQUIRE(outcome == CableOutcome::hangs);
    const CableShape shape = solver.shape(50);
    check_close(shape.points.back().position, d.drone, 1e-6 * solver.result().length);
  });
  // Seen: none in 3000; folds that the wind of a moving drone nearly holds up may be.
  CHECK(not_found <= 1 + count / 200);
  CableSolver solver;
  CHECK(solver.solve({.weight = 1}, {}, of_length(5), {3, 0, 4}) == CableOutcome::too_short);
  CHECK(solver.solve({.weight = 1}, {}, {.length = {}, .winch_tension = 0.1}, {30, 0, 4}) ==
        CableOutcome::tension_too_low);
}

TEST_CASE("what is no cable is refused") {
  CableSolver solver;
  const Vector3 up{0, 0, 10};
  CHECK_THROWS_AS(solver.solve({.weight = -1}, {}, of_length(11), up), std::invalid_argument);
  CHECK_THROWS_AS(solver.solve({.weight = 1}, {}, {}, up), std::invalid_argument);
  CHECK_THROWS_AS(solver.solve({.weight = 1}, {}, of_length(0), up), std::invalid_argument);
  CHECK_THROWS_AS(solver.solve({.weight = 1}, {}, of_length(11), {}), std::invalid_argument);
  MovingAir air;
  air.profile = WindProfile::logarithmic;
  air.roughness_length = 0;
  CHECK_THROWS_AS(solver.solve({.weight = 1}, air, of_length(11), up), std::invalid_argument);
}

TEST_CASE("a wind that is known below the roughness length moves nothing") {
  MovingAir air;
  air.profile = WindProfile::logarithmic;
  air.wind = {-8, 0, 0};
  air.roughness_length = 0.5;
  const Cable cable{.weight = 0.3, .diameter = 4e-3};
  for (const double reference : {0.1, 0.5}) {
    air.reference_height = reference;
    CHECK(wind_share(air, reference) == 0);
    CableSolver solver;
    CableSolver in_still_air;
    const Vector3 drone{0.1, 0, reference};
    REQUIRE(solver.solve(cable, air, of_length(0.8), drone) == CableOutcome::hangs);
    REQUIRE(in_still_air.solve(cable, {}, of_length(0.8), drone) == CableOutcome::hangs);
    CHECK(solver.result().on_drone == in_still_air.result().on_drone);
    CHECK(solver.result().tension_at_station == in_still_air.result().tension_at_station);
  }
}
