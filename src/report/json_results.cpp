#include "tethercalc/report/json_results.hpp"

#include <cmath>

#include "tethercalc/io/operating_point_fields.hpp"

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

std::string_view condition_name(Condition condition) {
  return condition == Condition::hover ? "hover" : "forward";
}

std::string_view limit_name(Limit limit) {
  switch (limit) {
    case Limit::minimum_power:
      return "minimum_power";
    case Limit::available_power:
      return "available_power";
    case Limit::takeoff_mass:
      return "takeoff_mass";
    case Limit::motor_thrust:
      return "motor_thrust";
    case Limit::max_pitch:
      return "max_pitch";
    case Limit::conductor_temperature:
      return "conductor_temperature";
    case Limit::tether_strength:
      return "tether_strength";
    case Limit::converter_rating:
      return "converter_rating";
    case Limit::input_voltage:
      return "input_voltage";
  }
  return "";
}

std::string_view status_name(const Optimization& result) {
  return result.feasible ? "optimal" : "infeasible";
}

}  // namespace tethercalc
