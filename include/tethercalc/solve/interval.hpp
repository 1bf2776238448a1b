// Sets of conductor cross-sections.
#pragma once

#include <vector>

namespace tethercalc {

/// A closed range, lo ≤ hi; hi may be +infinity.
struct Interval {
  double lo = 0;  ///< m²
  double hi = 0;  ///< m²

  /// Whether `x` lies in it, its ends included.
  [[nodiscard]] bool contains(double x) const { return lo <= x && x <= hi; }
};

/// Disjoint intervals in rising order.
using IntervalSet = std::vector<Interval>;

/// Whether `x` lies in any interval of `set`, ends included.
[[nodiscard]] bool contains(const IntervalSet& set, double x);

/// What lies in both.
[[nodiscard]] IntervalSet intersection(const IntervalSet& a, const IntervalSet& b);

/// Appends `next`, which must not begin before the set's last interval ends; joins the two where
/// they touch.
void append(IntervalSet& set, Interval next);

}  // namespace tethercalc
