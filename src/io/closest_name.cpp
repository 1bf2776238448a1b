#include "io/closest_name.hpp"

#include <algorithm>
#include <vector>

#include "io/letters.hpp"

namespace tethercalc {
namespace {

// Names are short; a longer one is no slip of the pen, and comparing it would cost its square.
constexpr std::size_t longest_compared = 100;

bool contains(const std::string& outer, const std::string& inner) {
  return inner.size() >= 3 && outer.find(inner) != std::string::npos;
}

}  // namespace

std::size_t edit_distance(std::string_view first, std::string_view second) {
  const std::string a = lower_case(first);
  const std::string b = lower_case(second);
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::optional<std::string> closest_name(std::string_view name,
                                        std::span<const std::string> candidates) {
  if (name.empty() || name.size() > longest_compared) return std::nullopt;
  const std::string wanted = lower_case(name);
  const std::string* nearest = nullptr;
  const std::string* containing = nullptr;
  std::size_t least = 0;
  for (const std::string& candidate : candidates) {
    const std::string known = lower_case(candidate);
    const std::size_t distance = edit_distance(wanted, known);
    const bool near = 3 * distance <= std::max(wanted.size(), known.size());
    if (near && (nearest == nullptr || distance < least)) {
      nearest = &candidate;
      least = distance;
    }
    const bool related = contains(known, wanted) || contains(wanted, known);
    if (related && (containing == nullptr || candidate.size() < containing->size())) {
      containing = &candidate;
    }
  }
  if (nearest != nullptr) return *nearest;
  if (containing != nullptr) return *containing;
  return std::nullopt;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  const std::optional<std::string> closest = closest_name(name, candidates);
  return closest ? "; did you mean \"" + *closest + "\"?" : std::string();
}

}  // namespace tethercalc
