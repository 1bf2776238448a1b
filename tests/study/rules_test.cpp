// Figures of a design against clauses: by hand-made clauses and closed forms.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/study/optimum.hpp"
#include "tethercalc/study/rules.hpp"

using namespace tethercalc;

namespace {

Design starting_design() { return parse_design(starting_spec(), "start.json").design; }

RuleClause asks(RuleFigure figure, RuleComparison comparison, double limit) {
  RuleClause clause;
  clause.figure = figure;
  clause.comparison = comparison;
  clause.limit = limit;
  return clause;
}

RuleCheck held(const RuleRequest& request, const RuleClause& clause) {
  return study_rules(request, {"b", "B", "", "", {clause}}).checks.front();
}

constexpr double one_mm2 = 1e-6;

}  // namespace

TEST_CASE(
    "a bound that excludes its number is failed by that number, one that includes it is not") {
  Design design = starting_design();
  design.tether.length = 50;
  const RuleRequest request{design, one_mm2};
  const auto less_than = RuleComparison::less_than;
  const auto at_most = RuleComparison::at_most;
  const auto at_least = RuleComparison::at_least;
  CHECK(held(request, asks(RuleFigure::tether_length, less_than, 50)).verdict == RuleVerdict::fail);
  CHECK(held(request, asks(RuleFigure::tether_length, at_most, 50)).verdict == RuleVerdict::pass);
  CHECK(held(request, asks(RuleFigure::tether_length, at_least, 50)).verdict == RuleVerdict::pass);
}

TEST_CASE("the margin is relative to the limit and negative where it is missed") {
  Design design = starting_design();
  design.tether.length = 30;
  const RuleCheck met =
      held({design, one_mm2}, asks(RuleFigure::tether_length, RuleComparison::less_than, 50));
  CHECK(met.verdict == RuleVerdict::pass);
  CHECK(met.margin.value() == Approx(0.4));
  design.tether.length = 100;
  const RuleCheck missed =
      held({design, one_mm2}, asks(RuleFigure::tether_length, RuleComparison::less_than, 50));
  CHECK(missed.verdict == RuleVerdict::fail);
  CHECK(missed.margin.value() == Approx(-1));
}

TEST_CASE("cable on the drum that reaches over a bound leaves the verdict open") {
  Design design = starting_design();
  design.tether.length = 40;
  design.tether.spooled_length = 20;
  const RuleCheck check =
      held({design, one_mm2}, asks(RuleFigure::tether_length, RuleComparison::less_than, 50));
  CHECK(check.verdict == RuleVerdict::unknown);
  CHECK(check.value.lo == 40);
  CHECK(check.value.hi == 60);
  CHECK(!check.because.empty());
}

TEST_CASE("what flies weighs the drone and, by the wider reading, the tether that it lifts") {
  const Design design = starting_design();
  const RuleValue mass = rule_value({design, one_mm2}, RuleFigure::takeoff_mass);
  CHECK(mass.lo == Approx(design.drone.mass));
  // Two conductors in walls of s: 2h(ρ_c A + ρ_i A_i), equation (5) of Beffert and Zell (2025).
  const double r = std::sqrt(one_mm2 / 3.14159265358979);
  const double s = design.tether.insulation.thickness;
  const double wall = 3.14159265358979 * ((r + s) * (r + s) - r * r);
  const double tether =
      2 * design.tether.length *
      (design.tether.conductor.density * one_mm2 + design.tether.insulation.density * wall);
  CHECK(mass.hi == Approx(design.drone.mass + tether));
  CHECK(rule_value({design, one_mm2}, RuleFigure::mass_with_tether).lo == Approx(mass.hi));
  CHECK(rule_value({design, one_mm2}, RuleFigure::mass_without_tether).hi == Approx(mass.lo));
}

TEST_CASE("the tether's strength is told in weights of what flies") {
  Design design = starting_design();
  design.tether.conductor.tensile_strength = 200e6;
  const RuleValue ratio = rule_value({design, one_mm2}, RuleFigure::strength_over_weight);
  const double newton = 200e6 * 2 * one_mm2;  // both conductors
  CHECK(ratio.hi == Approx(newton / (design.drone.mass * 9.80665)));
  CHECK(ratio.lo < ratio.hi);
}

TEST_CASE("a figure that is missing makes a clause unknown and says what is missing") {
  Design design = starting_design();
  design.tether.conductor.tensile_strength = 0;
  const auto at_least = RuleComparison::at_least;
  for (const RuleFigure figure : {RuleFigure::strength_over_weight, RuleFigure::largest_dimension,
                                  RuleFigure::discharge_time, RuleFigure::load_rating}) {
    INFO(rule_figure_name(figure));
    const RuleCheck check = held({design, one_mm2}, asks(figure, at_least, 10));
    CHECK(check.verdict == RuleVerdict::unknown);
    CHECK(!check.margin);
    CHECK(check.because.size() > 20);
  }
}

TEST_CASE("without a conductor there is no mass to hold against a clause") {
  const RuleCheck check = held({starting_design(), std::nullopt},
                               asks(RuleFigure::takeoff_mass, RuleComparison::less_than, 25));
  CHECK(check.verdict == RuleVerdict::unknown);
  CHECK(!check.because.empty());
}

TEST_CASE("a clause that another way may meet is unknown where the figure misses it") {
  RuleClause clause = asks(RuleFigure::supply_voltage, RuleComparison::at_most, 60);
  clause.otherwise = "insulation";
  Design design = starting_design();
  design.supply.voltage = 75;
  const RuleCheck check = held({design, one_mm2}, clause);
  CHECK(check.verdict == RuleVerdict::unknown);
  CHECK(check.because == "insulation");
  CHECK(check.margin.value() == Approx(-0.25));
  design.supply.voltage = 48;
  CHECK(held({design, one_mm2}, clause).verdict == RuleVerdict::pass);
}

TEST_CASE("heights are those of the flight over ground and of all the cable over the station") {
  Design design = starting_design();
  design.tether.length = 80;
  design.tether.spooled_length = 45;
  design.flight.station_height = 20;
  CHECK(rule_value({design, one_mm2}, RuleFigure::flight_height).hi == 100);
  CHECK(rule_value({design, one_mm2}, RuleFigure::attainable_height).lo == 125);
}

TEST_CASE("the length of a tether that sags or stands aside is what is paid out") {
  Design design = starting_design();
  design.tether.length = 30;
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.2;
  design.flight.horizontal_offset = 40;
  for (const std::optional<double> area : {std::optional(one_mm2), std::optional<double>()}) {
    const RuleValue length = rule_value({design, area}, RuleFigure::tether_length);
    CHECK(length.lo == Approx(60));
    CHECK(length.hi == Approx(60));
  }
  design.tether.spooled_length = 45;
  CHECK(rule_value({design, one_mm2}, RuleFigure::tether_length).hi == 75);
  CHECK(rule_value({design, one_mm2}, RuleFigure::attainable_height).hi == 75);

  design.tether.winch_pull = 4;
  const std::vector<double> areas{one_mm2};
  const AreaPoints flown = evaluate_areas(design, areas).front();
  CHECK(rule_value({design, one_mm2}, RuleFigure::tether_length).lo ==
        std::max(flown.hover.tether_length, flown.forward.tether_length));
  const RuleCheck unknown = held({design, std::nullopt},
                                 asks(RuleFigure::attainable_height, RuleComparison::at_most, 50));
  CHECK(unknown.verdict == RuleVerdict::unknown);
  CHECK(!unknown.because.empty());
}
