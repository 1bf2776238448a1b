#include "tethercalc/solve/constrained_minimum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/design_search.hpp"

using namespace tethercalc;

namespace {

/// A problem with kinks, several valleys and a curved edge, all from one seed.
MinimumProblem random_problem(unsigned seed) {
  test::Random random(seed);
  const double a = random.uniform(0.2, 0.8), b = random.uniform(0.2, 0.8);
  const double wave = random.uniform(0, 0.1), period = random.uniform(3, 12);
  const double kink = random.uniform(0, 2), edge = random.uniform(0.3, 1.2);
  const double tilt = random.uniform(-1, 1);
  MinimumProblem problem;
  problem.variables = {{0, 1}, {0, 1}};
  problem.constraint_count = 1;
  problem.evaluate = [=](std::span<const double> x, std::span<double> c) {
    c[0] = edge - x[0] - x[1] * x[1];
    return 5 + (x[0] - a) * (x[0] - a) + kink * std::abs(x[1] - b) + tilt * x[0] +
           wave * std::sin(period * x[0]) * std::cos(period * x[1]);
  };
  return problem;
}

}  // namespace

TEST_CASE("no point of a grid of a million is better, whatever the seed") {
  for (unsigned i = 0; i < 30; ++i) {
    const unsigned seed = test::run_seed() + i;
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    const MinimumProblem problem = random_problem(seed);
    const Minimum found = constrained_minimum(problem);
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 1000; ++k) {
      for (int l = 0; l < 1000; ++l) {
        const double x[] = {k / 999.0, l / 999.0};
        double c[1];
        const double value = problem.evaluate(x, c);
        if (c[0] <= 0) best = std::min(best, value);
      }
    }
    CHECK(found.value <= best + 1e-9);
    std::vector<double> c(1);
    CHECK(problem.evaluate(found.x, c) == found.value);
    CHECK(c[0] <= constraint_tolerance);
    MinimumOptions other;
    other.seed = seed;
    CHECK(constrained_minimum(problem, other).value == Approx(found.value).epsilon(1e-8));
  }
}

TEST_CASE("a deeper valley along the edge is found, though the best points lie in another") {
  // The least values of grids of 4001 × 4001 points.
  const std::pair<unsigned, double> hard[] = {
      {3011597917U, 5.4330111788}, {3014821544U, 5.4568328802}, {3434242193U, 5.8595913305}};
  for (const auto& [problem_seed, least] : hard) {
    MinimumOptions options;
    for (options.seed = 1; options.seed <= 10; ++options.seed) {
      CHECK(constrained_minimum(random_problem(problem_seed), options).value <= least);
    }
  }
}

TEST_CASE("what is not finite is never an answer, and never hangs the search") {
  MinimumProblem problem;
  problem.variables = {{-1, 1}, {0.01, 100}};
  problem.constraint_count = 1;
  problem.evaluate = [](std::span<const double> x, std::span<double> c) {
    c[0] = x[0] > 0.9 ? std::nan("") : -1;
    return std::sqrt(x[0]) + std::log(x[1]) * std::log(x[1]);  // undefined below 0
  };
  const Minimum found = constrained_minimum(problem);
  CHECK(found.value == Approx(0).margin(1e-5));
  CHECK(found.x[1] == Approx(1).epsilon(1e-4));

  problem.evaluate = [](std::span<const double>, std::span<double> c) {
    c[0] = -1;
    return std::nan("");
  };
  CHECK(constrained_minimum(problem).outcome == MinimumOutcome::undefined);
  problem.variables[0].hi = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(constrained_minimum(problem), std::invalid_argument);
}

TEST_CASE("an infeasible problem ends at its least violated point") {
  MinimumProblem problem;
  problem.variables = {{0, 1}};
  problem.constraint_count = 2;
  problem.evaluate = [](std::span<const double> x, std::span<double> c) {
    c[0] = x[0] - 0.2;  // at most 0.2
    c[1] = 0.6 - x[0];  // at least 0.6: the least violation is 0.2, at 0.4
    return x[0];
  };
  const Minimum found = constrained_minimum(problem);
  CHECK(found.outcome == MinimumOutcome::infeasible);
  CHECK(found.violation == Approx(0.2).margin(0.02));
}

TEST_CASE("the cross-section of least power is the one on paper") {
  // A motor with P = e·T, a lossless converter, no insulation, drag or auxiliary power, and a load
  // small against what the line delivers are not needed: with m(A) = 2hρ_cA and R = 2hρ/A,
  // P_drone = e·g·(m_d + 2hρ_cA) = a + bA and U·I = P_drone + I²R. At the least U·I = y the
  // envelope theorem gives b = (y/U)²·2hρ/A², so A = (y/U)·q with q = √(2hρ/b); and from y = a + bA
  // + (y/U)²·2hρ/A, with 2hρ = b·q², y = a + b·q·y/U + b·q·y/U, hence y = a/(1 − 2bq/U) and A =
  // q·y/U.
  for (const double voltage : {60.0, 120.0, 400.0}) {
    Design design;
    const double slope = 12.0;  // W/N
    design.drone.mass = 1.5;
    design.drone.motor = MotorCurve({{10, 10 * slope}, {100, 100 * slope}});
    design.tether.length = 50;
    design.tether.conductor = {0.0178e-6, 0, 8900, 0};
    design.supply.voltage = voltage;
    design.supply.converter.efficiency = {{0, 1.0}};
    const double a = slope * standard_gravity * 1.5;
    const double b = slope * standard_gravity * 2 * 50 * 8900;
    const double q = std::sqrt(2 * 50 * 0.0178e-6 / b);
    const double power = a / (1 - 2 * b * q / voltage);
    const double area = q * power / voltage;
    DesignProblem problem;
    problem.base = design;
    problem.base.requirements.buffer_battery = true;
    problem.ranges.push_back(
        {"area", {0.05e-6, 20e-6}, [](Design& d, double x) { d.tether.cross_section = x; }});
    problem.objective = [](const Candidate& c) { return c.hover.total_power; };
    const DesignAnswer answer = search_design(problem);
    REQUIRE(answer.feasible);
    CHECK(answer.best.hover.total_power == Approx(power).epsilon(1e-8));
    // The power is flat there: its minimum to 1e-15 fixes the place to the root of that.
    CHECK(answer.best.area == Approx(area).epsilon(1e-6));
    // The exact search finds the place as well.
    problem.ranges.clear();
    CHECK(search_design(problem).best.area == Approx(area).epsilon(1e-8));
  }
}

TEST_CASE("a design search is never worse than brute force over its fields") {
  for (unsigned i = 0; i < 30; ++i) {
    test::Random random(test::run_seed() + i);
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    DesignProblem problem;
    problem.base = test::random_design(random);
    problem.base.supply.converter.min_input_voltage = 0;
    problem.ranges.push_back(
        {"voltage", {20, 400}, [](Design& d, double x) { d.supply.voltage = x; }});
    problem.ranges.push_back(
        {"area", {0.1e-6, 10e-6}, [](Design& d, double x) { d.tether.cross_section = x; }});
    problem.objective = [](const Candidate& c) { return c.forward.total_power; };
    const double most = random.uniform(30, 400);
    problem.limits.push_back(
        {"voltage", [](const Candidate& c) { return c.design.supply.voltage; }, most, 1});
    const DesignAnswer answer = search_design(problem);
    for (const DemandState& state : demand_states(answer.best, problem.limits)) {
      if (answer.feasible) CHECK(state.violation <= constraint_tolerance);
    }
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 1000; ++k) {
      Design design = problem.base;
      design.supply.voltage = 20 + 380 * k / 999.0;
      if (design.supply.voltage > most) break;
      const SteadyFlight hover(design, Condition::hover), forward(design, Condition::forward);
      for (int l = 0; l < 1000; ++l) {
        const double area = 0.1e-6 * std::pow(100, l / 999.0);
        const OperatingPoint f = evaluate(forward, area);
        if (!(f.total_power < best) || !(f.headroom >= 1)) continue;
        const OperatingPoint h = evaluate(hover, area);
        const Requirements& need = design.requirements;
        const OperatingPoint& judged = need.headroom_at == Condition::hover ? h : f;
        const bool met = (h.headroom >= 1) && (f.headroom >= 1) &&
                         (need.buffer_battery || judged.headroom >= need.thrust_headroom);
        if (met && f.total_power < best) best = f.total_power;
      }
    }
    if (best < std::numeric_limits<double>::infinity()) {
      CHECK(answer.feasible);
      CHECK(answer.best.forward.total_power <= best * (1 + 1e-9));
    }
  }
}
