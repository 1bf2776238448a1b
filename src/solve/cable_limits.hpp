// The optimum where heat, strength or the converter's rating bind beside the thrust.
#pragma once

#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {

/// Whether the design asks for a heat balance, a breaking load, a converter rating or a reserve
/// battery, none of which the fast search knows.
[[nodiscard]] bool has_cable_limits(const Design& design);

/// The optimum of a design without any of these, or as if it had none.
[[nodiscard]] Optimization optimize_without_cable_limits(const Design& design);

/// Whether a design with some has an optimum, sooner than by looking for it.
[[nodiscard]] bool feasible_within_cable_limits(const Design& design);

/// The optimum of a design with some.
[[nodiscard]] Optimization optimize_within_cable_limits(const Design& design);

}  // namespace tethercalc
