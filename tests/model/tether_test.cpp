#include "tethercalc/model/tether.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/random_designs.hpp"

using namespace tethercalc;

TEST_CASE("a tether of double length and double area keeps its resistance") {
  test::each_random(200, [](test::Random& random) {
    Tether tether = test::random_design(random).tether;
    const double area = random.magnitude(1e-8, 1e-4);
    const double resistance = loop_resistance(tether, area);
    tether.length *= 2;
    tether.spooled_length *= 2;
    CHECK(loop_resistance(tether, 2 * area) == Approx(resistance).epsilon(1e-14));
  });
}

TEST_CASE("a bare conductor's mass is its volume, two ways of the height") {
  Tether tether;
  tether.length = 30;
  tether.conductor.density = 2700;
  CHECK(airborne_mass(tether, 1e-6) == Approx(2 * 30 * 2700 * 1e-6));
}

TEST_CASE("insulation is the ring around the conductor") {
  Tether tether;
  tether.length = 1;
  tether.insulation = {1000, 1e-3};
  const double area = std::numbers::pi * 4e-6;  // radius 2 mm
  CHECK(airborne_mass(tether, area) == Approx(2 * 1000 * std::numbers::pi * (9e-6 - 4e-6)));
}

TEST_CASE("line on the drum adds resistance but neither mass nor drag") {
  Tether tether = test::published_design().tether;
  Tether spooled = tether;
  spooled.spooled_length = 30;
  CHECK(loop_resistance(spooled, 1e-6) == Approx(2 * loop_resistance(tether, 1e-6)));
  CHECK(airborne_mass(spooled, 1e-6) == airborne_mass(tether, 1e-6));
  CHECK(tether_drag_area(spooled, 1e-6) == tether_drag_area(tether, 1e-6));
}

TEST_CASE("contacts add their resistance whatever the area") {
  Tether tether = test::published_design().tether;
  const double line = loop_resistance(tether, 1e-6);
  tether.contact_resistance = 0.25;
  CHECK(loop_resistance(tether, 1e-6) == Approx(line + 0.25));
  CHECK(loop_resistance(tether, 1e6) == Approx(0.25));
}

TEST_CASE("resistivity rises with temperature by its coefficient from 20 degrees on") {
  Tether tether;
  tether.conductor = {2.8e-8, 0.004, 2700};
  CHECK(resistivity(tether) == 2.8e-8);
  tether.conductor_temperature_C = 70;
  CHECK(resistivity(tether) == Approx(2.8e-8 * 1.2));
}
