// Whatever answers a question about a cable, it agrees with the one judge of demands on whether
// that cable will do.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/study/design.hpp"
#include "tethercalc/study/envelope.hpp"
#include "tethercalc/study/sweep.hpp"

using namespace tethercalc;

namespace {

/// A design that makes every demand there is, none of them out of reach.
Design demanding_design(test::Random& random) {
  Design design = test::random_design(random);
  Tether& tether = design.tether;
  tether.ambient_temperature_C = random.uniform(-20, 45);
  tether.sun = random.chance(0.5) ? random.uniform(0, 1000) : 0;
  tether.drum.layers = random.integer(0, 4);
  if (random.chance(0.3)) tether.inclination = random.uniform(0, 1.57);
  if (random.chance(0.3)) {
    tether.drum.core_diameter = random.magnitude(0.05, 0.5);
    tether.drum.width = random.magnitude(0.003, 0.5);
  }
  tether.insulation.thermal_conductivity = random.chance(0.8) ? 0.17 : 0;
  tether.insulation.rated_temperature_C = random.uniform(60, 180);
  tether.insulation.breakdown_strength = 20e6;
  tether.insulation.dielectric_safety_factor = random.chance(0.5) ? random.uniform(1, 10) : 0;
  tether.conductor.tensile_strength = random.magnitude(5e7, 5e8);
  tether.winch_pull = random.chance(0.3) ? random.uniform(0, 5) : 0;
  design.requirements.strength_safety_factor = random.uniform(0.2, 3);
  Converter& converter = design.supply.converter;
  const double lift = design.drone.mass * standard_gravity;
  converter.rated_output_power = random.magnitude(20, 100) * lift;
  converter.specific_mass = random.chance(0.5) ? random.uniform(0, 2e-4) : 0;
  converter.max_input_voltage = design.supply.voltage * random.uniform(0.95, 3);
  if (random.chance(0.5)) design.drone.reserve_battery.specific_energy = 5e5;
  return design;
}

bool judged(const Design& design, double area) {
  return demand_margins(design, evaluate(design, area, Condition::hover),
                        evaluate(design, area, Condition::forward))
      .met();
}

}  // namespace

TEST_CASE("every answer about a cable agrees with the judge of demands") {
  int good = 0;
  for (unsigned i = 0; i < 400; ++i) {
    test::Random random(test::run_seed() + i);
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    Design design = demanding_design(random);
    const Optimization optimum = optimize(design);
    if (optimum.feasible) CHECK(judged(design, optimum.area));
    const double near = optimum.feasible ? optimum.area : 1e-6;
    const double area = near * random.magnitude(0.5, 2);
    design.tether.cross_section = area;
    const bool will_do = judged(design, area);
    good += will_do ? 1 : 0;

    // evaluate, and the words of every table.
    const AreaPoints points = evaluate_areas(design, std::span(&area, 1)).front();
    CHECK(points.worst.met() == will_do);
    CHECK(shortcoming(design, points).empty() == will_do);
    // A row of a sweep over cross-sections.
    CHECK(sweep_outcome(design, true).feasible == will_do);
    // A search that has no other cable to choose.
    DesignProblem problem;
    problem.base = design;
    CHECK(search_design(problem).feasible == will_do);
    // How far the cable goes: at least as far as it is, where it is good.
    if (will_do) CHECK(greatest_reach(design, Reach::payload));
    const auto end = greatest_reach(design, Reach::payload);
    if (end) CHECK(judged(at_reach(design, Reach::payload, end->value), area));
    // What the page and `optimize` tell of the cable of the spec.
    if (i % 20 == 0) {
      const OptimumStudy study = study_optimum(design, {});
      REQUIRE(study.sizes.size() == 1);
      CHECK(study.sizes.front().points.worst.met() == will_do);
    }
  }
  CHECK(good > 20);
}
