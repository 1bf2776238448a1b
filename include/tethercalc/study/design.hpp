// The best whole design among those that free fields allow, what binds it, and what more of
// something would change.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

  /// What a miss is measured against, in the unit of the quantity: the bound, or next to 0 some
  /// number.
  [[nodiscard]] double scale() const { return std::max(std::abs(bound), 1e-3); }
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
  std::string name;       ///< "thrust_headroom in hover", or that of the user's limit
  double violation = 0;   ///< ≤ 0 where kept, relative to what is demanded
  bool is_typed = false;  ///< a limit of the user's
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

/// What a price is that of.
enum class Priced {
  limit,      ///< a demand of the user that binds
  range_end,  ///< an end of a range at which the optimum lies
  demand,     ///< a demand of the design that binds
  field,      ///< a field of the design that is not free
};

/// What one more of something costs at the optimum, everything that is free adapting to it.
struct ShadowPrice {
  Priced of = Priced::field;                ///< what kind
  bool high_end = false;                    ///< of a range
  Demand demand = Demand::thrust_headroom;  ///< which binds
  std::string name{};  ///< that of the limit, or the dot path of the field that is moved
  double step = 1;     ///< by how much, in the unit of the field
  double price = 0;    ///< change of the objective; NaN where no design is left

  /// Whether it binds; a field is just there.
  [[nodiscard]] bool active() const { return of != Priced::field; }
};

/// One point of a Pareto front.
struct FrontPoint {
  double first = 0;            ///< the first quantity, which was minimised
  double second = 0;           ///< the second, which was bounded
  std::vector<double> values;  ///< as in DesignAnswer
};

/// What is asked.
struct DesignQuestion {
  DesignProblem problem;  ///< what is searched
  /// Two quantities of which a front is wanted.
  std::optional<std::array<CandidateQuantity, 2>> front{};
  MinimumOptions search{};  ///< how hard
};

/// The answer.
struct DesignStudy {
  DesignProblem problem;            ///< as searched: with the cross-section freed where it decides
  DesignAnswer answer;              ///< the best design
  std::vector<ShadowPrice> prices;  ///< what binds first; empty where infeasible
  std::vector<FrontPoint> front;    ///< by falling second quantity; empty where none was asked for
  std::optional<GroundContact> ground;  ///< of the best design's cable
  std::optional<WorstSide> side;        ///< of the best design
};

/// Searches the design and prices what holds it. A cross-section that is neither given nor free is
/// the one of least power that meets the requirements where that is what is asked for, else it is
/// searched beside the free fields from 0.01 to 100 mm².
[[nodiscard]] DesignStudy study_design(const DesignQuestion& question);

}  // namespace tethercalc
