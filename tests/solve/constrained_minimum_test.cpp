#include "tethercalc/solve/constrained_minimum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/steady_flight.hpp"

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
