#include "tethercalc/solve/constrained_minimum.hpp"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <random>
#include <stdexcept>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

bool is_logarithmic(const VariableRange& range) {
  return range.lo > 0 && range.hi >= 10 * range.lo;
}

/// In place of what is not finite: far above any objective, far below what overflows in sums.
constexpr double penalty_value = 1e30;
/// In place of a constraint that is not finite: ten times a gross violation.
constexpr double broken_constraint = 10;
constexpr double same_value = 1e-6;
/// Of a variable's range: about what a short descent leaves to go, and what starts are apart.
constexpr double same_place = 0.01;
constexpr double far_apart = 0.05;

/// A point as evaluated; coordinates in [0, 1].
struct Visited {
  std::vector<double> unit;
  double value = nan;
  double violation = infinity;

  [[nodiscard]] bool feasible() const {
    return violation <= constraint_tolerance && std::isfinite(value);
  }
  /// Feasible before infeasible, then by value or violation.
  [[nodiscard]] bool better_than(const Visited& other) const {
    if (feasible() != other.feasible()) return feasible();
    if (feasible()) return value < other.value;
    return violation < other.violation;
  }
};

/// The problem on the unit cube, which remembers the best point it ever saw.
class UnitProblem {
 public:
  explicit UnitProblem(const MinimumProblem& problem)
      : problem_(problem), constraints_(problem.constraint_count) {
    for (const VariableRange& range : problem.variables) {
      if (!std::isfinite(range.lo) || !std::isfinite(range.hi) || !(range.lo <= range.hi)) {
        throw std::invalid_argument("a variable's range must be finite and in order");
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return problem_.variables.size(); }

  [[nodiscard]] std::vector<double> actual(std::span<const double> unit) const {
    std::vector<double> x(unit.size());
    for (std::size_t i = 0; i < unit.size(); ++i) {
      x[i] = problem_.variables[i].at(std::clamp(unit[i], 0.0, 1.0));
    }
    return x;
  }

  Visited visit(std::span<const double> unit) {
    // COBYLA asks for the objective and for the constraints, one after the other.
    if (evaluations_ > 0 && std::ranges::equal(unit, last_.unit)) return last_;
    ++evaluations_;
    Visited point{{unit.begin(), unit.end()}, nan, 0};
    point.value = problem_.evaluate(actual(unit), constraints_);
    for (double& value : constraints_) {
      if (!std::isfinite(value)) value = broken_constraint;
      point.violation = std::max(point.violation, value);
    }
    // Where nothing is violated, what has no value is no answer either.
    if (!std::isfinite(point.value) && point.violation <= constraint_tolerance) point.violation = 1;
    if (best_.unit.empty() || point.better_than(best_)) best_ = point;
    last_ = point;
    return point;
  }

  /// Objective plus `weight` for each unit of violation; finite everywhere.
  double penalised(std::span<const double> unit, double weight) {
    const Visited point = visit(unit);
    double sum = 0;
    for (const double value : constraints_) sum += std::max(value, 0.0);
    const double value = std::isfinite(point.value) ? point.value : penalty_value;
    return std::min(value + weight * sum, penalty_value * (1 + sum));
  }

  [[nodiscard]] std::span<const double> last_constraints() const { return constraints_; }
  [[nodiscard]] const Visited& best() const { return best_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  const MinimumProblem& problem_;
  std::vector<double> constraints_;
  Visited best_;
  Visited last_;
  int evaluations_ = 0;
};

/// What NLopt calls back with.
struct Callback {
  UnitProblem* problem;
  double weight;  ///< of violations; 0: the constraints are passed on beside the objective;
                  ///< infinite: nothing but the largest violation counts
};

double objective_of(const std::vector<double>& x, std::vector<double>&, void* data) {
  const auto* callback = static_cast<Callback*>(data);
  if (std::isinf(callback->weight)) return callback->problem->visit(x).violation;
  if (callback->weight > 0) return callback->problem->penalised(x, callback->weight);
  const Visited point = callback->problem->visit(x);
  return std::isfinite(point.value) ? point.value : penalty_value;
}

void constraints_of(unsigned count, double* result, unsigned size, const double* x, double*,
                    void* data) {
  auto* callback = static_cast<Callback*>(data);
  (void)callback->problem->visit({x, size});
  std::copy_n(callback->problem->last_constraints().begin(), count, result);
}

/// One run of an NLopt algorithm. How it ended does not matter: the problem keeps the best point.
void run(nlopt::algorithm algorithm, UnitProblem& problem, std::vector<double> start, double step,
         double weight, int evaluations, double tolerance) {
  const auto size = static_cast<unsigned>(problem.size());
  nlopt::opt search(algorithm, size);
  search.set_lower_bounds(0.0);
  search.set_upper_bounds(1.0);
  search.set_maxeval(evaluations);
  search.set_xtol_abs(tolerance);
  search.set_ftol_rel(1e-15);
  Callback callback{&problem, weight};
  search.set_min_objective(objective_of, &callback);
  if (weight == 0 && !problem.last_constraints().empty()) {
    const std::vector<double> exact(problem.last_constraints().size(), 0.0);
    search.add_inequality_mconstraint(constraints_of, &callback, exact);
  }
  if (step > 0) search.set_initial_step(step);
  double value = 0;
  try {
    (void)search.optimize(start, value);
  } catch (const std::exception&) {
    // Rounding at the end of a search, and whatever else "nlopt failure" stands for.
  }
}

/// Points of the additive recurrence with the generalised golden ratio (Roberts 2018), shifted by
/// the seed: evenly spread in any number of dimensions.
std::vector<std::vector<double>> spread_points(std::size_t size, int count, std::uint64_t seed) {
  double ratio = 2;
  for (int i = 0; i < 60; ++i) {
    ratio = std::pow(1 + ratio, 1.0 / (static_cast<double>(size) + 1));
  }
  std::mt19937_64 random(seed);
  std::vector<double> shift(size);
  for (double& s : shift) s = static_cast<double>(random() >> 11) * 0x1p-53;
  std::vector<std::vector<double>> points;
  for (int n = 0; n < count; ++n) {
    std::vector<double> point(size);
    for (std::size_t i = 0; i < size; ++i) {
      const double whole = shift[i] + n * std::pow(ratio, -static_cast<double>(i + 1));
      point[i] = whole - std::floor(whole);
    }
    points.push_back(std::move(point));
  }
  return points;
}

double distance(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// The best of `points`, at most `count`, that lie further than `apart` from each other.
std::vector<Visited> distinct_best(std::vector<Visited> points, int count, double apart) {
  std::ranges::sort(points, [](const Visited& a, const Visited& b) { return a.better_than(b); });
  std::vector<Visited> chosen;
  for (const Visited& point : points) {
    if (static_cast<int>(chosen.size()) == count) break;
    const bool distinct = std::ranges::all_of(
        chosen, [&](const Visited& other) { return distance(point.unit, other.unit) > apart; });
    if (distinct) chosen.push_back(point);
  }
  return chosen;
}

/// A short COBYLA from `start`: how good the valley is that it lies in. Unevenly close to a bound
/// or a kink, the points of the global stage cannot tell themselves.
Visited descent(const MinimumProblem& source, const Visited& start, int evaluations, int& spent) {
  UnitProblem problem(source);
  (void)problem.visit(start.unit);
  run(nlopt::LN_COBYLA, problem, start.unit, 0.03, 0, evaluations, 1e-4);
  spent += problem.evaluations();
  return problem.best();
}

/// COBYLA and Sbplx from `start`, in turn with shrinking steps.
Visited local_search(const MinimumProblem& source, const Visited& start, int evaluations,
                     double step, int& spent) {
  UnitProblem problem(source);
  (void)problem.visit(start.unit);
  double last = nan;
  for (int round = 0; round < 6; ++round, step *= 0.1) {
    run(nlopt::LN_COBYLA, problem, problem.best().unit, step, 0, evaluations, 1e-13);
    const double scale = std::isfinite(problem.best().value) ? std::abs(problem.best().value) : 1;
    run(nlopt::LN_SBPLX, problem, problem.best().unit, step, 100 * scale + 1e-6, evaluations,
        1e-13);
    if (std::abs(problem.best().value - last) <= 1e-14 * scale) break;
    last = problem.best().value;
  }
  spent += problem.evaluations();
  return problem.best();
}

/// A search to the bottom.
struct LocalSearch {
  Visited start;
  Visited end;
};

/// How many of `descents` ended where a search began that led to `best`, or to its value.
int agreeing(const Visited& best, std::span<const Visited> descents,
             std::span<const LocalSearch> searches) {
  const double scale = std::max(std::abs(best.value), 1e-300);
  const auto leads_to_best = [&](const Visited& descent) {
    return std::ranges::any_of(searches, [&](const LocalSearch& search) {
      return search.end.feasible() &&
             std::abs(search.end.value - best.value) <= same_value * scale &&
             distance(search.start.unit, descent.unit) <= same_place;
    });
  };
  return static_cast<int>(std::ranges::count_if(descents, leads_to_best));
}

/// The least violation, from `start`: by how much a problem without a feasible point misses.
Visited least_violation(const MinimumProblem& source, const Visited& start, int evaluations,
                        int& spent) {
  UnitProblem problem(source);
  (void)problem.visit(start.unit);
  double last = infinity;
  for (double step = 0.1; step > 1e-6 && !problem.best().feasible(); step *= 0.1) {
    for (const auto algorithm : {nlopt::LN_SBPLX, nlopt::LN_COBYLA}) {
      run(algorithm, problem, problem.best().unit, step, infinity, evaluations, 1e-13);
    }
    if (last - problem.best().violation <= 1e-12) break;
    last = problem.best().violation;
  }
  spent += problem.evaluations();
  return problem.best();
}

}  // namespace

double VariableRange::at(double share) const {
  const double value =
      is_logarithmic(*this) ? lo * std::pow(hi / lo, share) : lo + (hi - lo) * share;
  return share == 1 ? hi : std::clamp(value, lo, hi);
}

double VariableRange::share_of(double value) const {
  if (!(hi > lo)) return 0;
  return is_logarithmic(*this) ? std::log(value / lo) / std::log(hi / lo)
                               : (value - lo) / (hi - lo);
}

Minimum constrained_minimum(const MinimumProblem& problem, const MinimumOptions& options) {
  UnitProblem global(problem);
  Minimum result;
  std::vector<Visited> visited;
  const auto size = global.size();
  if (size == 0) {
    visited.push_back(global.visit({}));
  } else {
    const int count = options.global_points * static_cast<int>(size);
    for (const auto& point : spread_points(size, count, options.seed)) {
      visited.push_back(global.visit(point));
    }
    // Corners, where many optima lie, and DIRECT-L's own idea of where to look.
    for (std::size_t corner = 0; corner < (std::size_t{1} << size); ++corner) {
      std::vector<double> point(size);
      for (std::size_t i = 0; i < size; ++i) point[i] = (corner >> i) & 1 ? 1.0 : 0.0;
      visited.push_back(global.visit(point));
    }
    const double scale = std::isfinite(global.best().value) ? std::abs(global.best().value) : 1;
    run(nlopt::GN_DIRECT_L, global, std::vector<double>(size, 0.5), 0, 100 * scale + 1e-6, count,
        1e-4);
    visited.push_back(global.best());
  }
  int spent = 0;
  Visited best = global.best();
  std::vector<Visited> descents;
  std::vector<LocalSearch> searches;
  if (size > 0) {
    for (const Visited& start : distinct_best(visited, options.descents, far_apart)) {
      descents.push_back(descent(problem, start, options.descent_evaluations, spent));
    }
    for (const Visited& start : distinct_best(descents, options.local_starts, same_place)) {
      searches.push_back(
          {start, local_search(problem, start, options.local_evaluations, 0.05, spent)});
      if (searches.back().end.better_than(best)) best = searches.back().end;
    }
    if (!best.feasible()) {
      for (const Visited& start : distinct_best(visited, options.local_starts, far_apart)) {
        const Visited end = least_violation(problem, start, options.local_evaluations, spent);
        if (end.better_than(best)) best = end;
      }
    }
    const Visited last = local_search(problem, best, 2 * options.local_evaluations, 1e-3, spent);
    if (last.better_than(best)) best = last;
  }
  result.starts = static_cast<int>(descents.size());
  result.agreeing = agreeing(best, descents, searches);
  result.evaluations = global.evaluations() + spent + 1;
  result.x = global.actual(best.unit);
  result.constraints.resize(problem.constraint_count);
  result.value = problem.evaluate(result.x, result.constraints);
  for (const double value : result.constraints) {
    result.violation = std::max(result.violation, std::isfinite(value) ? value : broken_constraint);
  }
  if (!std::isfinite(result.value) && result.violation <= constraint_tolerance) {
    result.outcome = MinimumOutcome::undefined;
  } else if (result.violation > constraint_tolerance) {
    result.outcome = MinimumOutcome::infeasible;
  } else {
    const bool sure = size == 0 || result.agreeing >= 2;
    result.outcome = sure ? MinimumOutcome::converged : MinimumOutcome::unconfirmed;
  }
  return result;
}

}  // namespace tethercalc
