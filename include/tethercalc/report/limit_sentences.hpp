// What limits a design, in words.
#pragma once

#include <string>

#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {

/// "hover" or "forward flight".
[[nodiscard]] std::string condition_words(Condition condition);

/// What a design misses at `point`, in a few words.
[[nodiscard]] std::string missed_words(const Design& design, const OperatingPoint& point,
                                       const DemandMargin& missed);

/// Why the optimum is where it is. For a feasible result.
[[nodiscard]] std::string limit_sentence(const Design& design, const Optimization& result);

/// Why there is no optimum, with the best that can be reached. For an infeasible result.
[[nodiscard]] std::string infeasible_sentence(const Design& design, const Optimization& result);

/// The same in a few words, for a table.
[[nodiscard]] std::string infeasible_words(const Design& design, const Optimization& result);

}  // namespace tethercalc
