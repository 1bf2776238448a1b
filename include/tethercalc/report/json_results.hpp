// The parts that several commands' JSON results share.
#pragma once

#include <nlohmann/json.hpp>

#include "tethercalc/study/result_keys.hpp"

namespace tethercalc {

/// The number, or null where it does not exist: JSON knows neither NaN nor infinity.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);

/// An operating point under the keys of `operating_point_fields`.
[[nodiscard]] nlohmann::ordered_json operating_point_json(const OperatingPoint& point);

}  // namespace tethercalc
