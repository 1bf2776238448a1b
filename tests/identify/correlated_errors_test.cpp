// Long-run covariance and effective sample size against processes whose values are known.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "identify/statistics.hpp"
#include "support/random.hpp"

using namespace tethercalc;

namespace {

std::vector<double> autoregression(double coefficient, std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(size);
  double value = normal(random) / std::sqrt(1 - coefficient * coefficient);
  for (double& element : x) element = value = coefficient * value + normal(random);
  return x;
}

}  // namespace

TEST_CASE("autocorrelation of a first-order autoregression falls geometrically") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  const auto x = autoregression(0.8, 100000, seed);
  CHECK(autocorrelation(x, 0) == Approx(1));
  CHECK(autocorrelation(x, 1) == Approx(0.8).margin(0.02));
  CHECK(autocorrelation(x, 3) == Approx(0.512).margin(0.03));
  CHECK(autocorrelation(std::vector<double>(10, 3.0), 1) == 0);
  CHECK(autocorrelation(std::vector<double>{1, 2}, 5) == 0);
}

TEST_CASE("effective samples of an autoregression are (1 − ρ)/(1 + ρ) of its samples") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  constexpr std::size_t size = 100000;
  for (double coefficient : {0.0, 0.5, 0.86, 0.97}) {
    const double expected = (1 - coefficient) / (1 + coefficient);
    const double share = effective_sample_size(autoregression(coefficient, size, seed)) / size;
    CHECK(share == Approx(expected).epsilon(0.25));
  }
  // Alternating noise is not counted as more than its samples.
  CHECK(effective_sample_size(autoregression(-0.9, size, seed)) == Approx(size).epsilon(0.01));
  CHECK(effective_sample_size(std::vector<double>(50, 1.0)) == 50);
  CHECK(effective_sample_size(std::vector<double>{}) == 0);
}

TEST_CASE("taking a series faster does not widen the bandwidth") {
  // 3,000 samples with ρ = 0.86 at 10 Hz, then at 100 Hz the same flight: ρ = 0.86^(1/10).
  const auto share = [](double rho) { return (1 - rho) / (1 + rho); };
  const auto slow = cosine_terms(3000, 3000 * share(0.86));
  const double fast_rho = std::pow(0.86, 0.1);
  const auto fast = cosine_terms(30000, 30000 * share(fast_rho));
  CHECK(static_cast<double>(fast) == Approx(static_cast<double>(slow)).margin(1));
  // The published rule where it was tuned, and where samples are independent.
  CHECK(cosine_terms(1000, 1000 * share(0.7)) == 40);
  CHECK(cosine_terms(1000, 1000) == 40);
  CHECK(cosine_terms(4, 1) == 1);
}

TEST_CASE("long-run variance of an autoregression is 1/(1 − ρ)²") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  constexpr std::size_t size = 50000;
  const auto x = autoregression(0.7, size, seed);
  const std::size_t terms = cosine_terms(size, size * 0.3 / 1.7);
  const double expected = 1 / (0.3 * 0.3);
  const double spread = std::sqrt(2.0 / static_cast<double>(terms));  // of χ²/ν
  CHECK(long_run_covariance(x, 1, terms)[0] == Approx(expected).epsilon(4 * spread + 0.02));
}

TEST_CASE("long-run covariance keeps the correlation of the columns and ignores their means") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  constexpr std::size_t size = 40000;
  const auto a = autoregression(0.5, size, seed);
  const auto b = autoregression(0.5, size, seed + 1);
  std::vector<double> rows;
  std::vector<double> moved;
  for (std::size_t i = 0; i < size; ++i) {
    rows.insert(rows.end(), {a[i], 0.6 * a[i] + 0.8 * b[i]});
    moved.insert(moved.end(), {a[i] + 100, 0.6 * a[i] + 0.8 * b[i] - 7});
  }
  const auto covariance = long_run_covariance(rows, 2, 400);
  CHECK(covariance[1] == covariance[2]);
  CHECK(covariance[1] / std::sqrt(covariance[0] * covariance[3]) == Approx(0.6).margin(0.15));
  const auto of_moved = long_run_covariance(moved, 2, 400);
  for (std::size_t i = 0; i < 4; ++i) CHECK(of_moved[i] == Approx(covariance[i]).epsilon(1e-5));
}
