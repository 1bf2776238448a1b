// The best whole design among those that free fields allow.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tethercalc/solve/constrained_minimum.hpp"
#include "tethercalc/solve/sweep_space.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// A design with its conductor and what it does; `area` NaN where no conductor meets the demands.
struct Candidate : AreaPoints {
  Design design;  ///< what it is
};

/// A member of an operating point, in the unit in which it is asked for.
struct PointQuantity {
  double OperatingPoint::*member = &OperatingPoint::total_power;  ///< which
  double si_factor = 1;                                           ///< SI value of the unit
  /// Where; nothing: a headroom where it is demanded, all else where power is minimised.
  std::optional<Condition> condition{};
};

/// A number that a candidate has: of its flight, or of its fields, in the unit in which it is asked
/// for. One of the fields must not hang on the cross-section.
using CandidateQuantity = std::variant<PointQuantity, std::function<double(const Design&)>>;

/// The number; not finite where it does not exist.
[[nodiscard]] double quantity_of(const Candidate& candidate, const CandidateQuantity& quantity);

/// A demand of the user: `sign`·(quantity − bound) ≤ 0.
struct UserLimit {
  std::string name;            ///< for messages
  CandidateQuantity quantity;  ///< what is bounded
  double bound = 0;            ///< in the unit of the quantity
  int sign = 1;                ///< 1: at most the bound, −1: at least
};

/// What is searched.
struct DesignProblem {
  Design base;  ///< what is not free
  /// What is free, each named by the dot path of the field that it sets, none twice: a `Uniform` is
  /// searched, on a logarithmic scale where it spans a decade; the others, which must have
  /// finitely many values, are enumerated.
  std::vector<SweepAxis> free;
  CandidateQuantity objective = PointQuantity{};  ///< to be minimised
  std::vector<UserLimit> limits;                  ///< beside the requirements of the design

  /// Whether a field is free.
  [[nodiscard]] bool frees(std::string_view path) const;
};

/// The dot path of the cross-section, in mm².
inline constexpr std::string_view cross_section_path = "tether.cross_section_mm2";

/// A demand on a candidate and how far it is kept.
struct DemandState {
  std::string name;      ///< "thrust_headroom in hover", or that of the user's limit
  double violation = 0;  ///< ≤ 0 where kept, relative to what is demanded
};

/// The answer.
struct DesignAnswer {
  bool feasible = false;            ///< whether any design meets all demands
  Candidate best;                   ///< or the one that violates the demands least
  std::vector<double> values;       ///< of `free` there; of named choices the position
  Minimum minimum;                  ///< of the search among the values that are not enumerated
  std::vector<DemandState> missed;  ///< where infeasible: the demands it violates, the worst first
  int combinations = 0;             ///< of what is enumerated
  int pruned = 0;                   ///< of these, not searched: a lower bound is above the best
  int evaluations = 0;              ///< of designs
};

/// The candidate that `design` becomes. With a cross-section in `tether.cross_section` it is that
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
