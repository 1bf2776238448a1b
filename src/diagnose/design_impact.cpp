#include "tethercalc/diagnose/design_impact.hpp"

#include "tethercalc/model/units.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

void record(const Design& design, std::optional<double>& area, std::optional<double>& power) {
  const Optimization result = optimize(design);
  if (!result.feasible) return;
  const bool hover = design.requirements.power_at == Condition::hover;
  area = result.area / unit::square_millimetre;
  power = (hover ? result.hover : result.forward).total_power;
}

}  // namespace

DesignImpact design_impact(const Design& before, const Design& after) {
  DesignImpact impact;
  record(before, impact.cross_section_mm2.before, impact.total_power_W.before);
  record(after, impact.cross_section_mm2.after, impact.total_power_W.after);
  return impact;
}

}  // namespace tethercalc
