#include "tethercalc/study/cable_shape.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_designs.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/model/tether.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/study/optimum.hpp"

using namespace tethercalc;

namespace {

constexpr double published_area = 1.0886 * unit::square_millimetre;

ShapeStudy studied(const Design& design, ShapeRequest request, double slack) {
  request.paid_out.length = (1 + slack) * std::hypot(request.height, request.offset);
  return study_cable_shape(design, published_area, request);
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

TEST_CASE("the bare cable of a design weighs what its tether weighs") {
  const Design design = test::published_design();
  const Cable cable = cable_of(design, published_area);
  // 546.9 g for 30 m, 4·k·(r + s) wide.
  CHECK(cable.weight * 30 / design.flight.gravity == Approx(0.5469).epsilon(2e-4));
  const double radius = std::sqrt(1.0886 / 3.14159265358979) / 1000;
  CHECK(cable.diameter == Approx(4 * 0.75 * (radius + 0.75e-3)).epsilon(1e-9));
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
