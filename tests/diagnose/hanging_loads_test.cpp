// Loads between places of a grid against the solver itself.
#include "diagnose/hanging_loads.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"

using namespace tethercalc;
using test::Random;

namespace {

/// Of a cable of 4 mm that weighs 18 g/m, above its station.
HangingSituation situation_at(double height, double airspeed) {
  HangingSituation s{.weight = {0.18, 0, 0}, .width = {0.004, 0}, .air = {}, .paid_out = {}};
  s.air.density = 1.293;
  s.air.wind.x = -airspeed;
  s.air.reference_height = height;
  s.height = height;
  return s;
}

HangingLoad::Parts solved(const HangingSituation& situation, double radius) {
  return HangingLoad(situation, ConductorsAsked::one).at(radius).value;
}

}  // namespace

TEST_CASE("loads of a log's hanging tether are those of the solver to 1e-4 of the tension") {
  constexpr double radius = 6e-4;
  HangingLoads loads;
  test::each_random(test::draws(60), [&](Random& random) {
    HangingSituation s = situation_at(random.uniform(4, 40), random.uniform(0, 10));
    if (random.chance(0.5)) {
      s.paid_out.winch_tension = random.uniform(2, 6);
    } else {
      s.paid_out.length = s.height * (1 + random.magnitude(0.01, 0.1));
    }
    s.drag_coefficient = random.uniform(0.7, 2);
    switch (random.integer(0, 4)) {
      case 1:
        s.air.profile = WindProfile::power_law;
        break;
      case 2:
        s.air.profile = WindProfile::power_law;
        s.air.station_height = 6;
        s.air.reference_height += 6;
        break;
      case 3:
        s.air.profile = WindProfile::logarithmic;
        s.air.roughness_length = 0.3;
        break;
      case 4:
        s.cylinder = {1.4e-3, 2};
        break;
      default:
        break;
    }
    INFO(static_cast<int>(s.air.profile)
         << ", " << s.air.station_height << ", Reynolds " << s.cylinder.has_value() << ", "
         << s.height << " m, " << s.air.wind.x << " m/s, " << s.paid_out.length.value_or(0)
         << " m");
    const HangingLoad::Parts exact = solved(s, radius);
    const HangingLoad::Parts found = loads.at(s, radius);
    const double margin = 1e-4 * exact.tension_at_drone;
    CHECK(found.along == Approx(exact.along).margin(margin));
    CHECK(found.down == Approx(exact.down).margin(margin));
    CHECK(found.tension_at_ground == Approx(exact.tension_at_ground).margin(margin));
    CHECK(found.length == Approx(exact.length).epsilon(1e-4));
  });
}

TEST_CASE("a winch that lets out more cable than there is does not hold a log's tether") {
  HangingSituation s = situation_at(20, 6);
  s.paid_out.winch_tension = 3;
  HangingLoads loads;
  const double length = loads.at(s, 6e-4).length;
  CHECK(length > 20);
  s.cable_there_is = length - 0.01;
  CHECK(std::isinf(loads.at(s, 6e-4).length));
}
