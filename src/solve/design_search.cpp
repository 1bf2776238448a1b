#include "tethercalc/solve/design_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>

#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The demands of the design in both conditions.
constexpr std::size_t fixed_demands = 2 * demand_count;

std::size_t index_of(Demand demand, Condition condition) {
  return static_cast<std::size_t>(demand) + (condition == Condition::hover ? 0 : demand_count);
}

/// How far every demand is violated: fixed_demands of them, then the user's.
void fill_violations(const Candidate& candidate, const std::vector<UserLimit>& limits,
                     std::span<double> violations) {
  const bool exists = std::isfinite(candidate.area);
  std::fill(violations.begin(), violations.end(), exists ? -1.0 : 1.0);
  if (exists) {
    for (const DemandMargin& margin :
         demand_margins(candidate.design, candidate.hover, candidate.forward)) {
      violations[index_of(margin.demand, margin.condition)] = -margin.value;
    }
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const UserLimit& limit = limits[i];
    const double value = exists ? limit.quantity(candidate) : nan;
    const double scale = std::max(std::abs(limit.bound), 1e-3);
    // Shifted by the tolerance, so that what counts as kept is kept to the last digit.
    const double violation = limit.sign * (value - limit.bound) / scale + constraint_tolerance;
    violations[fixed_demands + i] = std::isfinite(violation) ? violation : 1.0;
  }
}

/// Every combination of alternatives.
std::vector<std::vector<std::size_t>> combinations(const std::vector<FreeChoice>& choices) {
  std::vector<std::vector<std::size_t>> all{{}};
  for (const FreeChoice& choice : choices) {
    std::vector<std::vector<std::size_t>> longer;
    for (const auto& head : all) {
      for (std::size_t i = 0; i < choice.alternatives.size(); ++i) {
        longer.push_back(head);
        longer.back().push_back(i);
      }
    }
    all = std::move(longer);
  }
  return all;
}

Design with_choice(const DesignProblem& problem, const std::vector<std::size_t>& choice) {
  Design design = problem.base;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    problem.choices[i].alternatives[choice[i]].apply(design);
  }
  return design;
}

Design with_ranges(const DesignProblem& problem, Design design, std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) problem.ranges[i].set(design, x[i]);
  return design;
}

MinimumProblem minimum_problem(const DesignProblem& problem, const Design& chosen) {
  MinimumProblem result;
  for (const FreeRange& free : problem.ranges) result.variables.push_back(free.range);
  result.constraint_count = fixed_demands + problem.limits.size();
  result.evaluate = [&problem, &chosen](std::span<const double> x, std::span<double> constraints) {
    const Candidate candidate = candidate_of(with_ranges(problem, chosen, x));
    fill_violations(candidate, problem.limits, constraints);
    return std::isfinite(candidate.area) ? problem.objective(candidate) : nan;
  };
  return result;
}

bool is_feasible(const Minimum& minimum) {
  return minimum.outcome == MinimumOutcome::converged ||
         minimum.outcome == MinimumOutcome::unconfirmed;
}

bool better(const Minimum& a, const Minimum& b) {
  if (is_feasible(a) != is_feasible(b)) return is_feasible(a);
  return is_feasible(a) ? a.value < b.value : a.violation < b.violation;
}

/// `x` with as few digits as leave the answer as good: 120 instead of 119.99999998741927.
void write_short(const MinimumProblem& problem, Minimum& minimum) {
  std::vector<double> constraints(problem.constraint_count);
  for (std::size_t i = 0; i < minimum.x.size(); ++i) {
    const double exact = minimum.x[i];
    for (int digits = 3; digits < 15; ++digits) {
      std::vector<double> x = minimum.x;
      x[i] = std::strtod(fmt::format("{:.{}g}", exact, digits).c_str(), nullptr);
      if (x[i] == exact) break;
      if (x[i] < problem.variables[i].lo || x[i] > problem.variables[i].hi) continue;
      const double value = problem.evaluate(x, constraints);
      const bool kept = std::all_of(constraints.begin(), constraints.end(),
                                    [](double c) { return c <= constraint_tolerance; });
      constexpr double as_good = 1e-13;
      if (!kept || !(value <= minimum.value + as_good * std::abs(minimum.value))) continue;
      minimum.x = std::move(x);
      minimum.value = value;
      minimum.constraints = constraints;
      break;
    }
  }
}

}  // namespace

Candidate candidate_of(Design design) {
  Candidate candidate;
  if (design.tether.cross_section) {
    candidate.area = *design.tether.cross_section;
    candidate.hover = evaluate(design, candidate.area, Condition::hover);
    candidate.forward = evaluate(design, candidate.area, Condition::forward);
  } else {
    const Optimization optimum = optimize(design);
    if (optimum.feasible) {
      candidate.area = optimum.area;
      candidate.hover = optimum.hover;
      candidate.forward = optimum.forward;
    } else {
      // Nearest to feasible, so that it can be told by how much the demands are missed.
      candidate.area = best_headroom(design, design.requirements.headroom_at).area;
      if (std::isfinite(candidate.area)) {
        candidate.hover = evaluate(design, candidate.area, Condition::hover);
        candidate.forward = evaluate(design, candidate.area, Condition::forward);
      }
    }
  }
  candidate.design = std::move(design);
  return candidate;
}

std::vector<DemandState> demand_states(const Candidate& candidate,
                                       const std::vector<UserLimit>& limits) {
  std::vector<double> violations(fixed_demands + limits.size());
  fill_violations(candidate, limits, violations);
  std::vector<DemandState> states;
  for (const char* condition : {" in hover", " in forward flight"}) {
    for (std::size_t i = 0; i < demand_count; ++i) {
      states.push_back({std::string(demand_name(static_cast<Demand>(i))) + condition, 0});
    }
  }
  for (const UserLimit& limit : limits) states.push_back({limit.name, 0});
  for (std::size_t i = 0; i < states.size(); ++i) states[i].violation = violations[i];
  return states;
}

DesignAnswer search_design(const DesignProblem& problem, const MinimumOptions& options) {
  DesignAnswer answer;
  struct Entry {
    std::vector<std::size_t> choice;
    double bound;
  };
  std::vector<Entry> entries;
  for (auto& choice : combinations(problem.choices)) {
    const double bound =
        problem.lower_bound ? problem.lower_bound(with_choice(problem, choice)) : -infinity;
    entries.push_back({std::move(choice), bound});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.bound < b.bound; });
  bool any = false;
  for (const Entry& entry : entries) {
    ChoiceResult result{entry.choice, false, {}};
    if (any && is_feasible(answer.minimum) && entry.bound > answer.minimum.value) {
      result.pruned = true;
      ++answer.pruned;
    } else {
      const Design chosen = with_choice(problem, entry.choice);
      result.minimum = constrained_minimum(minimum_problem(problem, chosen), options);
      answer.evaluations += result.minimum.evaluations;
      if (!any || better(result.minimum, answer.minimum)) {
        answer.minimum = result.minimum;
        answer.choice = entry.choice;
      }
      any = true;
    }
    answer.all.push_back(std::move(result));
  }
  answer.feasible = is_feasible(answer.minimum);
  const Design chosen = with_choice(problem, answer.choice);
  if (answer.feasible) write_short(minimum_problem(problem, chosen), answer.minimum);
  answer.best = candidate_of(with_ranges(problem, chosen, answer.minimum.x));
  if (!answer.feasible) {
    answer.missed = demand_states(answer.best, problem.limits);
    std::erase_if(answer.missed,
                  [](const DemandState& d) { return d.violation <= constraint_tolerance; });
    std::stable_sort(
        answer.missed.begin(), answer.missed.end(),
        [](const DemandState& a, const DemandState& b) { return a.violation > b.violation; });
  }
  return answer;
}

}  // namespace tethercalc
