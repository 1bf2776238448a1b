// The least value of a function of a few variables under constraints, safely.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tethercalc {

/// One variable's range, both ends finite, lo ≤ hi. Where lo > 0 and hi ≥ 10·lo it is searched on a
/// logarithmic scale.
struct VariableRange {
  double lo = 0;  ///< the least
  double hi = 1;  ///< the greatest

  /// The value a `share` of the way, from 0 to 1, along the scale on which it is searched.
  [[nodiscard]] double at(double share) const;
  /// The share of the way at which `value` lies; 0 where there is no way.
  [[nodiscard]] double share_of(double value) const;
};

/// What is to be minimised. `evaluate` fills `constraints` with values that must be at most 0, each
/// scaled so that 1 is a gross violation, and returns the objective. Where something does not exist
/// it may return or fill in what is not finite: that counts as violated, never as an answer.
struct MinimumProblem {
  std::vector<VariableRange> variables;  ///< at most 8
  std::size_t constraint_count = 0;      ///< how many `evaluate` fills in
  /// The objective at `x`.
  std::function<double(std::span<const double> x, std::span<double> constraints)> evaluate;
};

/// How hard to look. The defaults find the optimum of two or three variables with kinks.
struct MinimumOptions {
  std::uint64_t seed = 1;   ///< of the points from which searches start; the answer does not hang
                            ///< on it
  int global_points = 500;  ///< points a variable spread over the whole range, in the global stage
  int descents = 16;        ///< best of them, apart from each other, from which to go some way down
  int descent_evaluations = 60;  ///< per descent
  int local_starts = 4;          ///< best of where descents end, apart, to search to the bottom
  int local_evaluations = 600;   ///< per local search and stage
};

/// How a search ended.
enum class MinimumOutcome {
  converged,    ///< two descents at least lead to the best point, or there is no variable
  unconfirmed,  ///< feasible, but a single descent leads there: it may be no global optimum
  infeasible,   ///< no feasible point was found: `x` violates the constraints least
  undefined,    ///< the objective or a constraint is finite nowhere that was looked
};

/// What was found.
struct Minimum {
  MinimumOutcome outcome = MinimumOutcome::undefined;  ///< how it ended
  std::vector<double> x;            ///< the best point, or the least infeasible one
  double value = 0;                 ///< the objective there; NaN where undefined
  std::vector<double> constraints;  ///< there, from a last evaluation of its own
  double violation = 0;             ///< the largest constraint, 0 where all are kept
  int starts = 0;                   ///< descents
  int agreeing = 0;                 ///< those that lead to the best value, to 1e-6
  int evaluations = 0;              ///< of the problem
};

/// Constraints are kept to this much.
inline constexpr double constraint_tolerance = 1e-9;

/// The least value, by a global stage (points spread evenly, then NLopt's DIRECT-L on an exact
/// penalty), short descents from the best of them, a local stage from where the best of those end
/// (COBYLA with the constraints themselves, then Sbplx on the penalty), and a last search around
/// the best point. The descents are there because the best points alone may all lie in one valley,
/// by the luck of falling close to a bound or kink. Only points that were evaluated, feasible and
/// finite can be answers: what NLopt itself returns is not relied on. Throws std::invalid_argument
/// for ranges that are not finite or not in order.
[[nodiscard]] Minimum constrained_minimum(const MinimumProblem& problem,
                                          const MinimumOptions& options = {});

}  // namespace tethercalc
