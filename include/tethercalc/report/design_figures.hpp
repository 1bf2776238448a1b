// Pictures of designs: the optimum of one, and the motors that it could fly with.
#pragma once

#include <span>

#include "tethercalc/report/figure.hpp"
#include "tethercalc/report/optimize_report.hpp"

namespace tethercalc {

/// Thrust (available, necessary and required, per motor) and power from the supply over the
/// conductor's cross-section, in hover and in forward flight. The feasible range is shaded, the
/// least power and the optimum are marked; along the upper edges stand the sizes that can be
/// bought, AWG over thrust and IEC 60228 over power. An infeasible design is drawn as well, with
/// its best headroom marked. The axis is logarithmic where what matters spans more than a factor of
/// eight.
[[nodiscard]] Figure optimum_figure(const std::string& name, const OptimumStudy& study,
                                    const AreaCurve& curve);

/// Efficiency over thrust of every motor in `ranking`, with the thrust that its optimum needs in
/// hover (circle), the thrust demanded with headroom (dot) and, where the least power decides, the
/// thrust in the condition in which power is judged (plus).
[[nodiscard]] Figure motors_figure(const DesignFile& file, std::span<const MotorOptimum> ranking);

}  // namespace tethercalc
