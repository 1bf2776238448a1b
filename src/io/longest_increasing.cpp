#include "io/longest_increasing.hpp"

#include <algorithm>

namespace tethercalc {

std::vector<std::size_t> longest_increasing(std::span<const double> values) {
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> ends;  // ends[k]: where the lowest-ending run of k + 1 values ends
  std::vector<std::size_t> before(values.size(), none);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto place =
        std::ranges::lower_bound(ends, values[i], {}, [&](std::size_t end) { return values[end]; });
    if (place != ends.begin()) before[i] = *(place - 1);
    if (place == ends.end()) {
      ends.push_back(i);
    } else {
      *place = i;
    }
  }
  std::vector<std::size_t> kept(ends.size());
  std::size_t at = ends.empty() ? none : ends.back();
  for (std::size_t k = kept.size(); k > 0; --k) {
    kept[k - 1] = at;
    at = before[at];
  }
  return kept;
}

}  // namespace tethercalc
