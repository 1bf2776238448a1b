#include "tethercalc/solve/headroom.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"

using namespace tethercalc;

namespace {

constexpr double thinnest = 1e-10;  // m²
constexpr double thickest = 1e-2;

/// Area number `i` of `count`, evenly spread over the decades.
double grid_area(int i, int count) {
  return thinnest * std::pow(thickest / thinnest, i / (count - 1.0));
}

bool plainly_feasible(const test::plain::Point& point, double required) {
  return !point.tilts_too_far && point.headroom >= required;
}

/// True where rounding alone may decide whether `point` is feasible.
bool on_the_fence(const test::plain::Point& point, const Design& design, double required) {
  const double tilt = std::abs(point.pitch) / design.requirements.max_pitch;
  return std::abs(point.headroom / required - 1) < 1e-9 || std::abs(tilt - 1) < 1e-9;
}

}  // namespace

TEST_CASE("the feasible set is where a fine grid of plain evaluations has the headroom") {
  constexpr int grid = 1500;
  test::each_random(150, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const double required = random.uniform(0.5, 2.5);
    const IntervalSet set = headroom_areas(SteadyFlight(design, condition), required);
    int wrong = 0;
    for (int i = 0; i < grid; ++i) {
      const double area = grid_area(i, grid);
      const auto plain = test::plain::evaluate(design, area, condition);
      if (on_the_fence(plain, design, required)) continue;
      if (contains(set, area) != plainly_feasible(plain, required)) ++wrong;
    }
    CHECK(wrong == 0);
  });
}

TEST_CASE("at every edge of the feasible set the headroom or the tilt is at its limit") {
  test::each_random(1000, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const double required = random.uniform(0.5, 2.5);
    for (const Interval& range : headroom_areas(SteadyFlight(design, condition), required)) {
      CHECK(range.lo < range.hi);
      for (const double edge : {range.lo, range.hi}) {
        const auto plain = test::plain::evaluate(design, edge, condition);
        CHECK(on_the_fence(plain, design, required));
      }
      const auto inside = test::plain::evaluate(design, 0.5 * (range.lo + range.hi), condition);
      CHECK(plainly_feasible(inside, required));
    }
  });
}

TEST_CASE("the headroom passes what is required within 1e-11 of every edge") {
  constexpr double near = 1e-11;
  test::each_random(1000, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const double required = random.uniform(0.5, 2.5);
    const auto headroom = [&](double area) {
      return test::plain::evaluate(design, area, condition).headroom;
    };
    for (const Interval& range : headroom_areas(SteadyFlight(design, condition), required)) {
      // Where the curve only just touches what is required, rounding decides where.
      if (range.hi < 1.001 * range.lo) continue;
      for (const double edge : {range.lo, range.hi}) {
        const auto plain = test::plain::evaluate(design, edge, condition);
        const double tilt = std::abs(plain.pitch) / design.requirements.max_pitch;
        if (std::abs(tilt - 1) < 1e-9) continue;  // another limit's edge
        const double inwards = edge == range.lo ? near : -near;
        CHECK(headroom(edge * (1 + inwards)) >= required);
        CHECK(headroom(edge * (1 - inwards)) < required);
      }
    }
  });
}

TEST_CASE("no area of a fine grid has more than the best headroom") {
  constexpr int grid = 1500;
  test::each_random(150, [](test::Random& random) {
    const Design design = test::random_design(random);
    const Condition condition = random.chance(0.5) ? Condition::hover : Condition::forward;
    const BestHeadroom best = best_headroom(SteadyFlight(design, condition));
    double most = 0;
    for (int i = 0; i < grid; ++i) {
      const auto plain = test::plain::evaluate(design, grid_area(i, grid), condition);
      if (!plain.tilts_too_far) most = std::max(most, plain.headroom);
    }
    CHECK(best.value >= most * (1 - 1e-9));
    if (best.value > 0) {
      const auto there = test::plain::evaluate(design, best.area, condition);
      CHECK(there.headroom == Approx(best.value).epsilon(1e-9));
      CHECK(std::abs(there.pitch) <= design.requirements.max_pitch * (1 + 1e-9));
    } else {
      CHECK(std::isnan(best.area));
    }
  });
}

TEST_CASE("where the tilt limit keeps lighter tethers out, the best headroom is on it") {
  // The designs of examples/reference/tilt-hover.json and infeasible-tilt-hover.json. The expected
  // values are those of a script of its own with SciPy 1.10: brentq for the tilt at an area, and
  // for the area at which it is the limit; 40 000 areas around it, and 10 000 over five decades,
  // have no more headroom within the limit.
  Design design = test::published_design();
  design.flight.airspeed = 0;
  design.flight.air_density = 1.225;
  design.flight.headwind = 20;
  const BestHeadroom gale = best_headroom(SteadyFlight(design, Condition::hover));
  CHECK(gale.value == Approx(0.31990906511665107).epsilon(1e-12));
  CHECK(gale.area == Approx(51.62748335359504e-6).epsilon(1e-12));

  design.drone.mass = 1.4;
  design.tether.length = 10;
  design.supply.voltage = 30;
  design.flight.headwind = 8.4;
  design.requirements.max_pitch = 15 * test::plain::pi / 180;
  const BestHeadroom breeze = best_headroom(SteadyFlight(design, Condition::hover));
  CHECK(breeze.value == Approx(2.3765576065005103).epsilon(1e-12));
  CHECK(breeze.area == Approx(9.219650740662743e-6).epsilon(1e-12));
}

TEST_CASE("the headroom asked for is reachable exactly up to the best headroom") {
  test::each_random(500, [](test::Random& random) {
    const Design design = test::random_design(random);
    const SteadyFlight flight(design, random.chance(0.5) ? Condition::hover : Condition::forward);
    const double best = best_headroom(flight).value;
    if (best < 1e-3) return;
    CHECK(headroom_areas(flight, best * (1 + 1e-7)).empty());
    CHECK_FALSE(headroom_areas(flight, best * (1 - 1e-7)).empty());
  });
}

TEST_CASE("a wavy motor curve can leave several feasible ranges") {
  // Two flat steps: just past each, much thrust comes for little power.
  Design design = test::published_design();
  design.drone.motor =
      MotorCurve({{5.0, 50}, {8.4, 52}, {8.5, 130}, {9.6, 131}, {9.7, 260}, {12, 262}});
  design.supply.voltage = 60;
  const SteadyFlight flight(design, Condition::hover);
  bool several = false;
  for (double required = 1; required < 2.5 && !several; required += 0.01) {
    several = headroom_areas(flight, required).size() > 1;
  }
  CHECK(several);
}
