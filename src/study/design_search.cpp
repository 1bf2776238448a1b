#include "tethercalc/study/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

#include "model/constants.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

/// The demands of the design in both conditions.
constexpr std::size_t fixed_demands = 2 * demand_count;

/// How far every demand is violated: fixed_demands of them, then the user's.
void fill_violations(const Candidate& candidate, const std::vector<UserLimit>& limits,
                     std::span<double> violations) {
  const bool exists = std::isfinite(candidate.area);
  std::ranges::fill(violations, exists ? -1.0 : 1.0);
  if (exists) {
    for (const DemandMargin& margin :
         demand_margins(candidate.design, candidate.hover, candidate.forward)) {
      const std::size_t first = margin.condition == Condition::hover ? 0 : demand_count;
      violations[first + static_cast<std::size_t>(margin.demand)] = -margin.value;
    }
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const UserLimit& limit = limits[i];
    const double value = exists ? quantity_of(candidate, limit.quantity) : nan;
    // Shifted by the tolerance, so that what counts as kept is kept to the last digit.
    const double violation =
        limit.sign * (value - limit.bound) / limit.scale() + constraint_tolerance;
    violations[fixed_demands + i] = std::isfinite(violation) ? violation : 1.0;
  }
}

const Uniform* searched(const SweepAxis& axis) { return std::get_if<Uniform>(&axis.values); }

/// Every combination of enumerated values; what is searched stands at its lower end.
std::vector<std::vector<double>> combinations(const std::vector<SweepAxis>& free) {
  std::vector<std::vector<double>> all{{}};
  for (const SweepAxis& axis : free) {
    const std::uint64_t count = searched(axis) ? 1 : value_count(axis).value();
    std::vector<std::vector<double>> longer;
    for (const auto& head : all) {
      for (std::uint64_t i = 0; i < count; ++i) {
        longer.push_back(head);
        longer.back().push_back(searched(axis) ? searched(axis)->lo : value_at(axis, i));
      }
    }
    all = std::move(longer);
  }
  return all;
}

Condition condition_of(const PointQuantity& quantity, const Requirements& need) {
  if (quantity.condition) return *quantity.condition;
  return quantity.member == &OperatingPoint::headroom ? need.headroom_at : need.power_at;
}

/// Whether power from the supply is minimised and no range changes what flies and how.
bool has_lower_bound(const DesignProblem& problem) {
  const auto* objective = std::get_if<PointQuantity>(&problem.objective);
  return objective != nullptr && objective->member == &OperatingPoint::total_power &&
         std::ranges::all_of(problem.free, [](const SweepAxis& axis) {
           return searched(axis) == nullptr || axis.name == "supply.voltage_V" ||
                  axis.name.starts_with("tether.");
         });
}

/// Below the supplied power of `design` with any tether and voltage: the power of the drone alone.
/// A tether adds losses, weight W and drag, and with both the thrust T rises: W·tan θ is the drag
/// q(A_f cos θ + A_t sin θ) of the airframe plus that of the tether, so that more tether drag tilts
/// further at T = W/cos θ; and more weight tilts less at T = q(A_f cot θ + A_t) and more. Since it
/// tilts less, a tilt that the drone alone may not have says nothing of it with a tether. Unknown
/// where leaning less saves power.
double lower_bound(Design design, const PointQuantity& objective) {
  if (design.drone.translational_lift.induced_share > 0) return -infinity;
  const Condition condition = condition_of(objective, design.requirements);
  design.requirements.max_pitch = 89.99 * unit::degree;
  Tether& tether = design.tether = without_heat(design.tether);
  tether.length = 1e-6;
  tether.spooled_length = 0;
  tether.winch_pull = 0;
  tether.model = TetherModel::straight;  // weighs nothing at this length
  // A wind that is known at the drone stays, however low.
  if (!design.flight.wind_reference_height) design.flight.wind_profile = WindProfile::uniform;
  const OperatingPoint bare = evaluate(design, 1e-9, condition);
  constexpr double rounding = 1e-6;
  if (std::isfinite(bare.drone_power)) return bare.drone_power * (1 - rounding);
  const bool too_heavy =
      bare.necessary_thrust > motor_in_flight(design).max_thrust() * (1 + rounding);
  return too_heavy ? infinity : -infinity;
}

/// `values` with `x` in place of what is searched.
std::vector<double> with_searched(const DesignProblem& problem, std::vector<double> values,
                                  std::span<const double> x) {
  auto next = x.begin();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (searched(problem.free[i])) values[i] = *next++;
  }
  return values;
}

/// The search among the ranges of one combination.
MinimumProblem minimum_problem(const DesignProblem& problem, const std::vector<double>& values) {
  MinimumProblem result;
  for (const SweepAxis& axis : problem.free) {
    if (const Uniform* range = searched(axis)) result.variables.push_back({range->lo, range->hi});
  }
  result.constraint_count = fixed_demands + problem.limits.size();
  result.evaluate = [&problem, values](std::span<const double> x, std::span<double> constraints) {
    const Candidate candidate =
        candidate_of(with_values(problem.base, problem.free, with_searched(problem, values, x)));
    fill_violations(candidate, problem.limits, constraints);
    return std::isfinite(candidate.area) ? quantity_of(candidate, problem.objective) : nan;
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
  /// Whether the answer stays as good, relative, as that with a value for the i-th, which it then
  /// has.
  const auto takes = [&](std::size_t i, double value, double as_good) {
    const auto [lo, hi] = problem.variables[i];
    if (value < lo || value > hi) return false;
    std::vector<double> x = minimum.x;
    x[i] = value;
    const double objective = problem.evaluate(x, constraints);
    const bool kept =
        std::ranges::all_of(constraints, [](double c) { return c <= constraint_tolerance; });
    if (!kept || !(objective <= minimum.value + as_good * std::abs(minimum.value))) return false;
    minimum.x = std::move(x);
    minimum.value = objective;
    minimum.constraints = constraints;
    return true;
  };
  constexpr double rounding = 1e-13;
  constexpr double known_to = 1e-10;  // the forces of a hanging cable
  for (std::size_t i = 0; i < minimum.x.size(); ++i) {
    const double exact = minimum.x[i];
    const auto [lo, hi] = problem.variables[i];
    const auto is_next_to = [exact](double end) {
      return exact != end && std::abs(exact - end) <= known_to * std::abs(end);
    };
    if (is_next_to(lo) && takes(i, lo, known_to)) continue;
    if (is_next_to(hi) && takes(i, hi, known_to)) continue;
    for (int digits = 3; digits < 15; ++digits) {
      const double shorter = std::strtod(fmt::format("{:.{}g}", exact, digits).c_str(), nullptr);
      if (shorter == exact || takes(i, shorter, rounding)) break;
    }
  }
}

/// A combination of enumerated values with its lower bound.
struct Combination {
  std::vector<double> values;
  double bound = -infinity;
};

/// The most promising first.
std::vector<Combination> ordered_combinations(const DesignProblem& problem) {
  std::vector<Combination> ordered;
  const bool bounded = has_lower_bound(problem);
  for (auto& values : combinations(problem.free)) {
    const double bound = bounded ? lower_bound(with_values(problem.base, problem.free, values),
                                               std::get<PointQuantity>(problem.objective))
                                 : -infinity;
    ordered.push_back({std::move(values), bound});
  }
  std::ranges::stable_sort(ordered, {}, &Combination::bound);
  return ordered;
}

}  // namespace

double quantity_of(const Candidate& candidate, const CandidateQuantity& quantity) {
  if (const auto* point = std::get_if<PointQuantity>(&quantity)) {
    const Condition condition = condition_of(*point, candidate.design.requirements);
    return candidate.in(condition).*point->member / point->si_factor;
  }
  return std::get<1>(quantity)(candidate.design);
}

bool DesignProblem::frees(std::string_view path) const {
  return std::ranges::count(free, path, &SweepAxis::name) > 0;
}

Candidate candidate_of(Design design) {
  double area = nan;
  if (design.tether.cross_section) {
    area = *design.tether.cross_section;
  } else {
    const Optimization optimum = optimize(design);
    if (optimum.feasible) return {optimum, std::move(design)};
    // Nearest to feasible, so that it can be told by how much the demands are missed.
    area = best_headroom(design, design.requirements.headroom_at).area;
  }
  if (!std::isfinite(area)) return {{area, {}, {}, {}}, std::move(design)};
  return {evaluate_areas(design, std::span(&area, 1)).front(), std::move(design)};
}

std::vector<DemandState> demand_states(const Candidate& candidate,
                                       const std::vector<UserLimit>& limits) {
  std::vector<double> violations(fixed_demands + limits.size());
  fill_violations(candidate, limits, violations);
  std::vector<DemandState> states;
  for (const char* condition : {" in hover", " in forward flight"}) {
    for (std::size_t i = 0; i < demand_count; ++i) {
      const std::string name(demand_name(static_cast<Demand>(i)));
      states.push_back({name + condition, violations[states.size()]});
    }
  }
  for (const UserLimit& limit : limits) {
    states.push_back({limit.name, violations[states.size()], true});
  }
  return states;
}

DesignAnswer search_design(const DesignProblem& problem, const MinimumOptions& options) {
  DesignAnswer answer;
  for (const Combination& combination : ordered_combinations(problem)) {
    const bool first = answer.combinations++ == 0;
    if (!first && is_feasible(answer.minimum) && combination.bound > answer.minimum.value) {
      ++answer.pruned;
      continue;
    }
    const Minimum found =
        constrained_minimum(minimum_problem(problem, combination.values), options);
    answer.evaluations += found.evaluations;
    if (first || better(found, answer.minimum)) {
      answer.minimum = found;
      answer.values = combination.values;
    }
  }
  answer.feasible = is_feasible(answer.minimum);
  if (answer.feasible) write_short(minimum_problem(problem, answer.values), answer.minimum);
  answer.values = with_searched(problem, std::move(answer.values), answer.minimum.x);
  answer.best = candidate_of(with_values(problem.base, problem.free, answer.values));
  if (!answer.feasible) {
    answer.missed = demand_states(answer.best, problem.limits);
    std::erase_if(answer.missed,
                  [](const DemandState& d) { return d.violation <= constraint_tolerance; });
    std::ranges::stable_sort(answer.missed, std::ranges::greater{}, &DemandState::violation);
  }
  return answer;
}

}  // namespace tethercalc
