#include "tethercalc/report/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tethercalc/report/json_results.hpp"
#include "tethercalc/solve/ordered_chunks.hpp"

namespace tethercalc {
namespace {

using nlohmann::ordered_json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr std::array shares{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};

/// Half-width of a 95 % interval in standard errors of a normal distribution.
constexpr double ci95_factor = 1.96;

/// Outputs of some consecutive points.
struct MixedChunk {
  SensitivitySample area;
  SensitivitySample power;
  SensitivitySample feasible;
};

SensitivitySample empty_sample(std::size_t inputs) {
  return {{}, {}, std::vector<std::vector<double>>(inputs)};
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(SensitivitySample& to, const SensitivitySample& from) {
  append(to.a, from.a);
  append(to.b, from.b);
  for (std::size_t i = 0; i < to.mixed.size(); ++i) append(to.mixed[i], from.mixed[i]);
}

/// Computes the outputs at points of two samples and their mixtures.
class MixedPoints {
 public:
  MixedPoints(const SweepSpace& space, const Design& base, std::uint64_t points)
      : axes_(space.axes()),
        cursor_(space, base),
        given_area_(varies_cross_section(space)),
        points_({points, space.sample()->method, space.sample()->seed}, 2 * axes_.size()),
        unit_(2 * axes_.size()) {}

  void compute(std::uint64_t begin, std::uint64_t end, MixedChunk& chunk) {
    chunk = {empty_sample(axes_.size()), empty_sample(axes_.size()), empty_sample(axes_.size())};
    for (std::uint64_t j = begin; j < end; ++j) {
      points_.at(j, unit_);
      std::vector<double> a;
      std::vector<double> b;
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        a.push_back(quantile(axes_[i], unit_[i]));
        b.push_back(quantile(axes_[i], unit_[axes_.size() + i]));
      }
      add(a, chunk.area.a, chunk.power.a, chunk.feasible.a);
      add(b, chunk.area.b, chunk.power.b, chunk.feasible.b);
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        std::vector<double> mixed = a;
        mixed[i] = b[i];
        add(mixed, chunk.area.mixed[i], chunk.power.mixed[i], chunk.feasible.mixed[i]);
      }
    }
  }

 private:
  void add(const std::vector<double>& values, std::vector<double>& area, std::vector<double>& power,
           std::vector<double>& feasible) {
    cursor_.set_values(values);
    const SweepOutcome outcome = sweep_outcome(cursor_.design(), given_area_);
    area.push_back(outcome.feasible ? outcome.area : nan);
    power.push_back(outcome.feasible ? judged_power(outcome, cursor_.design()) : nan);
    feasible.push_back(outcome.feasible ? 1 : 0);
  }

  std::span<const SweepAxis> axes_;
  SweepCursor cursor_;
  bool given_area_;
  UnitPoints points_;
  std::vector<double> unit_;
};

std::uint64_t incomplete_points(const SensitivitySample& feasible) {
  std::uint64_t count = 0;
  for (std::size_t j = 0; j < feasible.a.size(); ++j) {
    bool complete = feasible.a[j] == 1 && feasible.b[j] == 1;
    for (const auto& mixed : feasible.mixed) complete = complete && mixed[j] == 1;
    if (!complete) ++count;
  }
  return count;
}

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
  TextTable table({{"Share in the variance of " + of, TextTable::Align::left},
                   {"alone"},
                   {"with interactions"}});
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

void Spread::add(double value) {
  histogram_.add(value);
  const double deviation = value - mean_;
  mean_ += deviation / static_cast<double>(histogram_.count());
  squares_ += deviation * (value - mean_);
}

double Spread::standard_deviation() const {
  if (histogram_.count() < 2) return nan;
  return std::sqrt(squares_ / static_cast<double>(histogram_.count() - 1));
}

void SweepSummary::add(const JudgedRow& row) {
  ++draws;
  if (!row.feasible || std::isnan(row.power)) {
    ++infeasible;
    return;
  }
  area.add(row.area);
  power.add(row.power);
}

SweepSensitivity sweep_sensitivity(const SweepSpace& space, const Design& base, unsigned threads) {
  constexpr std::uint64_t points_per_chunk = 64;
  const std::size_t axes = space.axes().size();
  SweepSensitivity result;
  result.points = std::min(space.rows(), most_sensitivity_points);
  result.evaluations = result.points * (axes + 2);
  MixedChunk all{empty_sample(axes), empty_sample(axes), empty_sample(axes)};
  const auto make_worker = [&] {
    return [&result, points = MixedPoints(space, base, result.points)](std::uint64_t index,
                                                                       MixedChunk& chunk) mutable {
      const std::uint64_t begin = index * points_per_chunk;
      points.compute(begin, std::min(begin + points_per_chunk, result.points), chunk);
    };
  };
  const std::uint64_t chunks = (result.points + points_per_chunk - 1) / points_per_chunk;
  compute_in_order<MixedChunk>(0, chunks, threads, make_worker, [&](const MixedChunk& chunk) {
    append(all.area, chunk.area);
    append(all.power, chunk.power);
    append(all.feasible, chunk.feasible);
    return true;
  });
  const std::uint64_t seed = space.sample()->seed;
  result.incomplete = incomplete_points(all.feasible);
  result.area = sobol_indices(all.area, seed);
  result.power = sobol_indices(all.power, seed);
  if (result.incomplete > 0) {
    result.feasible = sobol_indices(all.feasible, seed);
    if (std::isnan(result.feasible.front().total.value)) result.feasible.clear();
  }
  return result;
}

std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                         const TextStyle& style) {
  const double share = static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws);
  std::string out = fmt::format("{} draws, {} infeasible ({} %)\n\n", summary.draws,
                                summary.infeasible, significant(100 * share, 3));
  std::vector<TextTable::Column> columns{
      {"Feasible draws", TextTable::Align::left}, {"mean"}, {"std dev"}};
  for (const double p : shares) columns.push_back({fmt::format("{} %", 100 * p)});
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
