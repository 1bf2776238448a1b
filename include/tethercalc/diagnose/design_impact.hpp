// What a diagnosis does to the design.
#pragma once

#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// Optimum cross-section and the supply power there, in the condition of
/// `requirements.power_at`, of the design as it was and as extended. Where a design has no feasible
/// cross-section its numbers are empty.
[[nodiscard]] DesignImpact design_impact(const Design& before, const Design& after);

}  // namespace tethercalc
