#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/solve/sensitivity.hpp"
#include "tethercalc/solve/spread.hpp"
#include "tethercalc/solve/unit_points.hpp"

using namespace tethercalc;
using namespace tethercalc::test;

namespace {

constexpr double pi = std::numbers::pi;

/// Ishigami and Homma (1990), with the usual a = 7, b = 0.1; inputs uniform in (−π, π).
constexpr double ishigami_a = 7;
constexpr double ishigami_b = 0.1;
double ishigami(const std::array<double, 3>& x) {
  return std::sin(x[0]) + ishigami_a * std::pow(std::sin(x[1]), 2) +
         ishigami_b * std::pow(x[2], 4) * std::sin(x[0]);
}

struct KnownIndices {
  std::array<double, 3> first_order;
  std::array<double, 3> total;
};

/// From the function's variance decomposition, integrated by hand (Saltelli et al. 2008, Global
/// Sensitivity Analysis, section 5.8).
KnownIndices known_indices() {
  const double pi4 = std::pow(pi, 4);
  const double v1 = 0.5 * std::pow(1 + ishigami_b * pi4 / 5, 2);
  const double v2 = ishigami_a * ishigami_a / 8;
  const double v13 = ishigami_b * ishigami_b * pi4 * pi4 * (1.0 / 18 - 1.0 / 50);
  const double v = v1 + v2 + v13;
  return {{v1 / v, v2 / v, 0}, {(v1 + v13) / v, v2 / v, v13 / v}};
}

template <class Function>
SensitivitySample sample_of(const Function& function, const SamplePlan& plan) {
  SensitivitySample sample{{}, {}, std::vector<std::vector<double>>(3)};
  UnitPoints points(plan, 6);
  std::array<double, 6> unit{};
  const auto scaled = [](double u) { return (2 * u - 1) * pi; };
  for (std::uint64_t j = 0; j < plan.count; ++j) {
    points.at(j, unit);
    std::array<double, 3> a{};
    std::array<double, 3> b{};
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = scaled(unit[i]);
      b[i] = scaled(unit[i + 3]);
    }
    sample.a.push_back(function(a));
    sample.b.push_back(function(b));
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> mixed = a;
      mixed[i] = b[i];
      sample.mixed[i].push_back(function(mixed));
    }
  }
  return sample;
}

}  // namespace

TEST_CASE("Sobol indices of the Ishigami function are the known ones") {
  const KnownIndices known = known_indices();
  CHECK(known.first_order[0] == Approx(0.3139).margin(5e-5));  // as printed by Saltelli et al.
  CHECK(known.total[2] == Approx(0.2437).margin(5e-5));
  for (const SampleMethod method : {SampleMethod::sobol, SampleMethod::latin_hypercube}) {
    const auto indices = sobol_indices(sample_of(ishigami, {1 << 16, method, run_seed()}));
    REQUIRE(indices.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      // Five standard errors: chance passes it once in 1e6 times.
      const Sensitivity& s = indices[i];
      CHECK(s.first_order.standard_error < 0.01);
      CHECK(s.total.standard_error < 0.01);
      CHECK(std::abs(s.first_order.value - known.first_order[i]) <=
            5 * s.first_order.standard_error);
      CHECK(std::abs(s.total.value - known.total[i]) <= 5 * s.total.standard_error);
    }
  }
}

TEST_CASE("standard errors of Sobol indices are neither too small nor wildly large") {
  const KnownIndices known = known_indices();
  int inside = 0;
  int all = 0;
  double squares = 0;
  for (std::uint64_t repetition = 0; repetition < 60; ++repetition) {
    // A Latin hypercube in two halves is close to chance for this function, which the bootstrap
    // assumes.
    const SamplePlan plan{1000, SampleMethod::latin_hypercube, run_seed() + repetition};
    const auto indices = sobol_indices(sample_of(ishigami, plan), repetition);
    for (std::size_t i = 0; i < 3; ++i) {
      for (const double z :
           {(indices[i].first_order.value - known.first_order[i]) /
                indices[i].first_order.standard_error,
            (indices[i].total.value - known.total[i]) / indices[i].total.standard_error}) {
        ++all;
        inside += std::abs(z) <= 1.96 ? 1 : 0;
        squares += z * z;
      }
    }
  }
  // 95 % nominal of 360 correlated cases, some of them stratified: leave room on both sides.
  CHECK(inside >= 0.88 * all);
  CHECK(std::sqrt(squares / all) > 0.3);
}

TEST_CASE("an offset of the output does not drown its indices") {
  const SamplePlan plan{4096, SampleMethod::sobol, run_seed()};
  const auto plain = sobol_indices(sample_of(ishigami, plan));
  const auto offset = sobol_indices(
      sample_of([](const std::array<double, 3>& x) { return ishigami(x) + 1e6; }, plan));
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(offset[i].first_order.value == Approx(plain[i].first_order.value).margin(1e-6));
    CHECK(offset[i].first_order.standard_error ==
          Approx(plain[i].first_order.standard_error).margin(1e-6));
  }
}

TEST_CASE("fewer than 30 points have no indices") {
  const auto few = sobol_indices(sample_of(ishigami, {16, SampleMethod::sobol, run_seed()}));
  for (const Sensitivity& s : few) CHECK(std::isnan(s.first_order.value + s.total.value));
}

TEST_CASE("inputs that an output does not see have no share, and a constant has no indices") {
  const SamplePlan plan{1024, SampleMethod::sobol, run_seed()};
  const auto one_input =
      sobol_indices(sample_of([](const std::array<double, 3>& x) { return x[1]; }, plan));
  CHECK(one_input[0].total.value == 0);
  CHECK(one_input[1].first_order.value == Approx(1).margin(0.05));
  const auto constant =
      sobol_indices(sample_of([](const std::array<double, 3>&) { return 3.0; }, plan));
  CHECK(std::isnan(constant[0].first_order.value));
  CHECK(std::isnan(constant[0].total.standard_error));
}

TEST_CASE("outputs that do not exist are left out") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SamplePlan plan{8192, SampleMethod::sobol, run_seed()};
  // x₀ > 0 does not exist; among the rest x₁ still rules alone.
  const auto indices = sobol_indices(
      sample_of([nan](const std::array<double, 3>& x) { return x[0] > 0 ? nan : x[1]; }, plan));
  CHECK(indices[1].total.value == Approx(1).margin(0.1));
  const auto none =
      sobol_indices(sample_of([nan](const std::array<double, 3>&) { return nan; }, plan));
  CHECK(std::isnan(none[0].total.value));
  CHECK_THROWS_AS(sobol_indices({{1, 2}, {1}, {{1, 2}}}), std::invalid_argument);
}

TEST_CASE("a histogram's quantiles are those of the sorted numbers") {
  each_random(20, [&](Random& random) {
    Spread histogram;
    std::vector<double> sorted;
    const double spread = random.magnitude(1.001, 1e6);
    const int count = random.integer(1, 5000);
    for (int i = 0; i < count; ++i) {
      sorted.push_back(random.magnitude(1, spread) * 1e-6);
      histogram.add(sorted.back());
    }
    std::sort(sorted.begin(), sorted.end());
    CHECK(histogram.count() == sorted.size());
    CHECK(histogram.quantile(0) == sorted.front());
    CHECK(histogram.quantile(1) == sorted.back());
    for (int i = 0; i < 20; ++i) {
      const double p = random.uniform(0, 1);
      const auto rank = static_cast<std::size_t>(std::ceil(p * count));
      const double exact = sorted[std::max<std::size_t>(rank, 1) - 1];
      CHECK(histogram.quantile(p) == Approx(exact).epsilon(1.01e-5));
    }
  });
  CHECK(std::isnan(Spread().quantile(0.5)));
  CHECK_THROWS_AS(Spread().add(0), std::invalid_argument);
  CHECK_THROWS_AS(Spread().add(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}
