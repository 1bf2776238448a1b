#include "tethercalc/study/envelope.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "support/straight_tether.hpp"

using namespace tethercalc;

namespace {

/// Whether the cable does all that is demanded, told from its operating points alone.
bool flies(const Design& design) {
  const double area = *design.tether.cross_section;
  const OperatingPoint hover = evaluate(design, area, Condition::hover);
  const OperatingPoint forward = evaluate(design, area, Condition::forward);
  const Requirements& need = design.requirements;
  const OperatingPoint& judged = need.headroom_at == Condition::hover ? hover : forward;
  return (hover.headroom >= 1) && (forward.headroom >= 1) &&
         (need.buffer_battery || judged.headroom >= need.thrust_headroom);
}

/// How far aside, which something limits.
ReachEnd bounded_offset(const Design& design) {
  const auto aside = greatest_reach(design, Reach::offset);
  REQUIRE(aside);
  REQUIRE(aside->bounded);
  return *aside;
}

}  // namespace

TEST_CASE("the greatest payload of strong power is what the motors' last point leaves") {
  Design design = test::published_design();
  design.supply.voltage = 600;
  design.flight.airspeed = 0;
  design.tether.cross_section = 1.5e-6;
  const auto end = greatest_reach(design, Reach::payload);
  REQUIRE(end);
  const double tether = test::airborne_mass(design.tether, 1.5e-6);
  const double lifted = 4 * design.drone.motor.max_thrust() / (2 * standard_gravity);
  CHECK(end->value == Approx(lifted - 1.71 - tether).epsilon(1e-8));
  CHECK(end->limit == Limit::motor_thrust);
}

TEST_CASE("in the envelope a cable flies, beyond it it does not") {
  int ends = 0;
  for (unsigned i = 0; i < 60; ++i) {
    test::Random random(test::run_seed() + i);
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    Design design = test::random_design(random);
    design.flight.headwind = 0;
    design.tether.cross_section = random.magnitude(0.3e-6, 6e-6);
    for (const Reach reach : reaches_of(design)) {
      const auto end = greatest_reach(design, reach);
      if (!end || !end->bounded) continue;
      ++ends;
      CHECK(flies(at_reach(design, reach, end->value)));
      // Every value beyond, of a grid unlike the one of the search.
      const double last = search_end(design, reach);
      for (double value = end->value * (1 + 1e-6) + 1e-9; value < last;
           value = value * 1.3 + 0.01) {
        CHECK_FALSE(flies(at_reach(design, reach, value)));
      }
    }
  }
  CHECK(ends > 30);
}

TEST_CASE("with power to spare a drone goes aside as far as its drum lets it") {
  Design design = test::published_design();
  design.supply.voltage = 600;
  design.requirements.thrust_headroom = 1.2;
  design.flight.airspeed = 3;
  design.tether.cross_section = 0.5e-6;
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.02;
  design.tether.spooled_length = 15;
  for (const double height : {12.0, 30.0, 40.0}) {
    const Design there = at_reach(design, Reach::height, height);
    const ReachEnd aside = bounded_offset(there);
    CHECK(aside.limit == Limit::tether_shape);
    CHECK(aside.drum_is_empty);
    // All 45 m are out: 1.02·√(height² + offset²).
    CHECK(aside.value == Approx(std::sqrt(45 * 45 / (1.02 * 1.02) - height * height)));
  }
  const auto highest = greatest_reach(design, Reach::height);
  REQUIRE(highest);
  CHECK(highest->value == Approx(45 / 1.02));
}

TEST_CASE("a solved tether lets its drone aside so far, a straight one has no side") {
  Design design = test::published_design();
  design.tether.cross_section = 1.2e-6;
  CHECK(study_envelope(design).greatest.size() == 4);
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.03;
  for (const double wind : {0.0, 2.5, 5.0}) {
    const Design windy = at_reach(design, Reach::headwind, wind);
    const ReachEnd aside = bounded_offset(windy);
    CHECK_FALSE(aside.drum_is_empty);
    CHECK(flies(at_reach(windy, Reach::offset, aside.value * (1 - 1e-6))));
    CHECK_FALSE(flies(at_reach(windy, Reach::offset, aside.value * 1.001)));
    CHECK_FALSE(flies(at_reach(windy, Reach::offset, aside.value * 2)));
  }
}

TEST_CASE("more height leaves less payload and less wind") {
  Design design = test::published_design();
  design.tether.cross_section = 1.5e-6;
  for (const Reach of : {Reach::payload, Reach::headwind}) {
    const auto curve = envelope_curve(design, of, Reach::height);
    REQUIRE(curve.size() == 11);
    double before = 1e9;
    for (const EnvelopePoint& point : curve) {
      REQUIRE(point.end);
      CHECK(point.end->value <= before);
      before = point.end->value;
    }
  }
}

TEST_CASE("height unwinds the drum: the circuit stays as long, and ends with the cable") {
  Design design = test::published_design();
  design.tether.cross_section = 1.2e-6;
  design.tether.spooled_length = 20;
  design.requirements.thrust_headroom = 1.2;
  const Design higher = at_reach(design, Reach::height, 40);
  CHECK(higher.tether.length == 40);
  CHECK(higher.tether.spooled_length == Approx(10));
  CHECK(evaluate(higher, 1.2e-6, Condition::hover).tether_resistance ==
        Approx(evaluate(design, 1.2e-6, Condition::hover).tether_resistance));
  const auto end = greatest_reach(design, Reach::height);
  REQUIRE(end);
  CHECK(end->value <= 50);
}

TEST_CASE("below the roughness length a drone hovers in still air, where an envelope starts") {
  Design design = test::published_design();
  design.tether.cross_section = 1.5e-6;
  design.flight.wind_profile = WindProfile::logarithmic;
  design.flight.roughness_length = 0.3;
  design.flight.headwind = 5;
  for (const TetherModel model : {TetherModel::straight, TetherModel::solved}) {
    design.tether.model = model;
    CHECK(wind_at_drone(design) == 5);
    CHECK(wind_at_drone(at_reach(design, Reach::height, 0.2)) == 0);
    const auto highest = greatest_reach(design, Reach::height);
    REQUIRE(highest);
    CHECK(highest->value > 20);
    CHECK(envelope_curve(design, Reach::payload, Reach::height, 3).size() == 3);
  }
}

TEST_CASE("a reach that the design itself flies is found, however narrow it is") {
  Design design = test::published_hanging_design();
  design.tether.cross_section = 1.5e-6;
  design.tether.slack = 0.003;
  design.flight.horizontal_offset = 20;
  design.requirements.max_pitch = 15.2 * unit::degree;
  design.requirements.thrust_headroom = 1.35;
  const auto height = greatest_reach(design, Reach::height);
  REQUIRE(flies(design) == height.has_value());
  REQUIRE(height);
  CHECK(height->from < 30);
  CHECK(height->value > 30);
  CHECK(flies(at_reach(design, Reach::height, height->from * 1.001)));
  CHECK_FALSE(flies(at_reach(design, Reach::height, height->from * 0.999)));
}

TEST_CASE("a greatest reach below which the demands are missed says from where on they are met") {
  Design design = test::published_hanging_design();
  design.tether.cross_section = 1.5e-6;
  design.tether.slack = 0.05;
  design.flight.headwind = 10;
  REQUIRE_FALSE(flies(design));
  const ReachEnd aside = bounded_offset(design);
  CHECK(aside.from > 0);
  CHECK_FALSE(flies(at_reach(design, Reach::offset, aside.from * 0.999)));
  for (const double share : {0.001, 0.25, 0.5, 0.75, 0.999}) {
    CHECK(flies(at_reach(design, Reach::offset, std::lerp(aside.from, aside.value, share))));
  }
  design.flight.headwind = 2;
  CHECK(bounded_offset(design).from == 0);
}
