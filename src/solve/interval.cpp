#include "tethercalc/solve/interval.hpp"

#include <algorithm>

namespace tethercalc {

bool contains(const IntervalSet& set, double x) {
  return std::any_of(set.begin(), set.end(), [x](const Interval& i) { return i.contains(x); });
}

IntervalSet intersection(const IntervalSet& a, const IntervalSet& b) {
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

void append(IntervalSet& set, Interval next) {
  if (!set.empty() && set.back().hi >= next.lo) {
    set.back().hi = std::max(set.back().hi, next.hi);
  } else {
    set.push_back(next);
  }
}

}  // namespace tethercalc
