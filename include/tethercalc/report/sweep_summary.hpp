// What a sampled sweep says as a whole: how its results are spread, and which inputs spread them.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tethercalc/report/sweep_rows.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/solve/quantile_histogram.hpp"
#include "tethercalc/solve/sensitivity.hpp"

namespace tethercalc {

/// How one result is spread over the draws in which it exists.
class Spread {
 public:
  void add(double value);  ///< finite and positive
  /// Mean of the values; 0 where there are none.
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double standard_deviation() const;  ///< of the sample; NaN below two values
  /// The values' quantiles.
  [[nodiscard]] const QuantileHistogram& histogram() const { return histogram_; }

 private:
  QuantileHistogram histogram_;
  double mean_ = 0;
  double squares_ = 0;  ///< sum of squared deviations from the mean, updated as Welford (1962) does
};

/// Sensitivity of each result to each axis of a sweep, in the order of the axes.
struct SweepSensitivity {
  std::uint64_t points = 0;       ///< of each of the two samples that were mixed
  std::uint64_t evaluations = 0;  ///< designs computed: points·(axes + 2)
  std::uint64_t incomplete = 0;   ///< points with some infeasible design, left out where it matters
  std::vector<Sensitivity> area;  ///< of the optimum
  std::vector<Sensitivity> power;     ///< of the total power where the design is judged by it
  std::vector<Sensitivity> feasible;  ///< of being feasible, as 1 or 0; empty where all or none are
};

/// Largest number of points of a sensitivity analysis: their standard errors are then below 0.01 in
/// all but odd cases, in about a second.
inline constexpr std::uint64_t most_sensitivity_points = 1 << 16;

/// Sobol indices over the axes of a sampled space, with as many points as it has draws, at most
/// `most_sensitivity_points`. The first of the two samples continues the space's own kind of sample
/// and seed.
[[nodiscard]] SweepSensitivity sweep_sensitivity(const SweepSpace& space, const Design& base,
                                                 unsigned threads);

/// What all draws of a sampled sweep say together.
struct SweepSummary {
  std::uint64_t draws = 0;       ///< rows added
  std::uint64_t infeasible = 0;  ///< those of them without an optimum
  Spread area;                   ///< m²
  Spread power;                  ///< W, where the design is judged by its power
  SweepSensitivity sensitivity;  ///< from `sweep_sensitivity`

  /// Counts one row in.
  void add(const JudgedRow& row);
};

/// Tables for people.
[[nodiscard]] std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                                       const TextStyle& style);
/// The same for programs, numbers in full.
[[nodiscard]] nlohmann::ordered_json summary_json(const SweepSummary& summary,
                                                  const SweepSpace& space);

}  // namespace tethercalc
