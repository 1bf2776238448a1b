#include "tethercalc/model/tether.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/random_designs.hpp"
#include "support/straight_tether.hpp"

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
