// What a design does at given cross-sections, and whether that will do.
#pragma once

#include <span>
#include <vector>

#include "tethercalc/model/demands.hpp"

namespace tethercalc {

/// One cross-section in both flight conditions.
struct AreaPoints {
  double area = 0;         ///< m²
  OperatingPoint hover;    ///< in hover
  OperatingPoint forward;  ///< in forward flight
  DemandMargin worst;      ///< of the demands on the design, the one least met

  /// The point in `condition`.
  [[nodiscard]] const OperatingPoint& in(Condition condition) const {
    return condition == Condition::hover ? hover : forward;
  }
};

/// Both conditions at each of `areas` (m², > 0).
[[nodiscard]] std::vector<AreaPoints> evaluate_areas(const Design& design,
                                                     std::span<const double> areas);

}  // namespace tethercalc
