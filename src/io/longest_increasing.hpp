// Which of a series of times to keep where some are wrong.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tethercalc {

/// Indices of a longest strictly increasing subsequence of `values`, in order: the fewest elements
/// are left out. So one time that jumps ahead costs one sample and not all that follow it.
/// O(n log n) (Fredman, "On computing the length of longest increasing subsequences", Discrete
/// Mathematics 11, 1975). Values must not be NaN.
std::vector<std::size_t> longest_increasing(std::span<const double> values);

}  // namespace tethercalc
