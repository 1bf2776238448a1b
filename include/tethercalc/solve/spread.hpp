// How any number of positive numbers are spread, in little memory.
#pragma once

#include <cstdint>
#include <vector>

namespace tethercalc {

/// Mean, standard deviation and quantiles, the latter by a histogram with bins of equal ratio,
/// after DDSketch (Masson, Rim and Lee, VLDB 2019): it answers every quantile to a relative error
/// of 1e-5, far below what a sample of a million leaves uncertain, in at most a few megabytes, and
/// does not depend on the order of the numbers.
class Spread {
 public:
  /// Largest relative error of a quantile.
  static constexpr double relative_error = 1e-5;

  /// `value` must be finite and positive; below 1e-30 or above 1e30 it counts as that. Throws
  /// std::invalid_argument otherwise.
  void add(double value);

  /// How many numbers were added.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  [[nodiscard]] double mean() const;                ///< NaN where there are none
  [[nodiscard]] double standard_deviation() const;  ///< of the sample; NaN below two values

  /// The smallest number at which at least a share `p` in [0, 1] of all is reached (Hyndman and Fan
  /// 1996, definition 1); NaN where there are none. The ends, p = 0 and 1, are exact.
  [[nodiscard]] double quantile(double p) const;

 private:
  std::vector<std::uint64_t> bins_;  ///< without the empty ones at both ends
  std::int64_t first_bin_ = 0;
  std::uint64_t count_ = 0;
  double least_ = 0;
  double largest_ = 0;
  double mean_ = 0;
  double squares_ = 0;  ///< sum of squared deviations from the mean, updated as Welford (1962) does
};

}  // namespace tethercalc
