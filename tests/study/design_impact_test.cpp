// How findings move the optimum, against an optimum found by walking along all cross-sections with
// the paper's equations written down once more (support/plain_physics.hpp).
#include "tethercalc/study/diagnosis.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>

#include "support/plain_physics.hpp"
#include "support/run_program.hpp"
#include "tethercalc/files/read_files.hpp"

using namespace tethercalc;

namespace {

Design flown_design() {
  return read_design(test::project_file("examples/holybro-x500.json")).design;
}

struct Optimum {
  double area_mm2 = 0;
  double power = 0;
};

/// The least power among the cross-sections with enough headroom, every `step` mm².
std::optional<Optimum> walked(const Design& design, double from, double to, double step) {
  std::optional<Optimum> best;
  for (double area = from; area <= to; area += step) {
    const auto at = [&](Condition condition) {
      return test::plain::evaluate(design, area * 1e-6, condition);
    };
    const auto headroom = at(design.requirements.headroom_at);
    const auto power = at(design.requirements.power_at);
    if (headroom.headroom < design.requirements.thrust_headroom || headroom.tilts_too_far ||
        power.tilts_too_far || !std::isfinite(power.total_power)) {
      continue;
    }
    if (!best || power.total_power < best->power) best = Optimum{area, power.total_power};
  }
  return best;
}

std::optional<Optimum> walked(const Design& design) {
  const std::optional<Optimum> coarse = walked(design, 0.2, 8, 0.02);
  if (!coarse) return coarse;
  return walked(design, coarse->area_mm2 - 0.03, coarse->area_mm2 + 0.03, 2e-4);
}

void check(const char* what, const std::optional<double>& area, const std::optional<double>& power,
           const Design& design) {
  const std::optional<Optimum> expected = walked(design);
  INFO(what);
  REQUIRE(area.has_value() == expected.has_value());
  REQUIRE(power.has_value() == expected.has_value());
  if (!expected) return;
  // Two of the walk's steps, and what power changes by on the steepest edge over them.
  CHECK(*area == Approx(expected->area_mm2).margin(4e-4));
  CHECK(*power == Approx(expected->power).margin(2e-2));
}

}  // namespace

TEST_CASE("the design impact of each lasting effect is the move of the optimum") {
  struct Case {
    const char* what;
    std::function<void(Design&)> change;
  };
  const Case cases[] = {
      {"contact resistance", [](Design& d) { d.tether.contact_resistance = 0.4; }},
      {"cable on the drum", [](Design& d) { d.tether.spooled_length = 24.9; }},
      {"a hot conductor", [](Design& d) { d.tether.conductor_temperature_C = 45; }},
      {"resistivity", [](Design& d) { d.tether.conductor.resistivity_20C *= 1.15; }},
      {"auxiliaries", [](Design& d) { d.drone.auxiliary_power += 20; }},
      {"mass", [](Design& d) { d.drone.mass += 0.19; }},
      {"motor power", [](Design& d) { d.drone.motor_power_factor = 1.08; }},
      {"translational lift",
       [](Design& d) {
         d.drone.translational_lift = {0.2, 5};
       }},
      {"drag", [](Design& d) { d.drone.drag.front_area *= 2; }},
      {"a converter curve",
       [](Design& d) {
         d.supply.converter.efficiency = {{100, 0.82}, {300, 0.91}, {900, 0.88}};
       }},
      {"too heavy to fly", [](Design& d) { d.drone.mass += 1.5; }},
  };
  const Design before = flown_design();
  for (const Case& c : cases) {
    Design after = before;
    c.change(after);
    const DesignImpact impact = design_impact(before, after);
    check(c.what, impact.cross_section_mm2.after, impact.total_power_W.after, after);
    CHECK(*impact.cross_section_mm2.before == Approx(1.0886).margin(5e-5));  // the paper's
    CHECK(*impact.total_power_W.before == Approx(444.9).margin(0.05));
  }
}

TEST_CASE("where power is least in hover, the design impact tells hover power") {
  Design before = flown_design();
  before.requirements.power_at = Condition::hover;
  Design after = before;
  after.tether.contact_resistance = 0.4;
  const DesignImpact impact = design_impact(before, after);
  check("before", impact.cross_section_mm2.before, impact.total_power_W.before, before);
  check("after", impact.cross_section_mm2.after, impact.total_power_W.after, after);
}
