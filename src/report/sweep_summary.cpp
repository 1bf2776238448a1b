#include "tethercalc/report/sweep_summary.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "report/result_values.hpp"

namespace tethercalc {
namespace {

constexpr std::array shares{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};

/// Half-width of a 95 % interval in standard errors of a normal distribution.
constexpr double ci95_factor = 1.96;

ordered_json estimate_json(const IndexEstimate& estimate) {
  const double half = ci95_factor * estimate.standard_error;
  return {{"value", number_or_null(estimate.value)},
          {"standard_error", number_or_null(estimate.standard_error)},
          {"ci95", {number_or_null(estimate.value - half), number_or_null(estimate.value + half)}}};
}

ordered_json sensitivity_json(const std::vector<Sensitivity>& indices, const SweepSpace& space) {
  ordered_json out = ordered_json::array();
  for (std::size_t i = 0; i < indices.size(); ++i) {
    out.push_back({{"field", space.axes()[i].name},
                   {"first_order", estimate_json(indices[i].first_order)},
                   {"total", estimate_json(indices[i].total)}});
  }
  return out;
}

ordered_json spread_json(const Spread& spread, double si_factor) {
  const auto practical = [&](double value) { return number_or_null(value / si_factor); };
  const QuantileHistogram& histogram = spread.histogram();
  const bool any = histogram.count() > 0;
  ordered_json quantiles = ordered_json::object();
  for (const double share : shares) {
    quantiles[fmt::format("{}", share)] = practical(histogram.quantile(share));
  }
  return {{"mean", practical(any ? spread.mean() : nan)},
          {"standard_deviation", practical(spread.standard_deviation())},
          {"min", practical(histogram.quantile(0))},
          {"max", practical(histogram.quantile(1))},
          {"quantiles", quantiles}};
}

std::string estimate_words(const IndexEstimate& estimate) {
  if (std::isnan(estimate.value)) return "-";
  return fmt::format("{} ± {}", fixed(estimate.value, 3),
                     fixed(ci95_factor * estimate.standard_error, 3));
}

std::string indices_text(const std::string& of, const std::vector<Sensitivity>& indices,
                         const SweepSpace& space, const TextStyle& style) {
  TextTable table({word_column("Share in the variance of " + of), "alone", "with interactions"});
  for (std::size_t i = 0; i < indices.size(); ++i) {
    table.add({space.axes()[i].name, estimate_words(indices[i].first_order),
               estimate_words(indices[i].total)});
  }
  return table.text(style) + "\n";
}

void add_spread(TextTable& table, const std::string& name, const Spread& spread, double si_factor) {
  const QuantileHistogram& histogram = spread.histogram();
  std::vector<std::string> cells{
      name, significant(histogram.count() > 0 ? spread.mean() / si_factor : nan, 4),
      significant(spread.standard_deviation() / si_factor, 3)};
  for (const double share : shares) {
    cells.push_back(significant(histogram.quantile(share) / si_factor, 4));
  }
  table.add(std::move(cells));
}

}  // namespace

std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                         const TextStyle& style) {
  const double share = static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws);
  std::string out = fmt::format("{} draws, {} infeasible ({} %)\n\n", summary.draws,
                                summary.infeasible, significant(100 * share, 3));
  std::vector<TextTable::Column> columns{word_column("Feasible draws"), "mean", "std dev"};
  for (const double p : shares) columns.push_back(fmt::format("{} %", 100 * p));
  TextTable spread(std::move(columns));
  add_spread(spread, "cross-section mm²", summary.area, unit::square_millimetre);
  add_spread(spread, "total power W", summary.power, 1);
  out += spread.text(style) + "\n";

  const SweepSensitivity& sensitivity = summary.sensitivity;
  out += indices_text("the cross-section", sensitivity.area, space, style);
  out += indices_text("the total power", sensitivity.power, space, style);
  if (!sensitivity.feasible.empty()) {
    out += indices_text("feasibility", sensitivity.feasible, space, style);
  }
  out += wrapped(
      fmt::format("Sobol indices, first order (alone) and total (with interactions), with 95 % "
                  "confidence, from {} designs.",
                  sensitivity.evaluations));
  if (sensitivity.incomplete > 0) {
    out +=
        wrapped(fmt::format("{} of {} points were infeasible in part and left out for area and "
                            "power, whose indices hold for the rest.",
                            sensitivity.incomplete, sensitivity.points));
  }
  return out;
}

ordered_json summary_json(const SweepSummary& summary, const SweepSpace& space) {
  const SweepSensitivity& sensitivity = summary.sensitivity;
  ordered_json indices = {{"points", sensitivity.points},
                          {"evaluations", sensitivity.evaluations},
                          {"incomplete_points", sensitivity.incomplete},
                          {"cross_section_mm2", sensitivity_json(sensitivity.area, space)},
                          {"total_power_W", sensitivity_json(sensitivity.power, space)},
                          {"feasible", sensitivity_json(sensitivity.feasible, space)}};
  const SamplePlan& plan = *space.sample();
  return {{"draws", summary.draws},
          {"method", plan.method == SampleMethod::sobol ? "sobol" : "lhs"},
          {"seed", plan.seed},
          {"infeasible", summary.infeasible},
          {"infeasible_share",
           static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws)},
          {"cross_section_mm2", spread_json(summary.area, unit::square_millimetre)},
          {"total_power_W", spread_json(summary.power, 1)},
          {"sensitivity", indices}};
}

}  // namespace tethercalc
