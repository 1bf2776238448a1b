#include "tethercalc/study/cable_shape.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_designs.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/model/tether.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/study/envelope.hpp"
#include "tethercalc/study/optimum.hpp"
#include "tethercalc/study/sweep.hpp"

using namespace tethercalc;

namespace {

constexpr double published_area = 1.0886 * unit::square_millimetre;

ShapeStudy studied(const Design& design, ShapeRequest request, double slack) {
  request.paid_out.length = (1 + slack) * std::hypot(request.height, request.offset);
  return study_cable_shape(design, published_area, request);
}

/// What `shape` is asked for to be in the design's own hover.
ShapeRequest own_hover(const Design& design) {
  const Flight& flight = design.flight;
  return {.height = design.tether.length,
          .offset = flight.horizontal_offset,
          .paid_out = paid_out_to(design.tether, design.tether.length, flight.horizontal_offset),
          .wind = flight.headwind,
          .station_height = flight.station_height,
          .profile = flight.wind_profile,
          .reference_height = flight.wind_reference_height,
          .exponent = flight.wind_exponent,
          .roughness_length = flight.roughness_length,
          .axial_stiffness = design.tether.axial_stiffness};
}

/// Weight that the motors hold beside the cable's pull, N.
double bare_weight(const Design& design) { return design.drone.mass * design.flight.gravity; }

/// Airframe's drag in N at a tilt with this tangent (paper eq. (9) and (10)).
double airframe_drag(const Design& design, double speed, double tangent) {
  const AirframeDrag& drag = design.drone.drag;
  const double tilt = std::atan(std::abs(tangent));
  const double surface = drag.front_area * std::cos(tilt) + drag.top_area * std::sin(tilt);
  return 0.5 * design.flight.air_density * surface * speed * (speed + drag.linear_speed);
}

}  // namespace

TEST_CASE("the drone leans into what pulls it and drags on it") {
  const Design design = test::published_design();
  // From behind the station the wind presses on the drone while the cable holds it back into the
  // wind.
  for (const double from : {0.0, 180 * unit::degree}) {
    for (const double wind : {1.0, 3.0, 9.0}) {
      INFO(from << " rad, " << wind << " m/s");
      const ShapeStudy study =
          studied(design, {.height = 30, .offset = 25, .wind = wind, .wind_from = from}, 0.01);
      REQUIRE(study.outcome == CableOutcome::hangs);
      const LoadedHover& hover = study.solved;
      const double weight = bare_weight(design) + hover.down;
      const double size = std::tan(hover.pitch);
      const double forwards = airframe_drag(design, wind, size) + hover.against;
      CHECK(size * weight == Approx(std::abs(forwards)).epsilon(1e-9));
      CHECK(hover.thrust == Approx(weight / std::cos(hover.pitch) / design.drone.motor_count));
      if (from > 0 && wind < 2) CHECK(hover.against < 0);
    }
  }
}

TEST_CASE("a crosswind across the cable's plane is held by the drone as well") {
  const Design design = test::published_design();
  const ShapeStudy study = studied(
      design, {.height = 30, .offset = 25, .wind = 5, .wind_from = 90 * unit::degree}, 0.05);
  REQUIRE(study.outcome == CableOutcome::hangs);
  const LoadedHover& hover = study.solved;
  // The wind blows to +y, the cable pulls to −x: across the wind.
  CHECK(hover.across == Approx(study.loads.on_drone.x).epsilon(1e-9));
  CHECK(hover.against == Approx(study.loads.on_drone.y).epsilon(1e-9));
  const double weight = bare_weight(design) + hover.down;
  CHECK(std::tan(hover.pitch) * weight > std::hypot(hover.across, hover.against));
}

TEST_CASE("a design's own cable hangs with the load that the design is judged by") {
  Design design = test::published_design();
  CHECK(shapes_in_flight(design, published_area).empty());
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.03;
  design.tether.drag_by_reynolds_number = true;
  design.tether.vibration_amplitude = 0.1;
  design.flight.horizontal_offset = 5;
  design.flight.headwind = 3;
  design.flight.wind_profile = WindProfile::power_law;
  const auto shapes = shapes_in_flight(design, published_area);
  REQUIRE(shapes.size() == 2);
  for (const FlownShape& flown : shapes) {
    const SteadyFlight flight(design, flight_state(design, flown.condition));
    const TetherLoad load = flight.tether().load(conductor_radius(published_area));
    // The load of designs is within 1e-5 of the solver's.
    CHECK(flown.study.loads.on_drone.z == Approx(-load.down).epsilon(2e-5));
    CHECK(flown.study.loads.on_drone.x == Approx(-load.along).epsilon(2e-4));
    CHECK(flown.study.loads.tension_at_station == Approx(load.tension_at_ground).epsilon(2e-5));
    CHECK(flown.study.loads.length == Approx(load.length));
  }
}

TEST_CASE("answers about a cable say where it would hang lowest below its station, if it does") {
  test::each_random(10, [](test::Random& random) {
    Design design = test::published_design();
    design.tether.model = TetherModel::solved;
    design.tether.length = random.uniform(5, 20);
    design.flight.horizontal_offset = random.uniform(0, 4) * design.tether.length;
    design.tether.slack = random.uniform(0.01, 0.4);
    design.flight.headwind = random.uniform(0, 4);
    const double areas[] = {random.magnitude(0.2e-6, 2e-6), random.magnitude(0.2e-6, 2e-6)};
    const EvaluationStudy study = study_evaluation(design, areas);
    double deepest = 0;
    double first = 0;
    for (const double area : areas) {
      for (const FlownShape& flown : shapes_in_flight(design, area)) {
        if (flown.study.outcome != CableOutcome::hangs || flown.study.hangs_free) continue;
        if (first == 0) first = area;
        if (area == first) deepest = std::max(deepest, -flown.study.shape.lowest.position.z);
      }
    }
    REQUIRE(study.ground.has_value() == (first > 0));
    if (!study.ground) return;
    CHECK(study.ground->area == first);
    CHECK(study.ground->below_station == deepest);
  });
}

TEST_CASE("a shape's hover is evaluate's, whatever drum, heat and wind there are") {
  test::each_random(20, [](test::Random& random) {
    Design design = test::published_hanging_design();
    design.tether.slack = random.uniform(0.002, 0.15);
    if (random.chance(0.5)) design.tether.spooled_length = random.uniform(5, 60);
    if (random.chance(0.3)) design.tether.winch_pull = random.uniform(2, 8);
    if (random.chance(0.5)) {
      design.tether.ambient_temperature_C = random.uniform(0, 50);
      design.tether.sun = random.uniform(0, 1000);
    }
    design.flight.headwind = random.uniform(0, 7);
    design.flight.horizontal_offset = random.chance(0.5) ? random.uniform(0, 15) : 0;
    design.flight.wind_profile =
        random.chance(0.5) ? WindProfile::logarithmic : WindProfile::uniform;
    if (random.chance(0.5)) design.flight.wind_reference_height = 10;
    const OperatingPoint hover = evaluate(design, published_area, Condition::hover);
    const ShapeStudy study = study_cable_shape(design, published_area, own_hover(design));
    REQUIRE((study.outcome == CableOutcome::hangs) == std::isfinite(hover.tether_length));
    if (study.outcome != CableOutcome::hangs) return;
    CHECK(study.solved.pitch == Approx(hover.pitch).epsilon(1e-5));
    if (std::isnan(hover.total_power)) return;
    CHECK(study.solved.total_power == Approx(hover.total_power).epsilon(1e-5));
    Design straight = design;
    straight.tether.model = TetherModel::straight;
    const double power = evaluate(straight, published_area, Condition::hover).total_power;
    if (!std::isnan(power)) CHECK(study.straight.total_power == Approx(power));
  });
}

TEST_CASE("what a shape asks for in place of the spec is as if the spec said so") {
  Design pulled = test::published_hanging_design();
  pulled.tether.winch_pull = 5;
  const Design loose = test::published_hanging_design();
  ShapeRequest request{.height = 30, .paid_out = {.length = {}, .winch_tension = 5}, .wind = 3};
  const auto straight = [&](const Design& design) {
    return study_cable_shape(design, published_area, request).straight;
  };
  CHECK(straight(pulled).down == straight(loose).down);
  const double taut = straight(loose).down;
  request.paid_out = {.length = 30.6, .winch_tension = {}};
  CHECK(straight(pulled).down == straight(loose).down);
  CHECK(straight(loose).down == Approx(taut - 5));
}

TEST_CASE("a shape that takes more cable than there is has none, and tells how much it takes") {
  Design design = test::published_hanging_design();
  design.tether.slack = 0.1;
  design.tether.spooled_length = 1;
  const ShapeStudy study = study_cable_shape(design, published_area, own_hover(design));
  CHECK(study.outcome == CableOutcome::too_short);
  CHECK(study.loads.length == Approx(33));
  CHECK(study.cable_there_is == Approx(31));
}

TEST_CASE("below the roughness length a cable hangs as in still air") {
  const Design design = test::published_hanging_design();
  ShapeRequest request{.height = 0.2,
                       .paid_out = {.length = 0.21, .winch_tension = {}},
                       .wind = 3,
                       .profile = WindProfile::logarithmic,
                       .reference_height = 10,
                       .roughness_length = 0.5};
  const ShapeStudy low = study_cable_shape(design, published_area, request);
  request.wind = 0;
  const ShapeStudy still = study_cable_shape(design, published_area, request);
  REQUIRE(low.outcome == CableOutcome::hangs);
  CHECK(low.solved.down == still.solved.down);
  CHECK(low.solved.against == 0);
}

TEST_CASE("the worst side of a drone aside takes no less than any side that a shape shows") {
  Design design = test::published_hanging_design();
  design.requirements.max_pitch = 60 * unit::degree;
  design.tether.slack = 0.05;
  CHECK_FALSE(worst_side(design, published_area));
  design.flight.horizontal_offset = 15;
  CHECK_FALSE(worst_side(design, published_area));  // no wind has no side
  design.flight.headwind = 5;
  const auto worst = worst_side(design, published_area);
  REQUIRE(worst);
  CHECK(worst->condition == Condition::hover);
  CHECK(worst->power > worst->upwind_power);
  ShapeRequest request = own_hover(design);
  CHECK(study_cable_shape(design, published_area, request).solved.total_power ==
        Approx(worst->upwind_power).epsilon(1e-5));
  double most = 0;
  for (int degrees = 0; degrees < 360; degrees += 30) {
    request.wind_from = degrees * unit::degree;
    most = std::max(most, study_cable_shape(design, published_area, request).solved.total_power);
  }
  CHECK(most == Approx(worst->power).epsilon(1e-5));
  design.tether.model = TetherModel::straight;
  design.flight.horizontal_offset = 0;
  CHECK_FALSE(worst_side(design, published_area));
}

TEST_CASE("the worst side is that of the flight that it is hardest on") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.02;
  design.supply.voltage = 150;
  design.flight.airspeed = 9;
  design.flight.horizontal_offset = 15;
  for (const double headwind : {0.0, 0.3, 1.0}) {
    design.flight.headwind = headwind;
    const auto worst = worst_side(design, published_area);
    REQUIRE(worst);
    CHECK(worst->condition == Condition::forward);
    // A breeze of 0.3 m/s changes little in forward flight.
    CHECK(worst->power > 1.3 * worst->upwind_power);
  }
}

TEST_CASE("whatever tells of slack cables tells of those that lie on the ground") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.2;
  design.supply.voltage = 150;
  design.tether.cross_section = 1.5 * unit::square_millimetre;
  const EnvelopeStudy envelope = study_envelope(design);
  REQUIRE(envelope.ground);
  CHECK(envelope.ground->contact.below_station > 1);
  const Design there = at_reach(design, envelope.ground->reach, envelope.ground->value);
  const auto itself = ground_contact(*design.tether.cross_section,
                                     shapes_in_flight(there, *design.tether.cross_section));
  REQUIRE(itself);
  CHECK(itself->below_station == envelope.ground->contact.below_station);

  design.tether.cross_section.reset();
  const SweepSpace offsets({{"flight.horizontal_offset_m", std::vector<double>{0, 20},
                             [](Design& d, double m) { d.flight.horizontal_offset = m; }}});
  CHECK(ground_contact(offsets, design));
  design.flight.horizontal_offset = 20;
  MotorEntry own;
  own.curve = design.drone.motor;
  const std::vector<MotorOptimum> motors = compare_motors(design, {own});
  REQUIRE(motors.front().result.feasible);
  CHECK(motors.front().ground);
  CHECK(motors.front().side);

  design.tether.slack = 0.01;
  design.flight.horizontal_offset = 0;
  design.flight.airspeed = 0;
  const SweepSpace voltages({{"supply.voltage_V", std::vector<double>{100, 150},
                              [](Design& d, double volts) { d.supply.voltage = volts; }}});
  design.tether.model = TetherModel::straight;
  CHECK_FALSE(ground_contact(voltages, design));
}
