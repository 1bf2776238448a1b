// Designs over the whole range of every field at once, held against areas tried one by one.

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;
using test::plain::infinity;

namespace {

/// The best of areas evenly spread over nine decades.
struct Tried {
  double power = infinity;        ///< W, the least of those that meet all demands
  double least_power = infinity;  ///< W, of all
  double headroom = 0;            ///< the most
  int other_headroom = 0;         ///< how many of them `areas` takes for what they are not
};

/// Of what lies on an edge, relative.
constexpr double rounding = 1e-7;
/// The load of a solved tether is cubics between solved radii, to 1e-5 of the cable's tension.
constexpr double solved_rounding = 1e-5;

Tried try_areas(const Design& design, const IntervalSet& areas, int count, double edge = rounding) {
  const auto beside = [edge](double value, double limit) {
    return std::abs(value / limit - 1) < edge;
  };
  const SteadyFlight hover(design, Condition::hover);
  const SteadyFlight forward(design, Condition::forward);
  const Requirements& need = design.requirements;
  Tried tried;
  for (int i = 0; i < count; ++i) {
    const double area = 1e-10 * std::pow(1e9, i / (count - 1.0));
    const OperatingPoint at_hover = evaluate(hover, area);
    const OperatingPoint at_forward = evaluate(forward, area);
    const bool priced_at_hover = need.power_at == Condition::hover;
    const double power = (priced_at_hover ? at_hover : at_forward).total_power;
    const OperatingPoint& judged = need.headroom_at == Condition::hover ? at_hover : at_forward;
    tried.least_power = std::fmin(tried.least_power, power);
    tried.headroom = std::fmax(tried.headroom, judged.headroom);
    const bool enough = judged.headroom >= need.thrust_headroom;
    const bool on_edge =
        beside(judged.headroom, need.thrust_headroom) ||
        beside(std::abs(judged.pitch), need.max_pitch) ||
        // Where a cable runs away, the headroom leaps.
        (is_heated(design.tether) && std::ranges::any_of(areas, [&](const Interval& range) {
           return beside(area, range.lo) || beside(area, range.hi);
         }));
    if (!on_edge && enough != contains(areas, area)) ++tried.other_headroom;
    if (power < tried.power && demand_margins(design, at_hover, at_forward).met()) {
      tried.power = power;
    }
  }
  return tried;
}

/// What `optimize` answers is held by the judge, and no area tried is better.
void check_answer(const Design& design, const Optimization& result, const Tried& tried,
                  double tolerance) {
  if (!result.feasible) {
    CHECK(tried.power == infinity);
    return;
  }
  const OperatingPoint hover = evaluate(design, result.area, Condition::hover);
  const OperatingPoint forward = evaluate(design, result.area, Condition::forward);
  CHECK(demand_margins(design, hover, forward).met());
  const bool at_hover = design.requirements.power_at == Condition::hover;
  CHECK((at_hover ? hover : forward).total_power <= tried.power * (1 + tolerance));
}

void check_against_areas(const Design& design, int count) {
  const Requirements& need = design.requirements;
  const Optimization result = optimize(design);
  const Tried tried = try_areas(design, result.headroom_areas, count);
  CHECK(tried.other_headroom == 0);
  const BestHeadroom best = best_headroom(design, need.headroom_at);
  // Less than a millionth of what is necessary counts as none.
  if (tried.headroom > 1e-6) CHECK(best.value >= tried.headroom * (1 - 1e-8));
  if (best.value > 0) {
    CHECK(evaluate(design, best.area, need.headroom_at).headroom == best.value);
  }
  if (tried.least_power < infinity) {
    CHECK(result.minimum_power.power <= tried.least_power * (1 + rounding));
  }
  // What lies on an edge is met to 1e-9, and areas beyond the edge by as much are cheaper. Without
  // drag but from above the power has a kink where the tilt ends, by the root of such a rounding.
  check_answer(design, result, tried, rounding);
}

void check_solved_against_areas(const Design& design, int count, double least_compared = 1e-6) {
  const Requirements& need = design.requirements;
  const Optimization result = optimize(design);
  const Tried tried = try_areas(design, result.headroom_areas, count, solved_rounding);
  CHECK(tried.other_headroom == 0);
  if (tried.headroom > least_compared) {
    CHECK(best_headroom(design, need.headroom_at).value >= tried.headroom * (1 - solved_rounding));
  }
  check_answer(design, result, tried, solved_rounding);
}

/// As many as the environment asks for, as once before a release, or as usual.
int asked_or(const char* variable, int usual) {
  const char* asked = std::getenv(variable);
  return asked ? std::atoi(asked) : usual;
}

}  // namespace

TEST_CASE("no area is better than the optimum of any design that a spec can say") {
  const int areas = asked_or("TETHERCALC_EXTREME_AREAS", 300);
  test::each_random(asked_or("TETHERCALC_EXTREME_DESIGNS", test::draws(300)),
                    [areas](test::Random& random) {
                      check_against_areas(test::random_whole_range_design(random), areas);
                    });
}

TEST_CASE(
    "cables on the brink of running away, and batteries that leap, are searched up to there") {
  for (const unsigned seed :
       {6981U, 7093U, 7717U, 9431U, 200613U, 200988U, 409736U, 1007981U, 418539U, 433277U, 1017363U,
        1019396U, 1027544U, 5015893U, 16716488U}) {
    INFO(seed);
    test::Random random(seed);
    check_against_areas(test::random_extreme_design(random), 3000);
  }
}

TEST_CASE(
    "rotors that lean, converters at their rating and cables in the sun are searched to the end") {
  for (const unsigned seed :
       {2107U, 113457U, 121878U, 143770U, 146809U, 154385U, 159763U, 170173U, 204501U, 239489U,
        245060U, 292962U, 444389U, 453646U, 658126U, 864107U}) {
    INFO(seed);
    test::Random random(seed);
    check_against_areas(test::random_extreme_design(random), 3000);
  }
}

TEST_CASE("where the least power lies on the brink of running away, the brink is the optimum") {
  // The searches for the least power and for the feasible areas find this brink 4e-10 apart.
  test::Random random(704741376U);
  Design design = test::random_extreme_design(random);
  design.drone.motor_air_density = 0.098951479811641596;
  design.drone.translational_lift.hover_induced_speed = 95.126533483700129;
  design.supply.converter.losses.square = 9.6489837440037004e-06;
  check_against_areas(design, 3000);
}

TEST_CASE("a short tether behind a resistive slip ring is given the area that draws least") {
  test::each_random(test::draws(300), [](test::Random& random) {
    Design design = test::published_design();
    design.tether.length = random.uniform(0.5, 6);
    design.tether.contact_resistance = random.magnitude(0.3, 3);
    design.supply.voltage = random.uniform(24, 75);
    design.requirements.thrust_headroom = random.uniform(1, 1.6);
    design.requirements.headroom_at = random.chance(0.5) ? Condition::hover : Condition::forward;
    if (random.chance(0.5)) design.drone.motor = test::random_jagged_motor(random, 14);
    check_against_areas(design, 1000);
  });
}

TEST_CASE("a drone without any drag but from above is optimised in a counted number of steps") {
  test::each_random(test::draws(300), [](test::Random& random) {
    Design design = test::published_design();
    design.drone.drag = {0, random.uniform(0.001, 0.3), 0, 0};
    design.tether.projection_factor = 0;
    design.flight.airspeed = random.uniform(10, 100);
    design.supply.converter.efficiency = {{50, 0.8}, {150, 0.9}, {400, 0.93}, {800, 0.92}};
    design.requirements.max_pitch = random.uniform(20, 89) * unit::degree;
    check_against_areas(design, 300);
  });
}

TEST_CASE("no area is better than the optimum on a solved tether") {
  const int designs = asked_or("TETHERCALC_EXTREME_DESIGNS", test::draws(40));
  test::each_random(designs, [](test::Random& random) {
    check_solved_against_areas(test::random_hanging_design(random), 100);
  });
}

TEST_CASE("of the conductors that a winch holds up, which may be a few, none is better") {
  const int designs = asked_or("TETHERCALC_EXTREME_DESIGNS", test::draws(40));
  test::each_random(designs, [](test::Random& random) {
    Design design = test::published_design();
    Tether& tether = design.tether;
    tether.model = TetherModel::solved;
    tether.length = random.uniform(10, 80);
    const bool aside = random.chance(0.5);
    // Weaker ones hold aside, in a wind, conductors of sizes closer than they are looked for.
    tether.winch_pull = random.magnitude(aside ? 1 : 0.05, 10);
    if (random.chance(0.3)) tether.spooled_length = random.magnitude(0.1, 100);
    if (random.chance(0.3)) tether.ambient_temperature_C = random.uniform(-20, 50);
    design.supply.voltage = random.uniform(60, 300);
    design.flight.airspeed = random.uniform(0, 12);
    design.flight.headwind = random.uniform(0, 10);
    if (aside) design.flight.horizontal_offset = tether.length * random.uniform(0, 1);
    design.requirements.thrust_headroom = random.uniform(1, 1.6);
    // Aside, a fifth of the thrust that it takes is far from flying, and its cables may be of a few
    // sizes that nothing but the wind holds up: of 1000 such designs one has a tenth of it at 150
    // mm² only.
    check_solved_against_areas(design, 150, aside ? 0.2 : 0.1);
  });
}

TEST_CASE("a drone that hardly lifts its hanging cable is given the area that draws least") {
  test::each_random(test::draws(60), [](test::Random& random) {
    Design design = test::published_design();
    design.tether.model = TetherModel::solved;
    design.tether.slack = random.uniform(0.01, 0.2);
    design.tether.length = random.uniform(20, 60);
    if (random.chance(0.5)) design.tether.conductor.density = 8960;
    design.supply.voltage = random.uniform(40, 90);
    design.requirements.thrust_headroom = random.uniform(1, 1.6);
    design.flight.airspeed = random.uniform(0, 8);
    if (random.chance(0.5)) design.supply.converter.rated_output_power = random.uniform(300, 800);
    check_solved_against_areas(design, 300);
  });
}

TEST_CASE("no area is better than the optimum where the drum and the bench are described") {
  test::each_random(test::draws(200), [](test::Random& random) {
    Design design = test::random_extreme_design(random);
    design.drone.motor_air_density = design.flight.air_density * random.uniform(0.6, 1.6);
    design.tether.ambient_temperature_C = random.uniform(-20, 50);
    design.tether.spooled_length = random.magnitude(0.1, 1000);
    design.tether.drum.core_diameter = random.magnitude(0.02, 1);
    design.tether.drum.width = random.magnitude(0.02, 1);
    if (random.chance(0.5)) design.tether.inclination = random.uniform(0, 90) * unit::degree;
    check_against_areas(design, 300);
  });
}
