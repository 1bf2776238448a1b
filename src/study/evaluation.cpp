#include "tethercalc/study/evaluation.hpp"

#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {

std::vector<AreaPoints> evaluate_areas(const Design& design, std::span<const double> areas) {
  const SteadyFlight hover(design, Condition::hover);
  const SteadyFlight forward(design, Condition::forward);
  std::vector<AreaPoints> table;
  for (const double area : areas) {
    AreaPoints points{area, evaluate(hover, area), evaluate(forward, area), {}};
    points.worst = demand_margins(design, points.hover, points.forward).worst();
    table.push_back(points);
  }
  return table;
}

}  // namespace tethercalc
