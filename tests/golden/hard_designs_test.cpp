// Designs that broke earlier solvers, held against areas tried one by one.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "support/reference_data.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

TEST_CASE("no area is better than the optimum of a design that was hard before") {
  const auto folder = test::reference_file("data/hard");
  if (!folder) return;
  int designs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path().filename());
    ++designs;
    const Design design = read_design(entry.path().string()).design;
    const Optimization result = optimize(design);
    const bool priced_at_hover = design.requirements.power_at == Condition::hover;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3000; ++i) {
      const double area = 1e-10 * std::pow(1e9, i / 2999.0);
      const OperatingPoint hover = evaluate(design, area, Condition::hover);
      const OperatingPoint forward = evaluate(design, area, Condition::forward);
      const double power = (priced_at_hover ? hover : forward).total_power;
      if (power < least && demand_margins(design, hover, forward).met()) least = power;
    }
    CHECK(result.feasible >= std::isfinite(least));
    if (!result.feasible) continue;
    CHECK(demand_margins(design, result.hover, result.forward).met());
    CHECK((priced_at_hover ? result.hover : result.forward).total_power <= least * (1 + 1e-9));
  }
  CHECK(designs == 17);
}
