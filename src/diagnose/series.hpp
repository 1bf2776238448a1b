// Small statistics of series.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace tethercalc {

/// Median absolute deviation of a normal distribution over its standard deviation, inverted.
inline constexpr double mad_to_sigma = 1.4826;

/// The median, of an even number the upper one; 0 of none.
[[nodiscard]] inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Element by element.
[[nodiscard]] inline std::vector<double> product(std::vector<double> a,
                                                 const std::vector<double>& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::multiplies<>());
  return a;
}

}  // namespace tethercalc
