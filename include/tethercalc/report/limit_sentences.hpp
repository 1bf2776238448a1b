// What limits a design, in words.
#pragma once

#include <string>

#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// "hover" or "forward flight".
[[nodiscard]] std::string condition_words(Condition condition);

/// Why a cable cannot be used in this design, in a few words; empty where it can.
[[nodiscard]] std::string shortcoming(const Design& design, const AreaPoints& points);

/// Why the optimum is where it is. For a feasible result.
[[nodiscard]] std::string limit_sentence(const Design& design, const Optimization& result);

/// What binds where this demand does: "The converter's rated 450 W".
[[nodiscard]] std::string demand_words(const Design& design, Demand demand);

/// What happens where this limit is passed: "the converter's rating is passed in hover".
[[nodiscard]] std::string beyond_words(const Design& design, Limit limit, Condition where);

/// Why there is no optimum, with the best that can be reached.
[[nodiscard]] std::string refusal_sentence(const Design& design, const Refusal& refusal);

/// The same in a few words, for a table.
[[nodiscard]] std::string refusal_words(const Design& design, const Refusal& refusal);

}  // namespace tethercalc
