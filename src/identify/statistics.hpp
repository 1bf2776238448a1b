// Statistics of series, the distributions that errors are held against, and standard errors for
// residuals that resemble their neighbours in time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace tethercalc {

/// Median absolute deviation of a normal distribution over its standard deviation, inverted.
inline constexpr double mad_to_sigma = 1.4826;

/// The element at `place` of the sorted series.
[[nodiscard]] inline double ordered(std::vector<double> values, std::size_t place) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The median, of an even number the upper one; 0 of none.
[[nodiscard]] inline double median(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  return values.empty() ? 0 : ordered(std::move(values), middle);
}

/// What `part` of the values, in [0, 1], lie at or below; of at least one value.
[[nodiscard]] inline double quantile(std::vector<double> values, double part) {
  const auto place = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
  return ordered(std::move(values), place);
}

/// How far each element lies from the median of the `2·half + 1` about it, of as many at an end;
/// all 0 of fewer.
[[nodiscard]] std::vector<double> distance_from_neighbours(const std::vector<double>& series,
                                                           std::size_t half);

/// Whether `value` is among `values`.
template <typename T, typename Value>
[[nodiscard]] bool contains(const std::vector<T>& values, const Value& value) {
  return std::ranges::find(values, value) != values.end();
}

/// Element by element.
[[nodiscard]] inline std::vector<double> product(std::vector<double> a,
                                                 const std::vector<double>& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::multiplies<>());
  return a;
}

/// A mean and its standard error.
struct MeanOfStretches {
  double value = 0;
  double error = 0;
};

/// Of at least two stretches that stand for each other, by the means of each.
[[nodiscard]] inline MeanOfStretches mean_of_stretches(std::span<const double> means) {
  const auto count = static_cast<double>(means.size());
  MeanOfStretches mean;
  for (const double x : means) mean.value += x / count;
  double squares = 0;
  for (const double x : means) squares += (x - mean.value) * (x - mean.value);
  mean.error = std::sqrt(squares / ((count - 1) * count));
  return mean;
}

/// The value that Student's t with `degrees` > 0 of freedom stays below with probability `p`, in
/// (0, 1).
[[nodiscard]] double student_quantile(double degrees, double p);

/// Probability of Student's t above `t`, infinity included; 1 for NaN.
[[nodiscard]] double student_tail(double t, double degrees);

/// Probability of Fisher's F above `f` (negative: 1; infinity and NaN: 0); both degrees > 0.
[[nodiscard]] double fisher_tail(double f, double numerator, double denominator);

/// Probability of chi-squared above `x` (negative: 1) with `degrees` > 0 of freedom.
[[nodiscard]] double chi_squared_tail(double x, double degrees);

// --- Residuals that resemble their neighbours in time ---

/// Correlation of `series` with itself `lag` samples later, about its mean: in [−1, 1]; 0 where the
/// series is constant or not longer than the lag.
[[nodiscard]] double autocorrelation(std::span<const double> series, std::size_t lag);

/// How many independent samples would average out as well as this correlated series does:
/// N/(1 + 2·Σρ_k), with the sum cut where neighbouring pairs ρ_2m + ρ_2m+1 stop being positive,
/// since beyond that it adds only noise (Geyer, Practical Markov Chain Monte Carlo, Statistical
/// Science 7, 1992, 473–483, section 3.3). At least 1 for a series that is not empty, and at most
/// N: an alternating series averages out even faster, but that is not claimed.
[[nodiscard]] double effective_sample_size(std::span<const double> series);

/// Number of cosines ν ≥ 1 for `long_run_covariance` of `samples` samples that are worth
/// `effective_samples` independent ones: 0.4·T^(2/3) (Lazarus, Lewis, Stock and Watson, HAR
/// Inference: Recommendations for Practice, Journal of Business & Economic Statistics 36, 2018,
/// 541–559).
///
/// That rule was tuned for a first-order autoregression with coefficient 0.7, worth (1 − 0.7)/(1 +
/// 0.7) of its samples. A log taken faster has more samples but no more information, and a fixed
/// rule in samples would let its bandwidth grow past the noise's own corner frequency. T is
/// therefore the number of samples the flight would have if it were taken just fast enough to be so
/// correlated, effective_samples·1.7/0.3, and never more than `samples`.
[[nodiscard]] std::size_t cosine_terms(double samples, double effective_samples);

/// Long-run covariance Ω = Σ_k E[z_t z_{t+k}ᵀ] of a vector series, so that Var(Σ z_t) ≈ N·Ω: the
/// average of the outer products of its first `terms` cosine coefficients
/// Λ_j = √(2/N)·Σ z_t·cos(πj(t − ½)/N) (the equal-weighted cosine estimator they recommend). It is
/// positive semidefinite, ignores the mean, and a statistic studentised with it has Student's t
/// distribution with `terms` degrees of freedom, which is why it is used here rather than
/// Newey–West's estimator: the uncertainty of Ω itself reaches the interval.
///
/// `rows` holds N rows of `columns` values, row after row; the result is columns × columns, row
/// after row. `terms` ≥ 1.
[[nodiscard]] std::vector<double> long_run_covariance(std::span<const double> rows,
                                                      std::size_t columns, std::size_t terms);

}  // namespace tethercalc
