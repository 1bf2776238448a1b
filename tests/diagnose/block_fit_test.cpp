#include "diagnose/block_fit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tethercalc;

namespace {

constexpr std::size_t rows = 1200;

/// y = a·exp(−b·t) + c·sin(d·t), with noise and a few readings far off; d kept above a bound that
/// the data pulls it against.
SelectionProblem bent_model(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SelectionProblem problem;
  std::vector<double> time;
  for (std::size_t i = 0; i < rows; ++i) {
    time.push_back(10 * static_cast<double>(i) / rows);
    problem.measured.push_back(3 * std::exp(-0.4 * time[i]) + 0.8 * std::sin(1.3 * time[i]) +
                               0.3 * normal(random) + (i % 50 == 7 ? 4 : 0));
    problem.block.push_back(static_cast<int>(20 * i / rows));
  }
  problem.noise.assign(rows, 0.3);
  problem.predict = [time](std::span<const double> p, std::span<double> out) {
    for (std::size_t i = 0; i < rows; ++i) {
      out[i] = p[0] * std::exp(-p[1] * time[i]) + p[2] * std::sin(p[3] * time[i]);
    }
  };
  const auto parameter = [](double start, double lower) {
    return ModelParameter{
        .neutral = start, .lower = lower, .upper = 10, .scale = 1, .start = start};
  };
  problem.groups = {
      {.id = "decay", .fitted = true, .parameters = {parameter(2, 0), parameter(0.5, 0)}},
      {.id = "wave", .fitted = true, .parameters = {parameter(0.5, 0), parameter(1.35, 1.32)}}};
  return problem;
}

/// y = a·(x·|x| + j·x) of a drag that is all linear: the ratio j runs to its upper end, along a
/// valley in which a falls as j rises.
SelectionProblem linear_drag(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SelectionProblem problem;
  std::vector<double> speed;
  for (std::size_t i = 0; i < rows; ++i) {
    speed.push_back(6 * std::sin(0.07 * static_cast<double>(i)));
    problem.measured.push_back(0.3 * speed[i] - 0.004 * speed[i] * std::abs(speed[i]) +
                               0.2 * normal(random));
    problem.block.push_back(static_cast<int>(8 * i / rows));
  }
  problem.noise.assign(rows, 0.2);
  problem.predict = [speed](std::span<const double> p, std::span<double> out) {
    for (std::size_t i = 0; i < rows; ++i) {
      out[i] = p[0] * (speed[i] * std::abs(speed[i]) + p[1] * speed[i]);
    }
  };
  const ModelParameter area{.upper = 10, .scale = 5e-3, .start = 0.015};
  const ModelParameter ratio{.upper = 1000, .scale = 5, .product_with = 0};
  problem.groups = {{.id = "drag", .fitted = true, .parameters = {area, ratio}}};
  return problem;
}

}  // namespace

TEST_CASE("what a fit holds at a bound does not hang on the last digits of where it began") {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const SelectionProblem problem = linear_drag(seed);
    const Record record(problem);
    const Freed all{{0}, {}};
    const BlockFit first = fit_blocks(record, all, nullptr);
    REQUIRE(first.values[1] == Approx(1000).epsilon(1e-2));
    CHECK(first.active == std::vector<std::size_t>{0});
    std::mt19937_64 random(seed + 200);
    std::uniform_real_distribution<double> off(-1e-3, 1e-3);
    for (int k = 0; k < 20; ++k) {
      BlockFit start = first;
      start.values[0] *= 1 + off(random);
      start.values[1] = std::min(1000.0, start.values[1] * (1 + off(random)));
      const BlockFit second = fit_blocks(record, all, &start);
      CHECK(second.active == first.active);
      CHECK(second.squared_error() == Approx(first.squared_error()).epsilon(1e-5));
    }
  }
}

TEST_CASE("a fit that is reported is the same to twelve digits wherever it started") {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const SelectionProblem problem = bent_model(seed);
    const Record record(problem);
    const Freed all{{0, 1}, {}};
    const BlockFit first = fit_blocks(record, all, nullptr, FitUse::report);
    BlockFit start = first;
    std::mt19937_64 random(seed + 100);
    std::uniform_real_distribution<double> off(-0.03, 0.03);
    for (double& value : start.values) value += off(random);
    start.values[3] = std::max(start.values[3], 1.32);
    const BlockFit second = fit_blocks(record, all, &start, FitUse::report);
    for (std::size_t k = 0; k < first.values.size(); ++k) {
      CHECK(second.values[k] == Approx(first.values[k]).epsilon(1e-12));
    }
    CHECK(second.squared_error() == Approx(first.squared_error()).epsilon(1e-12));
    // The search that only compares ends close by.
    const BlockFit compared = fit_blocks(record, all, nullptr);
    CHECK(compared.squared_error() == Approx(first.squared_error()).epsilon(1e-4));
  }
}

TEST_CASE("reported slopes are those of the formula, also where a bound leaves one side") {
  const SelectionProblem problem = bent_model(11);
  const Record record(problem);
  for (const double frequency : {1.32, 1.5, 10.0}) {
    const std::vector<double> at{3, 0.4, 0.8, frequency};
    const MatrixXd slopes = group_slopes(record, {0, 1}, at, FitUse::report);
    for (Index i = 0; i < record.rows(); i += 37) {
      const double t = 10 * static_cast<double>(record.row_in_problem(i)) / rows;
      const double noise = 0.3;
      // Fifth derivatives are t⁵ or less times the amplitude, and h⁴/5 with h = 0.05 is 1.3e-6.
      const double allowed = 1.3e-6 * std::pow(std::max(t, 1.0), 5) * 3 / noise;
      CHECK(slopes(i, 0) == Approx(std::exp(-0.4 * t) / noise).margin(1e-9));
      CHECK(slopes(i, 1) == Approx(-3 * t * std::exp(-0.4 * t) / noise).margin(allowed));
      CHECK(slopes(i, 3) == Approx(0.8 * t * std::cos(frequency * t) / noise).margin(allowed));
    }
  }
}
