#include "tethercalc/solve/optimize.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"

using namespace tethercalc;
using test::plain::infinity;

namespace {

/// Whether the plain equations allow `area`, demands loosened by the share `slack` (tightened where
/// negative).
bool plainly_allowed(const Design& design, double area, double slack) {
  const Requirements& need = design.requirements;
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const auto point = test::plain::evaluate(design, area, condition);
    const bool judged = condition == need.headroom_at && !need.buffer_battery;
    const double demanded = judged ? std::max(1.0, need.thrust_headroom) : 1.0;
    if (std::abs(point.pitch) > need.max_pitch * (1 + slack)) return false;
    if (point.headroom < demanded * (1 - slack)) return false;
  }
  return true;
}

/// A design that, when it is flyable at all, lies between the trivial and the impossible.
Design random_contested_design(test::Random& random) {
  Design design = test::random_design(random);
  if (random.chance(0.5)) {  // forward flight close to the tilt limit
    design.flight.airspeed = random.uniform(10, 30);
    design.requirements.max_pitch = random.uniform(10, 40) * unit::degree;
  }
  return design;
}

struct Best {
  double area = std::nan("");
  double power = infinity;
};

Best best_of_brute_force(const Design& design, int count) {
  Best best;
  for (int i = 0; i < count; ++i) {
    const double area = 1e-9 * std::pow(1e6, i / (count - 1.0));  // 0.001 to 1000 mm²
    const double power =
        test::plain::evaluate(design, area, design.requirements.power_at).total_power;
    // Areas on the very edge, where rounding decides, prove nothing.
    if (power < best.power && plainly_allowed(design, area, -1e-9)) best = {area, power};
  }
  return best;
}

}  // namespace

TEST_CASE("the optimum is no worse than 10,000 areas tried one by one") {
  test::each_random(60, [](test::Random& random) {
    const Design design = random_contested_design(random);
    const Optimization result = optimize(design);
    const Best best = best_of_brute_force(design, 10000);
    CHECK(result.feasible >= (best.power < infinity));
    if (!result.feasible) return;
    const OperatingPoint& priced =
        design.requirements.power_at == Condition::hover ? result.hover : result.forward;
    CHECK(priced.total_power <= best.power * (1 + 1e-9));
  });
}

TEST_CASE("the optimum satisfies every constraint it claims") {
  int feasible = 0;
  test::each_random(2000, [&feasible](test::Random& random) {
    const Design design = random_contested_design(random);
    const Optimization result = optimize(design);
    if (!result.feasible) {
      CHECK(std::isnan(result.area));
      return;
    }
    ++feasible;
    CHECK(plainly_allowed(design, result.area, 1e-9));
    CHECK(contains(result.feasible_areas, result.area));
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      const OperatingPoint& ours = condition == Condition::hover ? result.hover : result.forward;
      const auto plain = test::plain::evaluate(design, result.area, condition);
      CHECK(ours.cross_section == result.area);
      CHECK(ours.headroom == Approx(plain.headroom).epsilon(1e-9));
      if (plain.total_power < infinity) {
        CHECK(ours.total_power == Approx(plain.total_power).epsilon(1e-7));
      }
    }
  });
  CHECK(feasible > 200);  // else the random designs would prove little
}

TEST_CASE("an area beyond the limit that is named breaks the constraint that is named") {
  int by_power = 0;
  int by_mass = 0;
  int by_tilt = 0;
  test::each_random(2000, [&](test::Random& random) {
    const Design design = random_contested_design(random);
    const Optimization result = optimize(design);
    if (!result.feasible || result.limited_by == Limit::minimum_power) return;
    const bool thinner_is_cheaper = result.area > result.minimum_power.area;
    // The optimum itself, unless the power has a second valley.
    double edge = result.area;
    for (const Interval& range : result.feasible_areas) {
      if (range.contains(result.area)) edge = thinner_is_cheaper ? range.lo : range.hi;
    }
    const double beyond = edge * (thinner_is_cheaper ? 1 - 1e-6 : 1 + 1e-6);
    const auto point = test::plain::evaluate(design, beyond, result.limiting_condition);
    if (result.limited_by == Limit::max_pitch) {
      // The least power is looked for within the tilt limit; where it lies on the limit, the
      // forbidden side is either.
      const auto tilts_beyond = [&](double factor) {
        return test::plain::evaluate(design, result.area * factor, result.limiting_condition)
            .tilts_too_far;
      };
      CHECK((point.tilts_too_far || (result.area == result.minimum_power.area &&
                                     (tilts_beyond(1 - 1e-6) || tilts_beyond(1 + 1e-6)))));
      ++by_tilt;
      return;
    }
    const auto there = test::plain::evaluate(design, edge, result.limiting_condition);
    CHECK(point.headroom < there.headroom);
    (result.limited_by == Limit::available_power ? by_power : by_mass)++;
    CHECK((result.limited_by == Limit::available_power) == thinner_is_cheaper);
  });
  CHECK(by_power > 20);
  CHECK(by_tilt + by_mass > 0);
}

TEST_CASE("an inner optimum is the minimum-power area") {
  test::each_random(500, [](test::Random& random) {
    const Design design = random_contested_design(random);
    const Optimization result = optimize(design);
    if (!result.feasible) return;
    const bool least_power = result.area == result.minimum_power.area;
    // On the tilt limit, the tilt is what keeps the least power from being less.
    CHECK((result.limited_by == Limit::minimum_power) ==
          (least_power && result.limited_by != Limit::max_pitch));
  });
}

TEST_CASE("more voltage never makes a feasible design infeasible, nor its optimum dearer") {
  test::each_random(500, [](test::Random& random) {
    Design design = random_contested_design(random);
    const Optimization low = optimize(design);
    if (!low.feasible) return;
    design.supply.voltage *= random.uniform(1, 3);
    const Optimization high = optimize(design);
    REQUIRE(high.feasible);
    const bool hover = design.requirements.power_at == Condition::hover;
    const double before = hover ? low.hover.total_power : low.forward.total_power;
    const double after = hover ? high.hover.total_power : high.forward.total_power;
    if (before > 0) CHECK(after <= before * (1 + 1e-9));
  });
}

TEST_CASE("asking for more headroom never finds less power") {
  test::each_random(500, [](test::Random& random) {
    Design design = random_contested_design(random);
    design.requirements.buffer_battery = false;
    const Optimization easy = optimize(design);
    design.requirements.thrust_headroom *= random.uniform(1, 1.2);
    const Optimization hard = optimize(design);
    if (!hard.feasible) return;
    REQUIRE(easy.feasible);
    const bool hover = design.requirements.power_at == Condition::hover;
    CHECK((hover ? easy.hover : easy.forward).total_power <=
          (hover ? hard.hover : hard.forward).total_power * (1 + 1e-9));
  });
}

TEST_CASE("a buffer battery reports the headroom without enforcing it") {
  test::each_random(300, [](test::Random& random) {
    Design design = random_contested_design(random);
    design.requirements.buffer_battery = false;
    const Optimization enforced = optimize(design);
    design.requirements.buffer_battery = true;
    const Optimization buffered = optimize(design);
    CHECK(buffered.headroom_areas.size() == enforced.headroom_areas.size());
    if (enforced.feasible) REQUIRE(buffered.feasible);
  });
}

TEST_CASE("motors too weak for drone and headroom are named as the obstacle") {
  Design design = test::published_design();
  design.drone.mass = 2.7;  // 4 × 1332 g of thrust for twice 2700 g and a tether
  const Optimization result = optimize(design);
  CHECK_FALSE(result.feasible);
  CHECK(result.limited_by == Limit::motor_thrust);
  CHECK(result.limiting_condition == Condition::hover);
}

TEST_CASE("a voltage too low for the length is named as the obstacle") {
  Design design = test::published_design();
  design.supply.voltage = 24;
  const Optimization result = optimize(design);
  CHECK_FALSE(result.feasible);
  CHECK(result.limited_by == Limit::available_power);
}

TEST_CASE("a cut-off at the supply's voltage lets no power through") {
  Design design = test::published_design();
  design.supply.converter.min_input_voltage = design.supply.voltage;
  const Optimization result = optimize(design);
  CHECK_FALSE(result.feasible);
  CHECK(result.limited_by == Limit::available_power);
}

TEST_CASE("an airspeed that needs more tilt than allowed is named as the obstacle") {
  Design design = test::published_design();
  design.flight.airspeed = 40;
  design.requirements.max_pitch = 10 * unit::degree;
  const Optimization result = optimize(design);
  CHECK_FALSE(result.feasible);
  CHECK(result.limited_by == Limit::max_pitch);
  CHECK(result.limiting_condition == Condition::forward);
}

TEST_CASE("an empty motor curve is an infeasible design, not a crash") {
  Design design = test::published_design();
  design.drone.motor = MotorCurve();
  CHECK_FALSE(optimize(design).feasible);
}

TEST_CASE("a bench of another density gives the optimum of the curve scaled beforehand") {
  test::each_random(200, [](test::Random& random) {
    Design design = test::random_extreme_design(random);
    design.drone.motor_air_density = design.flight.air_density * random.uniform(0.6, 1.6);
    Design scaled = design;
    scaled.drone.motor = motor_in_flight(design);
    scaled.drone.motor_air_density.reset();
    scaled.drone.motor.set_measured_in({});
    const Optimization a = optimize(design);
    const Optimization b = optimize(scaled);
    CHECK(a.feasible == b.feasible);
    CHECK(a.limited_by == b.limited_by);
    const bool same = a.area == b.area || (std::isnan(a.area) && std::isnan(b.area));
    CHECK(same);
  });
}

TEST_CASE("a winch that holds up only tethers too thin for the power is what limits") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.winch_pull = 0.5;
  design.flight.horizontal_offset = 20;
  const Optimization refused = optimize(design);
  REQUIRE_FALSE(refused.feasible);
  CHECK(refused.limited_by == Limit::tether_shape);
  design.supply.voltage = 410;
  const Optimization thin = optimize(design);
  REQUIRE(thin.feasible);
  CHECK(thin.limited_by == Limit::tether_shape);
  CHECK(std::isnan(evaluate(design, 1.01 * thin.area, thin.limiting_condition).tether_length));
}

TEST_CASE("a drum that holds too little for what blows thinner tethers aside is what limits") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.winch_pull = 1.6;
  design.flight.horizontal_offset = 10;
  design.supply.voltage = 120;
  const double ample = optimize(design).area;
  // As much as a conductor a quarter thicker takes than the one that draws least.
  const OperatingPoint thicker = evaluate(design, 1.25 * ample, Condition::forward);
  design.tether.spooled_length = thicker.tether_length - design.tether.length;
  const Optimization thinnest = optimize(design);
  REQUIRE(thinnest.feasible);
  CHECK(thinnest.limited_by == Limit::tether_shape);
  CHECK(thinnest.limiting_condition == Condition::forward);
  CHECK(thinnest.area == Approx(1.25 * ample).epsilon(1e-3));
  CHECK(std::isnan(evaluate(design, 0.99 * thinnest.area, Condition::forward).tether_length));
  // Thinner ones leave more headroom than any that reaches.
  design.requirements.headroom_at = Condition::forward;
  design.requirements.thrust_headroom = 1.01 * best_headroom(design, Condition::forward).value;
  const Optimization refused = optimize(design);
  REQUIRE_FALSE(refused.feasible);
  design.tether.spooled_length = 0;
  REQUIRE(optimize(design).feasible);
  CHECK(refused.limited_by == Limit::tether_shape);
}

TEST_CASE("what misses its headroom for a converter's rating is told to miss the rating") {
  Design design = test::published_design();
  design.requirements.thrust_headroom = 1;
  for (const double rated : {310.0, 320.0, 330.0}) {
    INFO(rated << " W");
    design.supply.converter.rated_output_power = rated;
    const Optimization optimum = optimize(design);
    REQUIRE(optimum.feasible);
    CHECK(optimum.limited_by == Limit::converter_rating);
    for (const double more : {1.001, 1.01, 1.1, 1.2}) {
      const double area = more * optimum.area;
      const Margins margins = demand_margins(design, evaluate(design, area, Condition::hover),
                                             evaluate(design, area, Condition::forward));
      CHECK_FALSE(margins.met());
      CHECK(margins.worst().demand == Demand::converter_rating);
    }
  }
}
