// The search on records whose answer is known by construction: linear models with drawn columns.
#include "diagnose/selection.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tethercalc;

namespace {

using Random = std::mt19937_64;
using Column = std::vector<double>;

constexpr std::size_t rows = 1500;
constexpr int blocks = 20;

Column correlated_noise(Random& random, double keep) {
  std::normal_distribution<double> normal;
  Column out(rows);
  double value = 0;
  for (double& x : out) {
    value = keep * value + std::sqrt(1 - keep * keep) * normal(random);
    x = value;
  }
  return out;
}

/// measured = Σ coefficient·column + noise; every column is a candidate but the first, which is
/// always fitted.
struct LinearRecord {
  std::vector<Column> columns;
  SelectionProblem problem;

  LinearRecord(Random& random, const std::vector<double>& coefficients, double keep)
      : LinearRecord(random, coefficients, keep, drawn(random, coefficients.size())) {}

  LinearRecord(Random& random, const std::vector<double>& coefficients, double keep,
               std::vector<Column> given)
      : columns(std::move(given)) {
    problem.measured = correlated_noise(random, keep);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      for (std::size_t i = 0; i < rows; ++i) {
        problem.measured[i] += coefficients[k] * columns[k][i];
      }
      ParameterGroup group;
      group.id = "column " + std::to_string(k);
      group.fitted = k == 0;
      group.parameters = {{.neutral = 0, .lower = -100, .upper = 100, .scale = 1, .start = 0}};
      problem.groups.push_back(group);
    }
    problem.noise.assign(rows, 1.0);
    for (std::size_t i = 0; i < rows; ++i) {
      problem.block.push_back(static_cast<int>(i * blocks / rows));
    }
    problem.predict = [copy = columns](std::span<const double> values, std::span<double> out) {
      std::fill(out.begin(), out.end(), 0.0);
      for (std::size_t k = 0; k < copy.size(); ++k) {
        for (std::size_t i = 0; i < rows; ++i) out[i] += values[k] * copy[k][i];
      }
    };
  }

  static std::vector<Column> drawn(Random& random, std::size_t count) {
    std::vector<Column> result;
    for (std::size_t k = 0; k < count; ++k) result.push_back(correlated_noise(random, 0.9));
    return result;
  }
};

}  // namespace

TEST_CASE("what one block alone shows is no finding, however certain it seems") {
  Random random(57);
  for (const bool alone : {false, true}) {
    std::vector<Column> columns = LinearRecord::drawn(random, 4);
    if (alone) {
      for (std::size_t i = 0; i < rows / blocks; ++i) columns[2][i] *= 30;
    }
    const LinearRecord record(random, {2.0, 0.0, 1.0, 0.0}, 0.8, columns);
    const Selection found = select_effects(record.problem);
    CHECK(found.selected.empty() == alone);
    if (!alone) continue;
    const auto open = std::find_if(found.open.begin(), found.open.end(),
                                   [](const Selection::Open& o) { return o.group == 2; });
    REQUIRE(open != found.open.end());
    CHECK(open->largest_block_share > 0.9);
    CHECK(open->gain_percent > 10);
  }
}

TEST_CASE("the candidate that was put in is selected and its interval holds the truth") {
  int covered = 0;
  constexpr int trials = 40;
  for (int seed = 0; seed < trials; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 100);
    const LinearRecord record(random, {2.0, 0.0, 1.0, 0.0, 0.0}, 0.8);
    const Selection found = select_effects(record.problem);
    REQUIRE(found.selected.size() == 1);
    CHECK(found.selected[0].group == 2);
    CHECK(found.selected[0].gain_percent > 10);  // 1 − 1/√2 = 29 % expected
    const double error = std::abs(found.complete.values[2] - 1.0);
    covered += error <= found.student_factor[2] * found.complete.standard_error[2] ? 1 : 0;
  }
  // 95 % of 40 is 38; fewer than 33 has a chance of 0.3 % (binomial).
  CHECK(covered >= 33);
}

TEST_CASE("correlated noise alone selects nothing") {
  int alarms = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 300);
    LinearRecord record(random, {1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.9);
    for (const Column& column : LinearRecord::drawn(random, 20)) {
      record.problem.unnamed.push_back({"some channel", "some shape", column});
    }
    const Selection found = select_effects(record.problem);
    alarms += found.selected.empty() && found.unnamed.regressors.empty() ? 0 : 1;
  }
  // 1 % each is asked of names and of unnamed structure: six of 60 have a chance of 0.2 %.
  CHECK(alarms <= 5);
}

TEST_CASE("two effects at once are both selected, the larger first") {
  Random random(5);
  const LinearRecord record(random, {1.0, 0.0, 0.7, 0.0, 2.0}, 0.8);
  const Selection found = select_effects(record.problem);
  REQUIRE(found.selected.size() == 2);
  CHECK(found.selected[0].group == 4);
  CHECK(found.selected[1].group == 2);
  CHECK(found.selected[0].rmse_after == Approx(found.selected[1].rmse_before));
  CHECK(found.extended.holdout_rmse == Approx(found.selected[1].rmse_after));
  CHECK(found.base.holdout_rmse == Approx(found.selected[0].rmse_before));
}

TEST_CASE("effects that explain equally well are reported together") {
  Random random(6);
  std::vector<Column> columns = LinearRecord::drawn(random, 4);
  for (std::size_t i = 0; i < rows; ++i) columns[3][i] = columns[2][i] + 0.02 * columns[3][i];
  const LinearRecord record(random, {1.0, 0.0, 1.0, 0.0}, 0.8, columns);
  const Selection found = select_effects(record.problem);
  REQUIRE(found.selected.size() == 1);
  REQUIRE(found.selected[0].indistinguishable.size() == 1);
  CHECK(found.selected[0].group + found.selected[0].indistinguishable[0] == 5);
}

TEST_CASE("a candidate parallel to the base is no candidate") {
  Random random(7);
  std::vector<Column> columns = LinearRecord::drawn(random, 3);
  for (std::size_t i = 0; i < rows; ++i) columns[1][i] = 3 * columns[0][i];
  const LinearRecord record(random, {1.0, 0.0, 1.0}, 0.8, columns);
  const Selection found = select_effects(record.problem);
  REQUIRE(found.aliased.size() == 1);
  CHECK(found.aliased[0].group == 1);
  CHECK(found.aliased[0].with == std::vector<std::size_t>{0});
  REQUIRE(found.selected.size() == 1);
  CHECK(found.selected[0].group == 2);
}

TEST_CASE("a name gives way to an unnamed shape that explains more") {
  Random random(8);
  std::vector<Column> columns = LinearRecord::drawn(random, 3);
  LinearRecord record(random, {1.0, 0.0, 0.0}, 0.8, columns);
  UnnamedRegressor hidden{"roll", "hidden shape", correlated_noise(random, 0.9)};
  // The candidate follows the hidden shape only in part.
  std::vector<Column> proxies = columns;
  for (std::size_t i = 0; i < rows; ++i) {
    proxies[2][i] = 0.8 * hidden.column[i] + 0.6 * columns[2][i];
    record.problem.measured[i] += 1.5 * hidden.column[i];
  }
  record.problem.predict = [proxies](std::span<const double> values, std::span<double> out) {
    for (std::size_t i = 0; i < rows; ++i) {
      out[i] = values[0] * proxies[0][i] + values[1] * proxies[1][i] + values[2] * proxies[2][i];
    }
  };
  const Selection proxy_only = select_effects(record.problem);
  REQUIRE(proxy_only.selected.size() == 1);
  CHECK(proxy_only.selected[0].group == 2);

  record.problem.unnamed.push_back(hidden);
  const Selection found = select_effects(record.problem);
  CHECK(found.selected.empty());
  REQUIRE(found.unnamed.channels == std::vector<std::string>{"roll"});
  // Noise has variance 1, the hidden shape 2.25.
  CHECK(found.unnamed.share_percent == Approx(100 * 2.25 / 3.25).margin(12));
}

TEST_CASE("what an effect too small for a name explains is not called unknown") {
  Random random(11);
  std::vector<Column> columns = LinearRecord::drawn(random, 3);
  LinearRecord record(random, {1.0, 0.0, 0.0}, 0.3, columns);
  // The shape follows the effect, and the bar for a shape lies below the one for a name.
  SelectionOptions options;
  options.least_gain_percent = 4.0;
  UnnamedRegressor shape{"time", "shape", columns[2]};
  for (std::size_t i = 0; i < rows; ++i) {
    record.problem.measured[i] += 0.25 * columns[2][i];
    shape.column[i] += 0.1 * columns[1][i];
  }
  record.problem.unnamed.push_back(shape);
  const Selection found = select_effects(record.problem, options);
  CHECK(found.selected.empty());
  CHECK(found.unnamed.regressors.empty());
  const auto open = std::find_if(found.open.begin(), found.open.end(),
                                 [](const Selection::Open& o) { return o.group == 2; });
  REQUIRE(open != found.open.end());
  CHECK(open->p_value < 0.01);
  CHECK(open->gain_percent > 1.5);
  CHECK(open->gain_percent < 4);
}

TEST_CASE("of two equally simple effects the better one is taken") {
  Random random(12);
  std::vector<Column> columns = LinearRecord::drawn(random, 4);
  // Group 1 is a blurred copy of group 2; group 3 has two parameters and is as good.
  for (std::size_t i = 0; i < rows; ++i) columns[1][i] = 0.9 * columns[2][i] + 0.3 * columns[1][i];
  LinearRecord record(random, {1.0, 0.0, 0.6, 0.0}, 0.8, columns);
  const Selection found = select_effects(record.problem);
  REQUIRE_FALSE(found.selected.empty());
  CHECK(found.selected[0].group == 2);
}

TEST_CASE("outliers in one per cent of the rows change neither selection nor estimate") {
  Random random(9);
  LinearRecord record(random, {1.0, 0.0, 1.0, 0.0}, 0.8);
  const Selection clean = select_effects(record.problem);
  for (std::size_t i = 50; i < rows; i += 100) {
    record.problem.measured[i] += i % 200 == 50 ? 15.0 : -15.0;
  }
  const Selection dirty = select_effects(record.problem);
  REQUIRE(clean.selected.size() == 1);
  REQUIRE(dirty.selected.size() == 1);
  CHECK(dirty.selected[0].group == clean.selected[0].group);
  CHECK(std::abs(dirty.complete.values[2] - clean.complete.values[2]) <
        2 * clean.complete.standard_error[2]);
}

TEST_CASE("rows outside every block have no influence") {
  Random random(10);
  LinearRecord record(random, {1.0, 0.0, 1.0}, 0.8);
  record.problem.block[77] = -1;
  const Selection before = select_effects(record.problem);
  record.problem.measured[77] = 1e6;
  const Selection after = select_effects(record.problem);
  CHECK(after.extended.holdout_rmse == before.extended.holdout_rmse);
  CHECK(after.rows == rows - 1);
}

TEST_CASE("a record that makes no sense is refused") {
  Random random(11);
  const LinearRecord good(random, {1.0, 0.0}, 0.8);
  SelectionProblem bad = good.problem;
  bad.noise.pop_back();
  CHECK_THROWS_AS(select_effects(bad), std::invalid_argument);
  bad = good.problem;
  bad.noise[3] = 0;
  CHECK_THROWS_AS(select_effects(bad), std::invalid_argument);
  bad = good.problem;
  bad.groups[1].parameters[0].lower = 1;  // the neutral value is 0
  CHECK_THROWS_AS(select_effects(bad), std::invalid_argument);
  bad = good.problem;
  for (int& block : bad.block) block %= static_cast<int>(fewest_blocks) - 1;
  CHECK_THROWS_AS(select_effects(bad), std::invalid_argument);
}

TEST_CASE("of whole subsets, names that gain less than asked for go, the others stay") {
  Random random(7);
  const LinearRecord record(random, {1, 2, 0.2, 0}, 0);
  const auto names = [&](double least_gain_percent) {
    SelectionOptions options;
    options.least_gain_percent = least_gain_percent;
    return select_subset(record.problem, options, {}).selected;
  };
  const std::vector<SelectedGroup> any = names(0);
  REQUIRE(any.size() == 2);
  CHECK(any[0].group == 1);
  CHECK(any[1].group == 2);
  CHECK(names(0.99 * any[1].gain_percent).size() == 2);
  const std::vector<SelectedGroup> worth = names(1.01 * any[1].gain_percent);
  REQUIRE(worth.size() == 1);
  CHECK(worth[0].group == 1);
  CHECK(worth[0].rmse_after == Approx(any[0].rmse_after));
}
