// What results are called, in JSON, CSV and records alike.
#pragma once

#include <span>
#include <string_view>

#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {

/// One result key: its practical unit is the end of its name.
struct OperatingPointField {
  std::string_view key;            ///< "cross_section_mm2"
  double OperatingPoint::*member;  ///< SI
  double si_factor;                ///< times the practical number gives SI
};

/// All keys of an operating point, in the order in which results list them.
[[nodiscard]] std::span<const OperatingPointField> operating_point_fields();

/// The practical value; NaN where it does not exist, which JSON writes as null and CSV as nothing.
[[nodiscard]] double practical_value(const OperatingPoint& point, const OperatingPointField& field);

[[nodiscard]] std::string_view condition_name(Condition condition);  ///< "hover", "forward"
[[nodiscard]] std::string_view limit_name(Limit limit);              ///< "minimum_power", …
[[nodiscard]] std::string_view status_name(bool feasible);           ///< "optimal", "infeasible"

}  // namespace tethercalc
