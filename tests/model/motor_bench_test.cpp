#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/model/motor_curve.hpp"

using namespace tethercalc;

namespace {

/// Isotonic regression by its min-max formula (Barlow, Bartholomew, Bremner and Brunk 1972, Theorem
/// 1.4), slow and free of pooling: at i, the largest over a ≤ i of the smallest over b ≥ i of the
/// mean of a…b. `powers` by rising thrust.
std::vector<double> by_min_max(const std::vector<double>& powers) {
  std::vector<double> fitted;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    double highest = 0;
    for (std::size_t a = 0; a <= i; ++a) {
      double lowest = std::numeric_limits<double>::infinity();
      for (std::size_t b = i; b < powers.size(); ++b) {
        double sum = 0;
        for (std::size_t j = a; j <= b; ++j) sum += powers[j];
        lowest = std::min(lowest, sum / static_cast<double>(b - a + 1));
      }
      highest = std::max(highest, lowest);
    }
    fitted.push_back(highest);
  }
  return fitted;
}

}  // namespace

TEST_CASE("points that rise are kept to the last digit, in whatever order they come") {
  const std::vector<MotorPoint> points{{3.3, 40.1}, {1.1, 10.7}, {2.2, 22.3}};
  const IsotonicMotorPoints result = isotonic_motor_points(points);
  CHECK(result.pooled.empty());
  REQUIRE(result.points.size() == 3);
  CHECK(result.points[0].thrust == 1.1);
  CHECK(result.points[1].power == 22.3);
  CHECK(result.points[2].thrust == 3.3);
}

TEST_CASE("a falling pair becomes one point at its mean, and so does a pair of equal thrust") {
  const std::vector<MotorPoint> points{{1, 10}, {2, 30}, {3, 20}, {4, 40}, {4, 50}};
  const IsotonicMotorPoints result = isotonic_motor_points(points);
  REQUIRE(result.points.size() == 3);
  CHECK(result.points[1].thrust == 2.5);
  CHECK(result.points[1].power == 25);
  CHECK(result.points[2].thrust == 4);
  CHECK(result.points[2].power == 45);
  REQUIRE(result.pooled.size() == 2);
  CHECK(result.pooled[0].members == std::vector<std::size_t>{1, 2});
  CHECK(result.pooled[1].members == std::vector<std::size_t>{3, 4});
}

TEST_CASE("pooling is the isotonic regression, checked by the min-max formula") {
  std::mt19937 random(test::run_seed());
  std::uniform_real_distribution<double> noise(-30, 30);
  for (int run = 0; run < 50; ++run) {
    std::vector<MotorPoint> points;
    std::vector<double> powers;
    for (int i = 0; i < 20; ++i) {
      powers.push_back(40 + 5 * i + noise(random));
      points.push_back({1.0 + i, powers.back()});
    }
    const std::vector<double> expected = by_min_max(powers);
    const IsotonicMotorPoints result = isotonic_motor_points(points);
    std::vector<double> fitted(powers);
    for (const PooledMotorPoints& pool : result.pooled) {
      for (const std::size_t i : pool.members) fitted[i] = pool.mean.power;
    }
    for (std::size_t i = 0; i < powers.size(); ++i) {
      CHECK(fitted[i] == Approx(expected[i]).epsilon(1e-12));
    }
    CHECK_NOTHROW(MotorCurve(result.points));
  }
}

TEST_CASE("points without thrust or power are refused") {
  const double bad = GENERATE(0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity());
  CHECK_THROWS_AS(isotonic_motor_points(std::vector<MotorPoint>{{bad, 1}}), std::invalid_argument);
  CHECK_THROWS_AS(isotonic_motor_points(std::vector<MotorPoint>{{1, bad}}), std::invalid_argument);
}
