// Which effects a record with well-known noise needs, by comparing whole subsets of the catalogue.
#pragma once

#include "diagnose/selection.hpp"

namespace tethercalc {

/// Like `select_effects`, for rows whose noise is independent and of size 1, so that held-out
/// squared errors can be compared by likelihood.
///
/// Every candidate is fitted, every two that move the same rows, larger ones around the best (beam
/// search): a greedy first step can be wrong where two effects cancel or mimic a third together. Of
/// all models the one with the least description length wins: held-out squared error, plus for each
/// effect 2·ln(candidates/α), plus for each unnamed shape 2·ln(shapes/α), the price of having
/// picked one out of so many (Rissanen 1978; with α the chance of a false alarm, since χ² exceeds
/// 2·ln(1/p) with probability below p). Shapes without a name cost more than names, so a name wins
/// where both explain equally well, and a shape wins where it takes two wrong names to mimic it.
///
/// `SelectionOptions::false_alarm_probability` is α, for named and for unnamed ones each. Names
/// that gain less than `least_gain_percent` of the record's held-out error beside all others go
/// last. Throws as `select_effects` does.
[[nodiscard]] Selection select_subset(const SelectionProblem& problem,
                                      const SelectionOptions& options,
                                      const SelectionProgress& progress);

}  // namespace tethercalc
