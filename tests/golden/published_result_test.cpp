// The result of Beffert & Zell 2025 for its drone, to every digit it prints.

#include <catch2/catch.hpp>

#include "support/random_designs.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

TEST_CASE("the published drone's optimum is the published one") {
  const Optimization result = optimize(test::published_design());
  REQUIRE(result.feasible);
  CHECK(result.limited_by == Limit::available_power);
  CHECK(result.limiting_condition == Condition::hover);
  CHECK(result.area / unit::square_millimetre == Approx(1.0886).margin(0.00005));
  CHECK(result.hover.tether_mass / unit::gram == Approx(546.9).margin(0.05));
  CHECK(result.hover.total_power == Approx(405.4).margin(0.05));
  CHECK(result.forward.total_power == Approx(444.9).margin(0.05));
}
