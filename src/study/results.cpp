#include "tethercalc/study/results.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

ResultValue existing(double value) {
  return std::isfinite(value) ? ResultValue(value) : ResultValue();
}

ResultValue in_mm2(double area) { return existing(area / unit::square_millimetre); }

}  // namespace

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
  constexpr std::array<std::string_view, limit_count> names{
      "minimum_power", "available_power",       "takeoff_mass",    "motor_thrust",
      "max_pitch",     "conductor_temperature", "tether_strength", "converter_rating",
      "input_voltage", "tether_shape",          "drum_width"};
  return names.at(static_cast<std::size_t>(limit));
}

namespace {
constexpr std::array<std::string_view, 3> statuses{"optimal", "feasible", "infeasible"};
}  // namespace

std::string_view status_name(bool feasible, bool given_cable) {
  return statuses.at(!feasible ? 2 : given_cable ? 1 : 0);
}

std::span<const std::string_view> design_status_names() { return statuses; }

std::vector<NamedResult> optimum_results(const Optimization& result) {
  std::vector<NamedResult> results{
      {"status", std::string(status_name(result.feasible))},
      {"limited_by", std::string(limit_name(result.limited_by))},
      {"limiting_condition", std::string(condition_name(result.limiting_condition))},
      {"cross_section_mm2", in_mm2(result.feasible ? result.area : std::nan(""))}};
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    for (const OperatingPointField& field : operating_point_fields()) {
      results.push_back({std::string(condition_name(condition)) + "." + std::string(field.key),
                         result.feasible ? existing(practical_value(result.in(condition), field))
                                         : ResultValue()});
    }
  }
  return results;
}

std::vector<NamedResult> reference_results(const Design& design) {
  const DesignOptimum optimum = optimum_of(design);
  const MinimumPower& least = optimum.result.minimum_power;
  std::vector<NamedResult> results = optimum_results(optimum.result);
  results.push_back({"headroom.best", existing(optimum.best_headroom.value)});
  results.push_back({"headroom.best_at_mm2", in_mm2(optimum.best_headroom.area)});
  results.push_back({"minimum_power.cross_section_mm2", in_mm2(least.area)});
  results.push_back({"minimum_power.total_power_W", existing(least.power)});
  return results;
}

RecordedResult held_against(const NamedResult& recorded, const ResultValue& computed,
                            double relative_tolerance, double absolute_tolerance) {
  RecordedResult result{recorded.name, recorded.value, computed};
  if (const auto* was = std::get_if<double>(&recorded.value)) {
    result.tolerance = std::max(absolute_tolerance, relative_tolerance * std::abs(*was));
    if (const auto* is = std::get_if<double>(&computed)) result.difference = *is - *was;
  }
  result.drifted = result.difference ? !(std::abs(*result.difference) <= result.tolerance)
                                     : recorded.value != computed;
  return result;
}

}  // namespace tethercalc
