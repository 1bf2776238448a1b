#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/sweep_axes.hpp"
#include "tethercalc/report/sweep_report.hpp"

using namespace tethercalc;
using namespace tethercalc::test;

namespace {

DesignFile base() { return parse_design(starting_spec(), "starting spec"); }

SweepSummary summary_of(const SweepSpace& space, const Design& design) {
  SweepSummary summary;
  compute_sweep({&space, &design, {}, {0, space.rows()}, space.rows(), 2},
                [&](const SweepChunk& chunk) {
                  for (const JudgedRow& row : chunk.judged) summary.add(row);
                  return true;
                });
  return summary;
}

/// Powers of `draws` designs drawn plainly, with the standard library's generator and
/// distributions, in rising order; infeasible ones left out.
std::vector<double> plain_powers(int draws) {
  std::mt19937_64 random(run_seed());
  std::normal_distribution<double> voltage(90, 4);
  std::uniform_real_distribution<double> length(15, 40);
  std::normal_distribution<double> mass(1.7, 0.05);
  Design design = base().design;
  std::vector<double> powers;
  for (int i = 0; i < draws; ++i) {
    design.supply.voltage = voltage(random);
    design.tether.length = length(random);
    design.drone.mass = mass(random);
    const Optimization result = optimize(design);
    if (result.feasible) powers.push_back(result.forward.total_power);
  }
  std::sort(powers.begin(), powers.end());
  return powers;
}

}  // namespace

TEST_CASE("a sample's quantiles and infeasible share are those of plain random draws") {
  const char* asked = std::getenv("TETHERCALC_PLAIN_DRAWS");
  const int draws = asked ? std::stoi(asked) : 100000;
  const std::vector<double> plain = plain_powers(draws);
  const double feasible = static_cast<double>(plain.size()) / draws;
  INFO("TETHERCALC_TEST_SEED=" << run_seed());

  const std::vector<std::string> varied{"supply.voltage_V=90~4", "tether.length_m=15..40",
                                        "drone.mass_g=1700~50"};
  for (const SampleMethod method : {SampleMethod::sobol, SampleMethod::latin_hypercube}) {
    const SweepSpace space(read_axes(varied, base(), AxisUse::sampled),
                           {1 << 17, method, run_seed() + 1});
    const SweepSummary summary = summary_of(space, base().design);
    const double infeasible =
        static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws);
    // Both sides are uncertain by chance: five standard deviations of the difference at most,
    // the sample counted as if it were plain too.
    const double spread = std::sqrt(1.0 / draws + 1.0 / static_cast<double>(summary.draws));
    CHECK(std::abs(infeasible - (1 - feasible)) <=
          5 * std::sqrt(feasible * (1 - feasible)) * spread + 1e-9);
    for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
      // A quantile's place among the plain draws instead of its value: that is what chance moves.
      const double value = summary.power.quantile(p);
      const auto below = std::lower_bound(plain.begin(), plain.end(), value) - plain.begin();
      const double place = static_cast<double>(below) / static_cast<double>(plain.size());
      CHECK(std::abs(place - p) <= 5 * std::sqrt(p * (1 - p) / feasible) * spread + 1e-4);
      if (asked) WARN(p << ": quantile " << value << " W is at " << place << " of plain draws");
    }
  }
}

TEST_CASE("mean and standard deviation are those of the values") {
  Spread spread;
  CHECK(std::isnan(spread.standard_deviation()));
  for (const double value : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) spread.add(value);
  CHECK(spread.mean() == Approx(5));
  CHECK(spread.standard_deviation() == Approx(std::sqrt(32.0 / 7)));
}

TEST_CASE("a summary of infeasible draws alone says so instead of inventing numbers") {
  const DesignFile file = base();
  const std::vector<std::string> varied{"drone.mass_g=20000..30000"};
  const SweepSpace space(read_axes(varied, file, AxisUse::sampled), {300, SampleMethod::sobol, 0});
  SweepSummary summary = summary_of(space, file.design);
  summary.sensitivity = sweep_sensitivity(space, file.design);
  CHECK(summary.infeasible == 300);
  const nlohmann::ordered_json answer = summary_json(summary, space);
  CHECK(answer["infeasible_share"] == 1);
  CHECK(answer["total_power_W"]["mean"].is_null());
  CHECK(answer["total_power_W"]["quantiles"]["0.5"].is_null());
  CHECK(answer["sensitivity"]["total_power_W"][0]["total"]["value"].is_null());
  CHECK_THAT(summary_text(summary, space, {}), Catch::Contains("300 infeasible (100 %)"));
}
