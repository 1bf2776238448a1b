// The optimum where heat, strength or the converter's rating bind beside the thrust.
#pragma once

#include <vector>

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

/// How far one demand is met: at least 0 where it is.
struct Margin {
  Limit limit = Limit::available_power;
  Condition condition = Condition::hover;
  double value = 0;  ///< relative to what is demanded; −1 where what it judges does not exist
};

/// The margins of all demands on a design at one area, given its operating points.
[[nodiscard]] std::vector<Margin> requirement_margins(const Design& design,
                                                      const OperatingPoint& hover,
                                                      const OperatingPoint& forward);

}  // namespace tethercalc
