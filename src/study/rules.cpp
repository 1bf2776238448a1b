#include "tethercalc/study/rules.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tethercalc/model/tether_load.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {
namespace {

struct FigureEntry {
  std::string_view name;
  std::string_view unit;
};

/// In the order of `RuleFigure`.
constexpr std::array<FigureEntry, rule_figure_count> figures{{{"takeoff_mass", "kg"},
                                                              {"mass_with_tether", "kg"},
                                                              {"mass_without_tether", "kg"},
                                                              {"tether_length", "m"},
                                                              {"attainable_height", "m"},
                                                              {"flight_height", "m"},
                                                              {"strength_over_weight", ""},
                                                              {"supply_voltage", "V"},
                                                              {"ground_speed", "m/s"},
                                                              {"electric_power", ""},
                                                              {"largest_dimension", "m"},
                                                              {"discharge_time", "s"},
                                                              {"load_rating", ""}}};

RuleValue one(double value, std::string because = "") { return {value, value, std::move(because)}; }

RuleValue missing(std::string because) {
  RuleValue out;
  out.because = std::move(because);
  return out;
}

/// What flies, without and with the tether that it lifts.
struct Masses {
  double drone = 0;  ///< kg
  double all = 0;    ///< kg
};

std::optional<Masses> masses(const RuleRequest& request) {
  if (!request.area) return std::nullopt;
  const std::vector<double> areas{*request.area};
  const OperatingPoint hover = evaluate_areas(request.design, areas).front().hover;
  if (!std::isfinite(hover.takeoff_mass)) return std::nullopt;
  return Masses{hover.takeoff_mass - hover.tether_mass, hover.takeoff_mass};
}

constexpr const char* no_mass =
    "no cross-section of the tether is stated or found, so what flies has no mass";

RuleValue strength_over_weight(const RuleRequest& request) {
  const auto mass = masses(request);
  if (!mass) return missing(no_mass);
  const double load = breaking_load(request.design.tether, *request.area);
  if (!(load > 0)) {
    return missing(
        "the breaking load is unknown: the conductor states no tensile strength and there is no "
        "tether.strength_member");
  }
  return {load / (mass->all * standard_gravity), load / (mass->drone * standard_gravity),
          "with and without the weight of the tether that the drone lifts"};
}

/// m that are out in the condition that takes more; NaN where the cable's weight decides that and
/// is unknown, or it cannot hang.
double cable_in_air(const RuleRequest& request) {
  const Design& design = request.design;
  const Tether& tether = design.tether;
  if (tether.model == TetherModel::straight) return tether.length;
  const PaidOut paid_out = paid_out_to(tether, tether.length, design.flight.horizontal_offset);
  if (paid_out.length) return *paid_out.length;
  if (!request.area) return std::nan("");
  const AreaPoints flown = evaluate_areas(design, std::span(&*request.area, 1)).front();
  return std::max(flown.hover.tether_length, flown.forward.tether_length);
}

RuleValue cable_length(const RuleRequest& request) {
  const Tether& tether = request.design.tether;
  const double in_air = cable_in_air(request);
  if (std::isnan(in_air)) {
    return missing(
        "how much of the tether the winch's pull leaves out is unknown: no cross-section "
        "is stated or found with which it hangs");
  }
  return {in_air, std::max(in_air, tether.length + tether.spooled_length),
          "the cable in the air, and all of it with what is on the drum"};
}

/// Whether a number is within the clause's limit.
bool meets(const RuleClause& clause, double value) {
  switch (clause.comparison) {
    case RuleComparison::less_than:
      return value < clause.limit;
    case RuleComparison::at_most:
      return value <= clause.limit;
    case RuleComparison::at_least:
      return value >= clause.limit;
    case RuleComparison::is_so:
      break;
  }
  return true;
}

double margin_of(const RuleClause& clause, double value) {
  const double ratio = value / clause.limit;
  return clause.comparison == RuleComparison::at_least ? ratio - 1 : 1 - ratio;
}

RuleCheck checked(const RuleRequest& request, const RuleClause& clause) {
  RuleCheck out{clause, rule_value(request, clause.figure), RuleVerdict::unknown, std::nullopt, ""};
  if (std::isnan(out.value.lo)) {
    out.because = out.value.because;
    return out;
  }
  if (clause.comparison == RuleComparison::is_so) {
    out.verdict = RuleVerdict::pass;
    return out;
  }
  out.margin = std::min(margin_of(clause, out.value.lo), margin_of(clause, out.value.hi));
  const bool lo = meets(clause, out.value.lo);
  const bool hi = meets(clause, out.value.hi);
  if (lo && hi) {
    out.verdict = RuleVerdict::pass;
  } else if (lo != hi) {
    out.because = "the text leaves open which counts: " + out.value.because;
  } else if (!clause.otherwise.empty()) {
    out.because = clause.otherwise;
  } else {
    out.verdict = RuleVerdict::fail;
  }
  return out;
}

}  // namespace

std::string_view rule_figure_name(RuleFigure figure) {
  return figures.at(static_cast<std::size_t>(figure)).name;
}

std::string_view rule_figure_unit(RuleFigure figure) {
  return figures.at(static_cast<std::size_t>(figure)).unit;
}

std::string_view rule_verdict_name(RuleVerdict verdict) {
  constexpr std::array<std::string_view, 3> names{"pass", "fail", "unknown"};
  return names.at(static_cast<std::size_t>(verdict));
}

std::size_t RuleStudy::count(RuleVerdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(checks, verdict, &RuleCheck::verdict));
}

std::optional<double> ruled_area(const DesignOptimum& optimum) {
  if (optimum.design.tether.cross_section) return optimum.design.tether.cross_section;
  if (!optimum.result.feasible) return std::nullopt;
  return optimum.result.area;
}

RuleValue rule_value(const RuleRequest& request, RuleFigure figure) {
  const Design& design = request.design;
  const auto mass = masses(request);
  switch (figure) {
    case RuleFigure::takeoff_mass:
      if (!mass) return missing(no_mass);
      return {mass->drone, mass->all, "without and with the tether that the drone lifts"};
    case RuleFigure::mass_with_tether:
      return mass ? one(mass->all) : missing(no_mass);
    case RuleFigure::mass_without_tether:
      return mass ? one(mass->drone) : missing(no_mass);
    case RuleFigure::tether_length:
      return cable_length(request);
    case RuleFigure::attainable_height: {
      const RuleValue cable = cable_length(request);
      return one(cable.hi, cable.because);
    }
    case RuleFigure::flight_height:
      return one(design.tether.length + design.flight.station_height);
    case RuleFigure::strength_over_weight:
      return strength_over_weight(request);
    case RuleFigure::supply_voltage:
      return one(design.supply.voltage);
    case RuleFigure::ground_speed:
      return one(std::abs(design.flight.airspeed));
    case RuleFigure::electric_power:
      return one(1);
    case RuleFigure::largest_dimension:
      return missing("the largest dimension of the drone is missing; no field of a spec states it");
    case RuleFigure::discharge_time:
      return missing(
          "the capacitance on the line and the resistance that discharges it are missing; no field "
          "of a spec states them");
    case RuleFigure::load_rating:
      break;
  }
  return missing("the rating of the tether is missing; no field of a spec states it");
}

RuleStudy study_rules(const RuleRequest& request, const RuleBook& book) {
  RuleStudy out{book, request.area, {}};
  for (const RuleClause& clause : book.clauses) out.checks.push_back(checked(request, clause));
  return out;
}

}  // namespace tethercalc
