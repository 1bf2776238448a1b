// What results say of the cable beside its power: heat, strength, and the class of its voltage.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/model/operating_point.hpp"

namespace tethercalc {

/// A range of direct voltages by what protects people from it.
struct VoltageClass {
  std::string_view name;      ///< "touchable_elv", "elv", "low_voltage" or "high_voltage"
  double up_to = 0;           ///< V, the highest of the class
  std::string_view sentence;  ///< what it asks for
};

/// The class of a direct voltage in V: up to 60 V, 120 V and 1500 V (extra-low voltage of IEC 61140
/// and IEC 60364-4-41, ripple-free), or above. It is a name, not a proof of safety.
[[nodiscard]] VoltageClass voltage_class(double voltage);

/// {`name`, `sentence`}.
[[nodiscard]] nlohmann::ordered_json voltage_class_json(double voltage);

/// {`ambient_temperature_C`, `rated_temperature_C`, `hover`, `forward` {`conductor_temperature_C`,
/// `drum_temperature_C`, `runaway`}}; null where the design has no ambient temperature.
[[nodiscard]] nlohmann::ordered_json thermal_json(const Design& design, const OperatingPoint& hover,
                                                  const OperatingPoint& forward);

/// {`tension_N` (the greater of both conditions), `breaking_load_N` (null where unknown),
/// `required_safety_factor`, `wall_mm`, `breakdown_voltage_V` (null where unknown)}.
[[nodiscard]] nlohmann::ordered_json cable_json(const Design& design, const OperatingPoint& hover,
                                                const OperatingPoint& forward);

/// Sentences on heat, strength and voltage at one cross-section, without line breaks.
[[nodiscard]] std::vector<std::string> cable_sentences(const Design& design,
                                                       const OperatingPoint& hover,
                                                       const OperatingPoint& forward);

/// What the heat balance of this design does not know and the user should, a sentence each.
[[nodiscard]] std::vector<std::string> cable_warnings(const Design& design);

/// What the reader of the spec noted, then these.
[[nodiscard]] std::vector<std::string> all_warnings(const DesignFile& file);

}  // namespace tethercalc
