// The search on records whose answer is known by construction: linear models with drawn columns.
#include "diagnose/selection.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "diagnose/fit_judgement.hpp"
#include "identify/statistics.hpp"
#include "support/random.hpp"

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

TEST_CASE("what mends most rows and spoils those of a kind is no finding but suspected") {
  Random random(61);
  const auto is_of_kind = [](std::size_t row) { return row % 5 == 0; };
  for (const bool acts_in_all : {true, false}) {
    LinearRecord record(random, {2.0, 0.0, 1.0, 0.0}, 0.8);
    std::vector<bool> kind(rows);
    std::vector<bool> rest(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      (is_of_kind(i) ? kind : rest)[i] = true;
      if (is_of_kind(i) && !acts_in_all) record.problem.measured[i] -= 1.5 * record.columns[2][i];
    }
    CHECK(select_effects(record.problem).selected.size() == 1);
    record.problem.kinds = {kind, rest};
    const Selection found = select_effects(record.problem);
    CHECK(found.selected.size() == (acts_in_all ? 1 : 0));
    if (acts_in_all) continue;
    const auto open = std::find_if(found.open.begin(), found.open.end(),
                                   [](const Selection::Open& o) { return o.group == 2; });
    REQUIRE(open != found.open.end());
    CHECK(open->suspected);
    CHECK(open->spoils_kind);
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

TEST_CASE("one effect that two mimic together takes their place, and they stay in its set") {
  // Column 3 is mimicked by 1, which is sought beside everything, and 2, which is simpler.
  const auto record_of = [](Random& random, double with_1, double with_2) {
    std::vector<Column> columns = LinearRecord::drawn(random, 4);
    for (std::size_t i = 0; i < rows; ++i) columns[3][i] = 2 * columns[1][i] + columns[2][i];
    LinearRecord record(random, {2.0, with_1, with_2, 0.0}, 0.8, columns);
    record.problem.groups[1].usual = true;
    record.problem.groups[3].numbers = 2;
    return record;
  };
  Random random(67);
  int alone = 0;
  int with_set = 0;
  constexpr int draws = 40;
  for (int draw = 0; draw < draws; ++draw) {
    const Selection mimicked = select_effects(record_of(random, 2, 1).problem);
    if (mimicked.selected.size() == 1) {
      CHECK(mimicked.selected.front().group == 3);
      std::vector<std::size_t> others = mimicked.selected.front().indistinguishable;
      std::sort(others.begin(), others.end());
      with_set += others == std::vector<std::size_t>{1, 2} ? 1 : 0;
      ++alone;
    }
    // Both are there where 3 has another share of them.
    CHECK(select_effects(record_of(random, 2, -1).problem).selected.size() == 2);
  }
  // A size too many makes a record the worse held out where a normal deviate squared is below 2: in
  // 84 %, 34 of 40 ± 2.3. In some 3 is found at once, and what two do is not asked.
  CHECK(alone >= 26);
  CHECK(with_set >= 10);
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

namespace {

BlockFit with_errors(std::vector<double> block_error) {
  BlockFit fit;
  fit.block_error = VectorXd::Map(block_error.data(), static_cast<Index>(block_error.size()));
  return fit;
}

}  // namespace

TEST_CASE("a gain earns a name where it is large enough and more than chance over its blocks") {
  Random random(8);
  LinearRecord linear(random, {1, 1, 1, 1}, 0);
  linear.problem.groups[2].least_gain_factor = 5;
  linear.problem.groups[3].blocks = 6;
  const Record record(linear.problem);
  const auto earns = [&record](std::size_t group, double percent, double se) {
    return earns_a_name(record, group, {percent, se}, 2);
  };
  CHECK(earns(1, 2, 0.1));
  CHECK_FALSE(earns(1, 1.999, 0.1));
  // Student's 97.5 % quantile is 2.0930 for 20 blocks, 2.5706 for 6.
  CHECK(earns(1, 3, 3 / 2.0931));
  CHECK_FALSE(earns(1, 3, 3 / 2.0929));
  CHECK(earns(3, 3, 3 / 2.5707));
  CHECK_FALSE(earns(3, 3, 3 / 2.5705));
  CHECK(earns(2, 10, 0.1));
  CHECK_FALSE(earns(2, 9.999, 0.1));
  // Nothing at all earns none, whatever is asked for.
  CHECK_FALSE(earns_a_name(record, 1, {0, 0}, 0));
  CHECK_FALSE(earns_a_name(record, 1, {-1, 0}, -2));
}

TEST_CASE("a gain is that of all blocks together, its error what leaving one out changes") {
  const Gain gain = gain_between(with_errors({4, 4}), with_errors({1, 4}));
  CHECK(gain.percent == Approx(100 * (1 - std::sqrt(5.0 / 8))));
  // 0 % and 50 % without the one and the other: √(½·2·25²).
  CHECK(gain.se == Approx(25));
}

TEST_CASE("a typical gain is the mean over blocks, each held against itself") {
  const Gain alike = typical_gain_between(with_errors({4, 1, 100}), with_errors({1, 0.25, 25}));
  CHECK(alike.percent == Approx(50));
  CHECK(alike.se == Approx(0).margin(1e-9));
  // The mean of ln 1 and ln ½ is ln √½; their spread makes a standard error of ln 2/2.
  const Gain one_of_two = typical_gain_between(with_errors({1, 1}), with_errors({1, 0.25}));
  CHECK(one_of_two.percent == Approx(100 * (1 - std::sqrt(0.5))));
  CHECK(one_of_two.se == Approx(100 * std::sqrt(0.5) * std::log(2) / 2));
  CHECK(typical_gain_between(with_errors({1, 0.25}), with_errors({1, 1})).percent ==
        Approx(100 * (1 - std::sqrt(2))));
}

TEST_CASE("the size of a block's error is nothing to a typical gain") {
  test::each_random(20, [](test::Random& random) {
    std::vector<double> before;
    std::vector<double> after;
    for (int b = 0; b < 8; ++b) {
      before.push_back(random.magnitude(0.1, 10));
      after.push_back(before.back() * random.uniform(0.5, 1.2));
    }
    const Gain gain = typical_gain_between(with_errors(before), with_errors(after));
    for (std::size_t b = 0; b < before.size(); ++b) {
      const double size = random.magnitude(1e-3, 1e3);
      before[b] *= size;
      after[b] *= size;
    }
    const Gain resized = typical_gain_between(with_errors(before), with_errors(after));
    CHECK(resized.percent == Approx(gain.percent));
    CHECK(resized.se == Approx(gain.se));
  });
}

TEST_CASE("whatever was searched, no name is told whose gain does not earn it") {
  std::size_t told = 0;
  test::each_random(8, [&told](test::Random& random) {
    std::vector<double> coefficients{1};
    for (int k = 0; k < 6; ++k) {
      coefficients.push_back(random.chance(0.5) ? random.uniform(-0.4, 0.4) : 0);
    }
    Random engine(static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
    std::vector<Column> columns = LinearRecord::drawn(engine, coefficients.size());
    for (std::size_t i = 0; i < rows; ++i) columns[2][i] += columns[1][i] - columns[3][i] / 2;
    const LinearRecord record(engine, coefficients, 0.8, columns);
    for (const Selection& found :
         {select_effects(record.problem), select_subset(record.problem, {}, {})}) {
      for (const SelectedGroup& s : found.selected) {
        ++told;
        // Beyond Student's factor, or beyond two where the typical block is sure.
        CHECK(s.gain_percent > 2 * s.gain_se_percent * (1 - 1e-4));
        CHECK(s.gain_percent >= found.least_gain_percent * (1 - 1e-4));
      }
    }
  });
  CHECK(told > 0);
}

TEST_CASE("a name that is taken back does not come back in exchange for another") {
  // From 60 % of the rows on something happens that no name describes: one follows it well, another
  // less so, and a shape without a name entirely. Whoever exchanges the second name for the first
  // has to take it back as often as he does.
  Random random(9);
  LinearRecord record(random, {1, 0, 0}, 0.5);
  std::vector<double> places;
  for (int k = 1; k < 40; ++k) places.push_back(static_cast<double>(rows) * k / 40);
  for (const std::size_t g : {1U, 2U}) {
    ParameterGroup& group = record.problem.groups[g];
    group.parameters.push_back({.neutral = 0,
                                .lower = 0,
                                .upper = rows,
                                .scale = 10,
                                .start = 0,
                                .shape_only = true,
                                .places = places,
                                .fitted = false});
  }
  constexpr std::size_t begins = rows * 6 / 10;
  UnnamedRegressor happened{"time", "what happened", Column(rows, 0.0)};
  for (std::size_t i = begins; i < rows; ++i) {
    happened.column[i] = 1;
    record.problem.measured[i] += 3;
  }
  record.problem.unnamed.push_back(happened);
  record.problem.predict = [columns = record.columns](std::span<const double> values,
                                                      std::span<double> out) {
    for (std::size_t i = 0; i < rows; ++i) {
      const auto since = [i](double place) { return static_cast<double>(i) >= place ? 1.0 : 0.0; };
      out[i] = values[0] * columns[0][i] +
               values[1] * since(values[2]) * (1 + 0.3 * columns[1][i]) +
               values[3] * since(values[4]) * (1 + 0.8 * columns[2][i]);
    }
  };
  const Selection found = select_effects(record.problem);
  CHECK(found.selected.empty());
  CHECK(found.unnamed.regressors == std::vector<std::size_t>{0});
}
