// The best whole design among those that free fields of a spec allow.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/solve/constrained_minimum.hpp"

namespace tethercalc {

/// A design with its conductor and what it does.
struct Candidate {
  Design design;           ///< what it is
  double area = 0;         ///< m²; NaN where no conductor meets the demands
  OperatingPoint hover;    ///< at that area
  OperatingPoint forward;  ///< at that area
};

/// A number that a candidate has, in the unit in which it is asked for.
using CandidateQuantity = std::function<double(const Candidate&)>;

/// A field free within a range.
struct FreeRange {
  std::string name;                          ///< for messages
  VariableRange range;                       ///< in the unit that `set` takes
  std::function<void(Design&, double)> set;  ///< puts a value into a design
};

/// A field free among alternatives.
struct FreeChoice {
  /// One of them.
  struct Alternative {
    std::string label;                   ///< for messages
    std::function<void(Design&)> apply;  ///< puts it into a design
  };
  std::string name;                       ///< for messages
  std::vector<Alternative> alternatives;  ///< one at least
};

/// A demand of the user: `sign`·(quantity − bound) ≤ 0.
struct UserLimit {
  std::string name;            ///< as written
  CandidateQuantity quantity;  ///< what is bounded
  double bound = 0;            ///< in the unit of the quantity
  int sign = 1;                ///< 1: at most the bound, −1: at least
};

/// What is searched.
struct DesignProblem {
  Design base;                      ///< what is not free
  std::vector<FreeRange> ranges;    ///< searched
  std::vector<FreeChoice> choices;  ///< enumerated
  CandidateQuantity objective;      ///< to be minimised
  std::vector<UserLimit> limits;    ///< beside the requirements of the design

  /// A lower bound of the objective for a design whose ranges are not yet chosen, by which choices
  /// are discarded unsearched; none: nothing is discarded.
  std::function<double(const Design&)> lower_bound{};
};

/// What one combination of choices came to.
struct ChoiceResult {
  std::vector<std::size_t> choice;  ///< index of the alternative, in the order of `choices`
  bool pruned = false;              ///< its lower bound is above the best known: not searched
  Minimum minimum;                  ///< of its ranges
};

/// A demand on a candidate and how far it is kept.
struct DemandState {
  std::string name;      ///< "thrust_headroom in hover", or as the user wrote it
  double violation = 0;  ///< ≤ 0 where kept, relative to what is demanded
};

/// The answer.
struct DesignAnswer {
  bool feasible = false;            ///< whether any design meets all demands
  Candidate best;                   ///< or the one that violates the demands least
  std::vector<std::size_t> choice;  ///< index of the alternative, in the order of `choices`
  Minimum minimum;                  ///< of that choice
  std::vector<DemandState> missed;  ///< where infeasible: the demands it violates, the worst first
  std::vector<ChoiceResult> all;    ///< every combination
  int pruned = 0;                   ///< combinations not searched
  int evaluations = 0;              ///< of designs
};

/// The candidate that `base` becomes. With a cross-section in `tether.cross_section` it is that
/// cable; without, the conductor of least power that meets the requirements or, where none does,
/// the one with the best headroom.
[[nodiscard]] Candidate candidate_of(Design design);

/// All demands: the requirements of the design, then `limits`. What does not exist is violated
/// by 1.
[[nodiscard]] std::vector<DemandState> demand_states(const Candidate& candidate,
                                                     const std::vector<UserLimit>& limits);

/// Enumerates the choices, the most promising lower bound first, and searches the ranges of each
/// with `constrained_minimum`. Deterministic for a seed.
[[nodiscard]] DesignAnswer search_design(const DesignProblem& problem,
                                         const MinimumOptions& options = {});

}  // namespace tethercalc
