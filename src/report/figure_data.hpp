// From results to what stands on axes: ranges, and series thin enough to be drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

/// Colour and dashes of the curve with that index: together they tell 35 apart.
[[nodiscard]] Colour curve_colour(std::size_t index);
[[nodiscard]] Dash curve_dash(std::size_t index);

/// The line at zero of the vertical axis.
[[nodiscard]] inline Reference zero_line() { return {.at = 0}; }

/// One number of each of `rows`.
template <typename Row>
[[nodiscard]] std::vector<double> column(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> out;
  for (const Row& row : rows) out.push_back(row.*member);
  return out;
}

/// A range that leaves `margin` of its length free on both sides of `range`; where that is empty,
/// one around it.
[[nodiscard]] inline Range with_margin(Range range, double margin = 0.05) {
  const auto [lo, hi] = range;
  const double length = hi > lo ? hi - lo : hi != 0 ? std::abs(hi) : 1;
  return {lo - margin * length, hi + margin * length};
}

/// From the lesser beginning to the greater end.
[[nodiscard]] inline Range joint(Range a, Range b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// The least and greatest finite value; {0, 1} where there is none.
[[nodiscard]] Range extent(std::span<const double> values);

/// The extent of `values` with a margin, but for the rare ones (`outlying` of them at either end)
/// that would flatten all the others: it reaches to those only as far as a quarter of the length
/// of the rest.
[[nodiscard]] Range bulk(std::span<const double> values, double outlying = 0.003);

/// Columns of a series.
struct Series {
  std::vector<double> x;
  std::vector<double> y;
};

/// A series thinned for drawing: of every one of `bins` equal stretches of `x` the first, least,
/// greatest and last point, in their order, so that the drawn line covers what the whole one would.
/// Gaps of more than five times the mean step become a gap in the line. `x` rises.
[[nodiscard]] Series outline(std::span<const double> x, std::span<const double> y,
                             std::size_t bins = 300);

/// Every how manieth of `samples` is drawn so that there are at most `most`.
[[nodiscard]] inline std::size_t thinning(std::size_t samples, std::size_t most) {
  return samples <= most ? 1 : (samples + most - 1) / most;
}

}  // namespace tethercalc::plot
