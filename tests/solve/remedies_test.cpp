#include "tethercalc/solve/remedies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_designs.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

namespace {

double present_value(const Design& design, Quantity quantity) {
  switch (quantity) {
    case Quantity::supply_voltage:
      return design.supply.voltage;
    case Quantity::drone_mass:
      return design.drone.mass;
    case Quantity::tether_length:
      return design.tether.length;
    case Quantity::airspeed:
      break;
  }
  return design.flight.airspeed;
}

}  // namespace

TEST_CASE("a feasible design needs no remedy") {
  CHECK(remedies(test::published_design()).empty());
}

TEST_CASE("every remedy makes its design feasible, and one percent less of it does not") {
  int found = 0;
  test::each_random(150, [&found](test::Random& random) {
    const Design design = test::random_design(random);
    if (optimize(design).feasible) return;
    for (const Remedy& remedy : remedies(design)) {
      ++found;
      INFO("quantity " << static_cast<int>(remedy.quantity) << " = " << remedy.value);
      CHECK(optimize(remedied(design, remedy)).feasible);
      const double present = present_value(design, remedy.quantity);
      // Three digits round by up to 1 %; a change smaller by that must be too small.
      const double less = remedy.value + (present > remedy.value ? 0.011 : -0.011) * remedy.value;
      const bool between = (less - remedy.value) * (less - present) < 0;
      if (between) CHECK_FALSE(optimize(remedied(design, {remedy.quantity, less})).feasible);
    }
  });
  CHECK(found > 10);
}

TEST_CASE("no remedy is shorter than a tether can be") {
  Design design = test::published_design();
  design.drone.drag = {};
  design.flight.air_density = 100;
  design.flight.airspeed = 0;
  const auto flies = [&design](double length) {
    Design other = design;
    other.tether.length = length;
    return is_feasible(other);
  };
  const auto would_be_too_short = [&] {
    return flies(least_tether_length / 2) && !flies(least_tether_length);
  };
  for (double wind = 5; wind < 200 && !would_be_too_short(); wind *= 1.01) {
    design.flight.headwind = wind;
  }
  REQUIRE(would_be_too_short());
  for (const Remedy& remedy : remedies(design)) {
    CHECK(remedy.quantity != Quantity::tether_length);
  }
}

TEST_CASE("a lighter drone has the estimated drag of a lighter drone, a measured one stays") {
  const Remedy lighter{Quantity::drone_mass, 1.2};
  Design design = test::published_design();
  const double measured = design.drone.drag.front_area;
  CHECK(remedied(design, lighter).drone.drag.front_area == measured);
  design.drone.drag = drag_of_mass(design.drone.mass);
  CHECK(remedied(design, lighter).drone.drag.front_area == drag_of_mass(1.2).front_area);
}

TEST_CASE("a design on a winch is feasible where it has an optimum") {
  int feasible = 0;
  constexpr int designs = 60;
  test::each_random(test::draws(designs), [&feasible](test::Random& random) {
    Design design = test::published_hanging_design();
    design.tether.slack = 0;
    design.tether.winch_pull = random.magnitude(0.3, 30);
    design.tether.length = random.uniform(10, 60);
    design.supply.voltage = random.uniform(60, 200);
    design.flight.airspeed = random.uniform(0, 12);
    if (random.chance(0.3)) design.flight.horizontal_offset = random.uniform(1, 20);
    if (random.chance(0.2)) design.tether.axial_stiffness = random.magnitude(1e3, 1e5);
    const bool expected = optimize(design).feasible;
    CHECK(is_feasible(design) == expected);
    feasible += expected ? 1 : 0;
  });
  CHECK(feasible > 0);
  CHECK(feasible < test::draws(designs));
}

TEST_CASE("more voltage helps a starved drone, and the threshold has three digits") {
  Design design = test::published_design();
  design.supply.voltage = 24;
  for (const Remedy& remedy : remedies(design)) {
    const double decimals = 2 - std::floor(std::log10(remedy.value));
    const double scaled = remedy.value * std::pow(10, decimals);
    CHECK(scaled == Approx(std::round(scaled)).epsilon(1e-12));
  }
  REQUIRE_FALSE(remedies(design).empty());
  CHECK(remedies(design).front().quantity == Quantity::supply_voltage);
}

TEST_CASE("no voltage helps motors that are too weak, but less mass does") {
  Design design = test::published_design();
  design.drone.mass = 2.7;
  bool mass = false;
  for (const Remedy& remedy : remedies(design)) {
    CHECK(remedy.quantity != Quantity::supply_voltage);
    mass = mass || remedy.quantity == Quantity::drone_mass;
  }
  CHECK(mass);
}

TEST_CASE("a slower flight is the remedy for a tilt beyond the limit") {
  Design design = test::published_design();
  design.flight.airspeed = 20;
  design.requirements.max_pitch = 15 * unit::degree;
  const auto found = remedies(design);
  REQUIRE_FALSE(found.empty());
  CHECK(found.back().quantity == Quantity::airspeed);
}
