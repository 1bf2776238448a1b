#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

namespace {

Design warm_design() {
  Design design = test::published_design();
  design.tether.conductor = {0.0278e-6, 0.00403, 2700, 0};
  design.tether.ambient_temperature_C = 35;
  design.tether.insulation.rated_temperature_C = 70;
  return design;
}

}  // namespace

TEST_CASE("a demand that nothing reaches changes nothing") {
  test::each_random(200, [](test::Random& random) {
    Design design = test::random_design(random);
    const Optimization plain = optimize(design);
    const BestHeadroom best = best_headroom(design, Condition::hover);
    design.supply.converter.rated_output_power = 1e9;
    design.tether.strength_member = {StrengthMaterial::uhmwpe, 0};
    design.tether.conductor.tensile_strength = 1e12;
    design.requirements.strength_safety_factor = 1;
    const Optimization limited = optimize(design);
    CHECK(best_headroom(design, Condition::hover).value == Approx(best.value).epsilon(1e-12));
    // The set keeps its meaning, too.
    REQUIRE(limited.headroom_areas.size() == plain.headroom_areas.size());
    for (std::size_t i = 0; i < plain.headroom_areas.size(); ++i) {
      CHECK(limited.headroom_areas[i].lo == Approx(plain.headroom_areas[i].lo).epsilon(1e-10));
      CHECK(limited.headroom_areas[i].hi == Approx(plain.headroom_areas[i].hi).epsilon(1e-10));
    }
    REQUIRE(limited.feasible == plain.feasible);
    if (!plain.feasible) return;
    const bool hover = design.requirements.power_at == Condition::hover;
    const double power = (hover ? plain.hover : plain.forward).total_power;
    if (std::isnan(power)) return;  // on the tilt limit, which rounding passes
    CHECK((hover ? limited.hover : limited.forward).total_power == Approx(power).epsilon(1e-9));
  });
}

TEST_CASE("the rated temperature binds where it is named, and nothing cheaper keeps it") {
  Design design = warm_design();
  design.requirements.buffer_battery = true;
  design.tether.spooled_length = 30;
  design.tether.drum.layers = 4;
  design.tether.insulation.rated_temperature_C = 60;
  const Optimization result = optimize(design);
  REQUIRE(result.feasible);
  CHECK(result.limited_by == Limit::conductor_temperature);
  const double hottest = std::max(result.hover.drum_temperature, result.forward.drum_temperature);
  CHECK(hottest == Approx(60).margin(1e-5));
  for (double area = 0.3e-6; area < 8e-6; area *= 1.01) {
    const OperatingPoint hover = evaluate(design, area, Condition::hover);
    const OperatingPoint forward = evaluate(design, area, Condition::forward);
    const bool keeps = (hover.headroom >= 1) && (forward.headroom >= 1) &&
                       hover.drum_temperature <= 60 && forward.drum_temperature <= 60;
    if (keeps) CHECK(forward.total_power >= result.forward.total_power * (1 - 1e-9));
  }
}

TEST_CASE("of what a winch leaves on the drum the rating is kept, and nothing cheaper keeps it") {
  Design design = warm_design();
  design.requirements.buffer_battery = true;
  design.tether.model = TetherModel::solved;
  design.tether.winch_pull = 3;
  design.tether.drum.core_diameter = 0.05;
  design.tether.drum.width = 0.05;
  design.supply.voltage = 120;
  int bound_by_heat = 0;
  for (const double spooled : {4.0, 8.0, 16.0}) {
    design.tether.spooled_length = spooled;
    const Optimization result = optimize(design);
    REQUIRE(result.feasible);
    if (result.limited_by == Limit::conductor_temperature) ++bound_by_heat;
    for (double area = 0.3e-6; area < 3e-6; area *= 1.03) {
      const OperatingPoint hover = evaluate(design, area, Condition::hover);
      const OperatingPoint forward = evaluate(design, area, Condition::forward);
      const bool keeps =
          (hover.headroom >= 1) && (forward.headroom >= 1) &&
          !(std::max(hover.conductor_temperature, forward.conductor_temperature) > 70) &&
          !(hover.drum_temperature > 70) && !(forward.drum_temperature > 70);
      if (keeps) CHECK(forward.total_power >= result.forward.total_power * (1 - 1e-6));
    }
  }
  CHECK(bound_by_heat > 0);
}

TEST_CASE("the drum's width bounds the cross-section where a turn just fits, and is named") {
  Design design = test::published_design();
  design.requirements.buffer_battery = true;
  const double least_power = optimize(design).area;
  design.tether.drum = {.core_diameter = 0.1, .width = 3.5e-3};
  const Optimization result = optimize(design);
  REQUIRE(result.feasible);
  CHECK(result.limited_by == Limit::drum_width);
  // Two insulated wires side by side, of which a turn takes the square: √8 times one's radius.
  const double radius = 3.5e-3 / std::sqrt(8) - design.tether.insulation.thickness;
  CHECK(result.area == Approx(std::numbers::pi * radius * radius).epsilon(1e-12));
  CHECK(result.area < least_power);
  design.requirements.buffer_battery = false;
  const Optimization refused = optimize(design);
  CHECK_FALSE(refused.feasible);
  CHECK(refused.limited_by == Limit::drum_width);
  // A wide one changes nothing.
  design.tether.drum.width = 1;
  CHECK(optimize(design).area == optimize(test::published_design()).area);
}

TEST_CASE("a tether that cannot bear its tension is refused, and a strength member helps") {
  Design design = test::published_design();  // aluminium of unknown strength
  design.requirements.strength_safety_factor = 5;
  const Optimization weak = optimize(design);
  CHECK_FALSE(weak.feasible);
  CHECK(weak.limited_by == Limit::tether_strength);
  design.tether.strength_member = {StrengthMaterial::uhmwpe, 0.1e-6};
  const Optimization strong = optimize(design);
  REQUIRE(strong.feasible);
  CHECK(breaking_load(design.tether, strong.area) >= 5 * strong.forward.tether_tension);
}

TEST_CASE("a converter too small for the drone is named as what binds") {
  Design design = test::published_design();
  design.supply.converter.rated_output_power = 200;
  const Optimization result = optimize(design);
  CHECK_FALSE(result.feasible);
}

TEST_CASE("with a reserve battery no cross-section that meets the demands is cheaper") {
  test::each_random(16, [](test::Random& random) {
    Design design = test::random_design(random);
    if (random.chance(0.7)) design.flight.headwind = random.uniform(-8, 12);
    design.drone.reserve_battery.specific_energy = random.uniform(100, 250) * 3600;
    const Optimization result = optimize(design);
    const bool hover_priced = design.requirements.power_at == Condition::hover;
    double cheapest = std::numeric_limits<double>::infinity();
    for (double area = 0.02e-6; area < 50e-6; area *= 1.01) {
      const OperatingPoint hover = evaluate(design, area, Condition::hover);
      const OperatingPoint forward = evaluate(design, area, Condition::forward);
      const Requirements& need = design.requirements;
      const OperatingPoint& judged = need.headroom_at == Condition::hover ? hover : forward;
      const bool met = (hover.headroom >= 1) && (forward.headroom >= 1) &&
                       (need.buffer_battery || judged.headroom >= need.thrust_headroom);
      if (met) {
        cheapest = std::min(cheapest, (hover_priced ? hover : forward).total_power);
      }
    }
    if (std::isinf(cheapest)) return;
    REQUIRE(result.feasible);
    CHECK((hover_priced ? result.hover : result.forward).total_power <= cheapest * (1 + 1e-9));
  });
}

TEST_CASE("a converter's rating caps the best headroom") {
  Design design = test::published_design();
  design.supply.converter.specific_mass = 0.4e-3;
  for (const double rated : {450.0, 700.0}) {
    design.supply.converter.rated_output_power = rated;
    const BestHeadroom best = best_headroom(design, Condition::hover);
    CHECK(evaluate(design, best.area, Condition::hover).headroom == best.value);
    double most = 0;
    for (double area = 0.05e-6; area < 50e-6; area *= 1.001) {
      most = std::max(most, evaluate(design, area, Condition::hover).headroom);
    }
    CHECK(best.value >= most * (1 - 1e-12));
    CHECK(best.value == Approx(most).epsilon(2e-3));
    CHECK((optimize(design).headroom_areas.empty()) == (best.value < 2));
  }
}

TEST_CASE("a cable in thermal runaway has no headroom") {
  Design design = warm_design();
  design.tether.insulation.rated_temperature_C.reset();
  design.tether.conductor.temperature_coefficient = 0.01;
  design.tether.spooled_length = 200;
  design.tether.drum.layers = 4;
  bool ran_away = false;
  const IntervalSet set = headroom_areas(SteadyFlight(design, Condition::hover), 1);
  for (double area = 0.05e-6; area < 10e-6; area *= 1.02) {
    const OperatingPoint point = evaluate(design, area, Condition::hover);
    ran_away = ran_away || point.thermal_runaway;
    if (point.thermal_runaway) CHECK(std::isnan(point.headroom));
    CHECK(contains(set, area) == (point.headroom >= 1));
  }
  CHECK(ran_away);
}

TEST_CASE("the best headroom of a warm or a battery-laden cable is the best of its areas") {
  for (const bool warm : {true, false}) {
    Design design = warm ? warm_design() : test::published_design();
    if (!warm) design.drone.reserve_battery.specific_energy = 120 * 3600;
    const BestHeadroom best = best_headroom(design, Condition::hover);
    double most = 0;
    for (double area = 0.1e-6; area < 50e-6; area *= 1.005) {
      const double headroom = evaluate(design, area, Condition::hover).headroom;
      if (headroom > most) most = headroom;
    }
    CHECK(best.value >= most * (1 - 1e-12));
    CHECK(best.value == Approx(most).epsilon(2e-3));  // a peak between two steps of the area
    CHECK(evaluate(design, best.area, Condition::hover).headroom == best.value);
  }
}

TEST_CASE("a tether pays out no more than the drum holds: the optimum says what is missing") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.1;
  design.tether.spooled_length = 3.001;  // 33 m of 33.001 m are out
  CHECK(optimize(design).feasible);
  design.tether.spooled_length = 2.999;
  const Optimization short_by_a_millimetre = optimize(design);
  CHECK_FALSE(short_by_a_millimetre.feasible);
  CHECK(short_by_a_millimetre.limited_by == Limit::tether_shape);
  design.tether.spooled_length = 0;  // cut to the length it takes
  CHECK(optimize(design).feasible);
}
