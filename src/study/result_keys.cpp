#include "tethercalc/study/result_keys.hpp"

#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

std::span<const OperatingPointField> operating_point_fields() {
  using P = OperatingPoint;
  static constexpr std::array<OperatingPointField, 14> fields{{
      {"cross_section_mm2", &P::cross_section, unit::square_millimetre},
      {"tether_resistance_ohm", &P::tether_resistance, 1},
      {"tether_mass_g", &P::tether_mass, unit::gram},
      {"takeoff_mass_g", &P::takeoff_mass, unit::gram},
      {"pitch_deg", &P::pitch, unit::degree},
      {"available_power_W", &P::available_power, 1},
      {"available_thrust_g", &P::available_thrust, unit::gram_force},
      {"necessary_thrust_g", &P::necessary_thrust, unit::gram_force},
      {"headroom", &P::headroom, 1},
      {"drone_power_W", &P::drone_power, 1},
      {"total_power_W", &P::total_power, 1},
      {"tether_loss_W", &P::tether_loss, 1},
      {"current_A", &P::current, 1},
      {"received_voltage_V", &P::received_voltage, 1},
  }};
  return fields;
}

double practical_value(const OperatingPoint& point, const OperatingPointField& field) {
  const double value = point.*field.member / field.si_factor;
  return std::isfinite(value) ? value : nan;
}

std::string_view condition_name(Condition condition) {
  return condition == Condition::hover ? "hover" : "forward";
}

std::string_view limit_name(Limit limit) {
  constexpr std::array<std::string_view, 9> names{
      "minimum_power",         "available_power", "takeoff_mass",     "motor_thrust", "max_pitch",
      "conductor_temperature", "tether_strength", "converter_rating", "input_voltage"};
  return names.at(static_cast<std::size_t>(limit));
}

std::string_view status_name(bool feasible) { return feasible ? "optimal" : "infeasible"; }

}  // namespace tethercalc
