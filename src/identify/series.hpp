// Small statistics of series.
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

}  // namespace tethercalc
