// What every answer says of a design in words: what limits it, and heat, strength and voltage of
// its cable.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// "hover" or "forward flight".
[[nodiscard]] std::string condition_words(Condition condition);

/// Why a cable cannot be used in this design, in a few words; empty where it can.
[[nodiscard]] std::string shortcoming(const Design& design, const AreaPoints& points);

/// Why the optimum is where it is. For a feasible result.
[[nodiscard]] std::string limit_sentence(const Design& design, const Optimization& result);

/// What binds where this demand does: "The converter's rated 450 W".
[[nodiscard]] std::string demand_words(const Design& design, Demand demand);

/// What happens where this limit is passed: "the converter's rating is passed in hover".
[[nodiscard]] std::string beyond_words(const Design& design, Limit limit, Condition where);

/// Why there is no optimum, with the best that can be reached.
[[nodiscard]] std::string refusal_sentence(const Design& design, const Refusal& refusal);

/// The same in a few words, for a table.
[[nodiscard]] std::string refusal_words(const Design& design, const Refusal& refusal);

/// The class of a direct voltage in V, {`name`, `sentence`}: "touchable_elv" up to 60 V, "elv" up
/// to 120 V, "low_voltage" up to 1500 V (extra-low voltage of IEC 61140 and IEC 60364-4-41,
/// ripple-free), or "high_voltage". It is a name, not a proof of safety.
[[nodiscard]] nlohmann::ordered_json voltage_class_json(double voltage);

/// {`ambient_temperature_C`, `rated_temperature_C`, `hover`, `forward` {`conductor_temperature_C`,
/// `drum_temperature_C`, `runaway`}}; null where the design has no ambient temperature.
[[nodiscard]] nlohmann::ordered_json thermal_json(const Design& design, const AreaPoints& points);

/// {`tension_N` (the greater of both conditions), `breaking_load_N` (null where unknown),
/// `required_safety_factor`, `wall_mm`, `breakdown_voltage_V` (null where unknown)}.
[[nodiscard]] nlohmann::ordered_json cable_json(const Design& design, const AreaPoints& points);

/// Sentences on heat, strength and voltage at one cross-section, without line breaks.
[[nodiscard]] std::vector<std::string> cable_sentences(const Design& design,
                                                       const AreaPoints& points);

/// What the heat balance of this design does not know and the user should, a sentence each.
[[nodiscard]] std::vector<std::string> cable_warnings(const Design& design);

/// What the reader of the spec noted, then these.
[[nodiscard]] std::vector<std::string> all_warnings(const DesignFile& file);

}  // namespace tethercalc
