// Small statistics of series, and the distributions that errors are held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
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

/// Whether `value` is among `values`.
template <typename T, typename Value>
[[nodiscard]] bool contains(const std::vector<T>& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// Element by element.
[[nodiscard]] inline std::vector<double> product(std::vector<double> a,
                                                 const std::vector<double>& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::multiplies<>());
  return a;
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

}  // namespace tethercalc
