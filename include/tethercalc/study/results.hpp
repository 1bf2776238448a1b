// What the results of a design are called, in JSON, CSV and records alike, and how they are held
// against those on record.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tethercalc/study/optimum.hpp"

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
/// "optimal" or "infeasible"; of a cable that was given, "feasible" or "infeasible".
[[nodiscard]] std::string_view status_name(bool feasible, bool given_cable = false);
[[nodiscard]] std::span<const std::string_view> design_status_names();  ///< all three

/// A number in its practical unit, or a word; nothing where the result does not exist.
using ResultValue = std::variant<std::monostate, double, std::string>;

/// A result of a design.
struct NamedResult {
  std::string name;   ///< "cross_section_mm2", "forward.total_power_W", "headroom.best"
  ResultValue value;  ///< what it is
};

/// The results of an optimum: `status`, `limited_by`, `limiting_condition`, `cross_section_mm2`,
/// and both operating points as "hover." and "forward." followed by the keys of
/// `operating_point_fields`.
[[nodiscard]] std::vector<NamedResult> optimum_results(const Optimization& result);

/// Every result of `design`: those of its optimum, `headroom.best`, `headroom.best_at_mm2`,
/// `minimum_power.cross_section_mm2` and `minimum_power.total_power_W`.
[[nodiscard]] std::vector<NamedResult> reference_results(const Design& design);

/// One recorded result against the computed one.
struct RecordedResult {
  std::string name;                    ///< of the result
  ResultValue recorded;                ///< as on record; nothing as well without a record
  ResultValue computed;                ///< now
  double tolerance = 0;                ///< allowed difference of numbers, in the result's unit
  std::optional<double> difference{};  ///< computed − recorded, where both are numbers
  bool drifted = false;                ///< outside of the tolerance, or not recorded
};

/// Holds `computed` against `recorded`: numbers may differ by the wider one of two tolerances, the
/// relative one times the recorded number and the absolute one in its unit; all else must be the
/// same.
[[nodiscard]] RecordedResult held_against(const NamedResult& recorded, const ResultValue& computed,
                                          double relative_tolerance, double absolute_tolerance);

}  // namespace tethercalc
