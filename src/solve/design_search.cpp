#include "tethercalc/solve/design_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "solve/cable_limits.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const char* demand_name(Limit limit) {
  switch (limit) {
    case Limit::max_pitch:
      return "max_pitch";
    case Limit::conductor_temperature:
      return "conductor_temperature";
    case Limit::tether_strength:
      return "tether_strength";
    case Limit::converter_rating:
      return "converter_rating";
    default:
      return "thrust_headroom";
  }
}

constexpr std::array requirement_order{Limit::available_power, Limit::max_pitch,
                                       Limit::conductor_temperature, Limit::tether_strength,
                                       Limit::converter_rating};
/// The requirements in both conditions, and the range of the converter's input.
constexpr std::size_t fixed_demands = 2 * requirement_order.size() + 1;

std::size_t demand_index(const Margin& margin) {
  const auto found = std::find(requirement_order.begin(), requirement_order.end(), margin.limit);
  const auto first = margin.condition == Condition::hover ? 0 : requirement_order.size();
  return first + static_cast<std::size_t>(found - requirement_order.begin());
}

/// How far every demand is violated: fixed_demands of them, then the user's.
void fill_violations(const Candidate& candidate, const std::vector<UserLimit>& limits,
                     std::span<double> violations) {
  const bool exists = std::isfinite(candidate.area);
  std::fill(violations.begin(), violations.end(), exists ? -1.0 : 1.0);
  if (exists) {
    for (const Margin& margin :
         requirement_margins(candidate.design, candidate.hover, candidate.forward)) {
      violations[demand_index(margin)] = -margin.value;
    }
  }
  const Converter& converter = candidate.design.supply.converter;
  const double voltage = candidate.design.supply.voltage;
  violations[fixed_demands - 1] =
      std::max(converter.max_input_voltage ? voltage / *converter.max_input_voltage - 1 : -1,
               lowest_input_voltage(converter) / voltage - 1);
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
    for (const Limit limit : requirement_order) {
      states.push_back({std::string(demand_name(limit)) + condition, 0});
    }
  }
  states.push_back({"converter input voltage", 0});
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
  answer.best =
      candidate_of(with_ranges(problem, with_choice(problem, answer.choice), answer.minimum.x));
  const std::vector<DemandState> states = demand_states(answer.best, problem.limits);
  const auto worst = std::max_element(
      states.begin(), states.end(),
      [](const DemandState& a, const DemandState& b) { return a.violation < b.violation; });
  answer.most_violated = worst->name;
  answer.most_violation = worst->violation;
  return answer;
}

}  // namespace tethercalc
