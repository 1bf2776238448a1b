// The parts that several commands' JSON results share.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {

/// The number, or null where it does not exist: JSON knows neither NaN nor infinity.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);

/// An operating point under the keys of `operating_point_fields`.
[[nodiscard]] nlohmann::ordered_json operating_point_json(const OperatingPoint& point);

[[nodiscard]] std::string_view condition_name(Condition condition);  ///< "hover", "forward"
[[nodiscard]] std::string_view limit_name(Limit limit);              ///< "minimum_power", …
[[nodiscard]] std::string_view status_name(
    const Optimization& result);  ///< "optimal", "infeasible"

}  // namespace tethercalc
