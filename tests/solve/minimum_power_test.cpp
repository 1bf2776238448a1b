#include "tethercalc/solve/minimum_power.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/operating_point.hpp"

using namespace tethercalc;

namespace {

double plain_power(const Design& design, double area, Condition condition) {
  const auto plain = test::plain::evaluate(design, area, condition);
  return plain.tilts_too_far ? test::plain::infinity : plain.total_power;
}

/// Least plain power over `count` areas in `range`, evenly spread over the decades.
double least_on_grid(const Design& design, Condition condition, Interval range, int count) {
  double least = test::plain::infinity;
  for (int i = 0; i < count; ++i) {
    const double area = range.lo * std::pow(range.hi / range.lo, i / (count - 1.0));
    least = std::min(least, plain_power(design, area, condition));
  }
  return least;
}

/// `claimed` is at its area what it says, and no worse than `least`.
void check_minimum(const Design& design, Condition condition, const MinimumPower& claimed,
                   double least) {
  if (std::isnan(claimed.power)) {
    CHECK(least == test::plain::infinity);
    return;
  }
  CHECK(claimed.power <= least * (1 + 1e-9));
  // An area on the tilt limit or at the motors' last thrust is beyond it by rounding.
  Design relaxed = design;
  relaxed.requirements.max_pitch *= 1 + 1e-9;
  const double nudged = claimed.area * (1 - 1e-9);
  const double there = plain_power(relaxed, claimed.area, condition);
  const double beside = plain_power(relaxed, nudged, condition);
  CHECK(claimed.power == Approx(std::min(there, beside)).epsilon(1e-7));
}

}  // namespace

TEST_CASE("no area of a fine grid needs less than the minimum power") {
  test::each_random(150, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const double least = least_on_grid(design, condition, {1e-10, 1e-2}, 1500);
    check_minimum(design, condition, minimum_power(SteadyFlight(design, condition)), least);
  });
}

TEST_CASE("no area of a fine grid inside a range needs less than the minimum power there") {
  test::each_random(300, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const SteadyFlight flight(design, condition);
    const MinimumPower whole = minimum_power(flight);
    const double around = std::isnan(whole.area) ? 1e-6 : whole.area;
    Interval range;
    range.lo = around * random.magnitude(0.05, 5);
    range.hi = range.lo * random.magnitude(1.01, 20);
    const MinimumPower found = minimum_power(flight, range);
    if (!std::isnan(found.area)) {
      CHECK(found.area >= range.lo * (1 - 1e-12));
      CHECK(found.area <= range.hi * (1 + 1e-12));
    }
    check_minimum(design, condition, found, least_on_grid(design, condition, range, 300));
  });
}

TEST_CASE("more voltage never needs more power") {
  test::each_random(500, [](test::Random& random) {
    Design design = test::random_design(random);
    const MinimumPower low = minimum_power(SteadyFlight(design, Condition::forward));
    design.supply.voltage *= random.uniform(1, 3);
    const MinimumPower high = minimum_power(SteadyFlight(design, Condition::forward));
    if (!std::isnan(low.power)) CHECK(high.power <= low.power * (1 + 1e-12));
  });
}

TEST_CASE("the minimum power lies on a kink of a motor curve that has one there") {
  // Prohibitive above 5.6 N: the line becomes as thick as that allows, about 570 g.
  Design design = test::published_design();
  design.drone.motor = MotorCurve({{5.5, 70}, {5.6, 71}, {13, 900}});
  design.supply.voltage = 55;
  const SteadyFlight flight(design, Condition::hover);
  const MinimumPower found = minimum_power(flight);
  REQUIRE_FALSE(std::isnan(found.area));
  CHECK(evaluate(flight, found.area).necessary_thrust == Approx(5.6).epsilon(1e-12));
}

TEST_CASE("the minimum power lies where a drone of no frontal area comes upright") {
  // Its drag grows with the sine of the tilt, so that a thrust T of all motors with T·sin θ =
  // q·A_t·sin θ holds it at any weight below q·A_t, and the weight itself above.
  Design design = test::published_design();
  design.tether.projection_factor = 0;
  AirframeDrag& drag = design.drone.drag;
  drag.front_area = 0;
  drag.linear_speed = 0;
  const double hover = minimum_power(SteadyFlight(design, Condition::hover)).area;
  const double weight = 1.2 * evaluate(SteadyFlight(design, Condition::hover), hover).takeoff_mass *
                        design.flight.gravity;
  const double speed = design.flight.airspeed;
  drag.top_area = weight / (0.5 * design.flight.air_density * speed * speed);
  const SteadyFlight flight(design, Condition::forward);
  const MinimumPower found = minimum_power(flight);
  REQUIRE_FALSE(std::isnan(found.area));
  CHECK(evaluate(flight, found.area).takeoff_mass * design.flight.gravity ==
        Approx(weight).epsilon(1e-12));
}
