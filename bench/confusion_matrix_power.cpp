// What is found in power logs where one effect is hidden: the confusion matrix over the catalogue,
// how often intervals hold the truth, and how often silence is broken where nothing is hidden.
//
//   confusion_matrix_power [LOGS]   logs of each kind, 24 by default
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "hidden_effects/power_scenarios.hpp"

using namespace tethercalc;
using namespace power_truth;

namespace {

struct Row {
  std::map<std::string, int> first;  ///< the first finding, "-" for none
  int in_set = 0;  ///< the truth is the first finding or declared indistinguishable from it
  int fitted = 0;
  int covered = 0;
  int more = 0;  ///< further findings beside the first
  int unnamed = 0;
};

Diagnosis diagnosis_of(const Scenario& scenario) {
  return diagnose_power(spec(), as_power_log(simulate(scenario))).diagnosis;
}

using Hide = std::function<void(HiddenEffects&, double)>;

/// `effect` is that which `hide` hides, where the catalogue has it.
Row row_of(const Hide& hide, const HiddenEffect* effect, int logs, std::uint64_t seed) {
  Row row;
  for (int i = 0; i < logs; ++i) {
    Scenario scenario;
    scenario.seed = seed + static_cast<std::uint64_t>(i);
    hide(scenario.hidden, logs > 1 ? i / (logs - 1.0) : 1);
    const Diagnosis d = diagnosis_of(scenario);
    row.unnamed += d.unexplained.detected;
    if (d.findings.empty()) {
      ++row.first["-"];
      continue;
    }
    const Finding& found = d.findings.front();
    ++row.first[found.effect];
    row.more += d.findings.size() > 1;
    if (!effect) continue;
    const auto& others = found.indistinguishable_from;
    row.in_set += found.effect == effect->id ||
                  std::find(others.begin(), others.end(), effect->id) != others.end();
    if (found.effect != effect->id) continue;
    const ParameterEstimate& p = found.parameters.front();
    const double truth = effect->truth(scenario.hidden);
    ++row.fitted;
    row.covered += p.ci95_lower <= truth && truth <= p.ci95_upper;
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  const int logs = argc > 1 ? std::atoi(argv[1]) : 24;
  if (logs < 1) {
    fmt::print(stderr, "usage: confusion_matrix_power [LOGS], LOGS at least 1\n");
    return 2;
  }
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::string> columns;
  for (const HiddenEffect& effect : hidden_effects()) columns.push_back(effect.id);
  columns.emplace_back("-");

  fmt::print(
      "Rows: hidden, {} logs each, from the limit of detection to large; then what no effect "
      "does,\n"
      "and nothing. Columns: first finding, numbered like the rows; \"-\" none.\n\n",
      logs);
  fmt::print("{:>2} {:<28}", "", "");
  for (std::size_t c = 0; c + 1 < columns.size(); ++c) fmt::print("{:>4}", c + 1);
  fmt::print("{:>4} | {:>6} {:>8} {:>6} {:>8}\n", "-", "in set", "covered", "more", "unnamed");
  const auto print = [&](const std::string& number, const std::string& name, const Row& row) {
    fmt::print("{:>2} {:<28}", number, name);
    for (const std::string& column : columns) {
      const auto count = row.first.find(column);
      fmt::print("{:>4}", count == row.first.end() ? "." : std::to_string(count->second));
    }
    fmt::print(" | {:>6} {:>8} {:>6} {:>8}\n", row.in_set,
               fmt::format("{}/{}", row.covered, row.fitted), row.more, row.unnamed);
    std::fflush(stdout);
  };
  std::size_t kinds = 0;
  for (const HiddenEffect& effect : hidden_effects()) {
    ++kinds;
    print(std::to_string(kinds), effect.id, row_of(effect.hide, &effect, logs, 50'000 * kinds));
  }
  for (const UnknownEffect& unknown : unknown_effects()) {
    ++kinds;
    print("", unknown.words, row_of(unknown.hide, nullptr, logs, 50'000 * kinds));
  }
  const auto nothing = [](HiddenEffects&, double) {};
  print("", "nothing", row_of(nothing, nullptr, 4 * logs, 900'000));

  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("\n{:.0f} ms a log of about 1,550 samples\n",
             1000 * seconds / (logs * (static_cast<double>(kinds) + 4)));
}
