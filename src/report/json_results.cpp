#include "tethercalc/report/json_results.hpp"

#include <cmath>

namespace tethercalc {

using nlohmann::ordered_json;

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json operating_point_json(const OperatingPoint& point) {
  ordered_json out = ordered_json::object();
  for (const OperatingPointField& field : operating_point_fields()) {
    out[std::string(field.key)] = number_or_null(practical_value(point, field));
  }
  return out;
}

}  // namespace tethercalc
