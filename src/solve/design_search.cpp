#include "tethercalc/solve/design_search.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "solve/cable_limits.hpp"
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

/// Demands in a fixed number and order: for each condition headroom, tilt, temperature, strength,
/// rating, and that the converter stands the supply; then the user's.
std::vector<DemandState> all_demands(const Candidate& candidate,
                                     const std::vector<UserLimit>& limits) {
  std::vector<DemandState> states;
  const Design& design = candidate.design;
  const bool exists = std::isfinite(candidate.area);
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    for (const Limit limit :
         {Limit::available_power, Limit::max_pitch, Limit::conductor_temperature,
          Limit::tether_strength, Limit::converter_rating}) {
      states.push_back({std::string(demand_name(limit)) +
                            (condition == Condition::hover ? " in hover" : " in forward flight"),
                        exists ? -1.0 : 1.0});
    }
  }
  if (exists) {
    for (const Margin& margin : requirement_margins(design, candidate.hover, candidate.forward)) {
      const std::string name =
          std::string(demand_name(margin.limit)) +
          (margin.condition == Condition::hover ? " in hover" : " in forward flight");
      const auto state = std::find_if(states.begin(), states.end(),
                                      [&](const DemandState& s) { return s.name == name; });
      state->violation = -margin.value;
    }
  }
  const Converter& converter = design.supply.converter;
  const double voltage = design.supply.voltage;
  states.push_back(
      {"converter input voltage",
       std::max(converter.max_input_voltage ? voltage / *converter.max_input_voltage - 1 : -1,
                converter.min_input_voltage / voltage - 1)});
  for (const UserLimit& limit : limits) {
    const double value = exists ? limit.quantity(candidate) : nan;
    const double scale = std::max(std::abs(limit.bound), 1e-3);
    const double violation = limit.sign * (value - limit.bound) / scale;
    states.push_back({limit.name, std::isfinite(violation) ? violation : 1.0});
  }
  return states;
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
  result.constraint_count = 11 + problem.limits.size();
  result.evaluate = [&problem, &chosen](std::span<const double> x, std::span<double> constraints) {
    const Candidate candidate = candidate_of(with_ranges(problem, chosen, x));
    const std::vector<DemandState> states = all_demands(candidate, problem.limits);
    for (std::size_t i = 0; i < constraints.size(); ++i) constraints[i] = states[i].violation;
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
    candidate.area = optimum.feasible ? optimum.area : nan;
    candidate.hover = optimum.hover;
    candidate.forward = optimum.forward;
  }
  candidate.design = std::move(design);
  return candidate;
}

std::vector<DemandState> demand_states(const Candidate& candidate,
                                       const std::vector<UserLimit>& limits) {
  return all_demands(candidate, limits);
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
  const std::vector<DemandState> states = all_demands(answer.best, problem.limits);
  const auto worst = std::max_element(
      states.begin(), states.end(),
      [](const DemandState& a, const DemandState& b) { return a.violation < b.violation; });
  answer.most_violated = worst->name;
  answer.most_violation = worst->violation;
  return answer;
}

}  // namespace tethercalc
