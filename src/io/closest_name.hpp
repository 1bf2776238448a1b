// The name somebody probably meant.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tethercalc {

/// Number of insertions, deletions, replacements and swaps of neighbouring letters between `a` and
/// `b`, where no letter is edited twice (optimal string alignment; Damerau 1964). Upper and lower
/// case count as equal.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`: by edit distance where that is at most a third of the longer
/// name (more and the guess would be noise), otherwise the shortest candidate that contains the
/// name or is contained in it (three letters at least). Ties go to the earlier candidate.
std::optional<std::string> closest_name(std::string_view name,
                                        std::span<const std::string> candidates);

/// "; did you mean "X"?" or nothing: what a message about an unknown name ends with.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace tethercalc
