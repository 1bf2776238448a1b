#include "tethercalc/model/tether.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/random_designs.hpp"
#include "support/straight_tether.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/steady_flight.hpp"

using namespace tethercalc;

TEST_CASE("a tether of double length and double area keeps its resistance") {
  test::each_random(200, [](test::Random& random) {
    Tether tether = test::random_design(random).tether;
    const double area = random.magnitude(1e-8, 1e-4);
    const double resistance = test::loop_resistance(tether, area);
    tether.length *= 2;
    tether.spooled_length *= 2;
    CHECK(test::loop_resistance(tether, 2 * area) == Approx(resistance).epsilon(1e-14));
  });
}

TEST_CASE("a bare conductor's mass is its volume, two ways of the height") {
  Tether tether;
  tether.length = 30;
  tether.conductor.density = 2700;
  CHECK(test::airborne_mass(tether, 1e-6) == Approx(2 * 30 * 2700 * 1e-6));
}

TEST_CASE("insulation is the ring around the conductor") {
  Tether tether;
  tether.length = 1;
  tether.insulation = {1000, 1e-3};
  const double area = std::numbers::pi * 4e-6;  // radius 2 mm
  CHECK(test::airborne_mass(tether, area) == Approx(2 * 1000 * std::numbers::pi * (9e-6 - 4e-6)));
}

TEST_CASE("line on the drum adds resistance but neither mass nor drag") {
  Tether tether = test::published_design().tether;
  Tether spooled = tether;
  spooled.spooled_length = 30;
  CHECK(test::loop_resistance(spooled, 1e-6) == Approx(2 * test::loop_resistance(tether, 1e-6)));
  CHECK(test::airborne_mass(spooled, 1e-6) == test::airborne_mass(tether, 1e-6));
  CHECK(test::straight(spooled, 10).drag(1e-3) == test::straight(tether, 10).drag(1e-3));
}

TEST_CASE("contacts add their resistance whatever the area") {
  Tether tether = test::published_design().tether;
  const double line = test::loop_resistance(tether, 1e-6);
  tether.contact_resistance = 0.25;
  CHECK(test::loop_resistance(tether, 1e-6) == Approx(line + 0.25));
  CHECK(test::loop_resistance(tether, 1e6) == Approx(0.25));
}

TEST_CASE("resistivity rises with temperature by its coefficient from 20 degrees on") {
  const Conductor conductor{2.8e-8, 0.004, 2700};
  CHECK(resistivity(conductor, 20) == 2.8e-8);
  CHECK(resistivity(conductor, 70) == Approx(2.8e-8 * 1.2));
}

TEST_CASE("stranding adds resistance, a cover adds mass and width, and neither anything else") {
  Design design = test::published_design();
  design.tether.conductor.tensile_strength = 1e8;
  const OperatingPoint plain = evaluate(design, 1.0886e-6, Condition::forward);
  Design stranded = design;
  stranded.tether.stranding_factor = 1.095;
  const OperatingPoint fine = evaluate(stranded, 1.0886e-6, Condition::forward);
  CHECK(fine.tether_resistance == Approx(1.095 * plain.tether_resistance).epsilon(1e-14));
  CHECK(fine.tether_mass == plain.tether_mass);
  CHECK(fine.drone_power == plain.drone_power);
  CHECK(fine.total_power > plain.total_power);
  CHECK(SteadyFlight(stranded, Condition::hover)
            .tether()
            .radius_of_resistance(fine.tether_resistance) ==
        Approx(conductor_radius(1.0886e-6)).epsilon(1e-12));

  Design covered = design;
  covered.tether.cover_mass = 0.004;
  covered.tether.cover_width = 2e-3;
  const OperatingPoint heavy = evaluate(covered, 1.0886e-6, Condition::forward);
  CHECK(heavy.tether_mass == Approx(plain.tether_mass + 30 * 0.004).epsilon(1e-13));
  CHECK(heavy.tether_resistance == plain.tether_resistance);
  const SteadyFlight bare(design, Condition::forward);
  const SteadyFlight wide(covered, Condition::forward);
  const double radius = conductor_radius(1.0886e-6);
  CHECK(wide.tether().straight().width(radius) ==
        Approx(bare.tether().straight().width(radius) + 0.75 * 2e-3).epsilon(1e-13));
  CHECK(wide.tether().drag(radius) / bare.tether().drag(radius) ==
        Approx(wide.tether().straight().width(radius) / bare.tether().straight().width(radius))
            .epsilon(1e-13));
  CHECK(wide.tether().straight().mass_of(10, radius) ==
        Approx(bare.tether().straight().mass_of(10, radius) + 0.04).epsilon(1e-13));
  CHECK(breaking_load(covered.tether, 1e-6) == breaking_load(design.tether, 1e-6));
}

TEST_CASE("a stranded conductor warms as one of that much more resistivity") {
  Design design = test::published_design();
  design.tether.ambient_temperature_C = 30;
  design.tether.conductor.temperature_coefficient = 0.004;
  Design stranded = design;
  stranded.tether.stranding_factor = 1.095;
  design.tether.conductor.resistivity_20C *= 1.095;
  const OperatingPoint a = evaluate(stranded, 1.5e-6, Condition::hover);
  const OperatingPoint b = evaluate(design, 1.5e-6, Condition::hover);
  CHECK(a.conductor_temperature == Approx(b.conductor_temperature).epsilon(1e-10));
  CHECK(a.total_power == Approx(b.total_power).epsilon(1e-12));
}
