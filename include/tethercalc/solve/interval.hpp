// Sets of conductor cross-sections.
#pragma once

#include <algorithm>
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
[[nodiscard]] inline bool contains(const IntervalSet& set, double x) {
  return std::ranges::any_of(set, [x](const Interval& i) { return i.contains(x); });
}

/// Appends `next`, which must not begin before the set's last interval ends; joins the two where
/// they touch.
inline void append(IntervalSet& set, Interval next) {
  if (!set.empty() && set.back().hi >= next.lo) {
    set.back().hi = std::max(set.back().hi, next.hi);
  } else {
    set.push_back(next);
  }
}

/// What lies in both.
[[nodiscard]] inline IntervalSet intersection(const IntervalSet& a, const IntervalSet& b) {
  IntervalSet common;
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() && j != b.end()) {
    const Interval shared{std::max(i->lo, j->lo), std::min(i->hi, j->hi)};
    if (shared.lo <= shared.hi) append(common, shared);
    (i->hi < j->hi ? i : j)++;
  }
  return common;
}

}  // namespace tethercalc
