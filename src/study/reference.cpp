#include "tethercalc/study/reference.hpp"

#include <algorithm>
#include <cmath>

#include "tethercalc/study/result_keys.hpp"

namespace tethercalc {
namespace {

ResultValue existing(double value) {
  return std::isfinite(value) ? ResultValue(value) : ResultValue();
}

ResultValue in_mm2(double area) { return existing(area / unit::square_millimetre); }

}  // namespace

std::vector<NamedResult> optimum_results(const Optimization& result) {
  std::vector<NamedResult> results{
      {"status", std::string(status_name(result.feasible))},
      {"limited_by", std::string(limit_name(result.limited_by))},
      {"limiting_condition", std::string(condition_name(result.limiting_condition))},
      {"cross_section_mm2", in_mm2(result.feasible ? result.area : std::nan(""))}};
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const OperatingPoint& point = condition == Condition::hover ? result.hover : result.forward;
    for (const OperatingPointField& field : operating_point_fields()) {
      results.push_back(
          {std::string(condition_name(condition)) + "." + std::string(field.key),
           result.feasible ? existing(practical_value(point, field)) : ResultValue()});
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
