// What the commands on a design answer, for people, programs and spreadsheets, and the sentences
// that they share: what limits it, and heat, strength and voltage of its cable.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/design_request.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/envelope.hpp"

namespace tethercalc {

/// "hover" or "forward flight".
[[nodiscard]] std::string condition_words(Condition condition);

/// Why a cable cannot be used in this design, in a few words; empty where it can.
[[nodiscard]] std::string shortcoming(const Design& design, const AreaPoints& points);

/// The same for programs: `feasible`, and `shortcoming`, null where there is none.
[[nodiscard]] nlohmann::ordered_json verdict_json(const Design& design, const AreaPoints& points);

/// Why the optimum is where it is. For a feasible result.
[[nodiscard]] std::string limit_sentence(const Design& design, const Optimization& result);

/// The limit in a word or three, for a table: "least power", "heat".
[[nodiscard]] std::string limit_in_short(Limit limit);

/// Which of heat, strength and the insulation's wall the design was not held to, and that the air
/// of the motors' bench is not known where the published method's is flown in, with the fields that
/// would have it checked; empty where all are.
[[nodiscard]] std::string unchecked_sentence(const Design& design);

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

/// The names of these classes, the lowest first.
[[nodiscard]] std::vector<std::string_view> voltage_class_names();

/// {`ambient_temperature_C`, `rated_temperature_C`, `hover`, `forward` {`conductor_temperature_C`,
/// `drum_temperature_C`, `runaway`}}; null where the design has no ambient temperature.
[[nodiscard]] nlohmann::ordered_json thermal_json(const Design& design, const AreaPoints& points);

/// {`tension_N` (the greater of both conditions), `breaking_load_N` (null where unknown),
/// `required_safety_factor`, `wall_mm`, `breakdown_voltage_V` (null where unknown), of a solved
/// tether `hanging` {`hover`, `forward` {`paid_out_m`, `tension_N`}}}.
[[nodiscard]] nlohmann::ordered_json cable_json(const Design& design, const AreaPoints& points);

/// Sentences on heat, strength and voltage at one cross-section, without line breaks.
[[nodiscard]] std::vector<std::string> cable_sentences(const Design& design,
                                                       const AreaPoints& points);

/// What the heat balance of this design does not know or does not use, and the user should know;
/// `flown` are the cross-sections in question, empty for any.
[[nodiscard]] std::vector<Warning> cable_warnings(const Design& design,
                                                  std::span<const AreaPoints> flown);

/// That the density of the air does not reach the motor's curve, and what that comes to; nothing
/// where `unscaled_motors` finds nothing to tell, and in the published method's 1.293 kg/m³, where
/// `unchecked_sentence` has it.
[[nodiscard]] std::optional<Warning> density_warning(const Design& design);

/// That the drag is an estimate, which one, and by how much it may be off; nothing where it is not.
[[nodiscard]] std::optional<Warning> drag_estimate_warning(const Design& design);

/// What no comparison of motors counts.
[[nodiscard]] Warning motor_mass_warning();

/// What the reader of the spec noted, whether the drag is an estimate, and whether the motors'
/// curve should have been scaled to the density of the air.
[[nodiscard]] std::vector<Warning> spec_warnings(const DesignFile& file);

/// That a solved tether would hang below its station, in which condition and how far; begins with
/// `where`, if that is known.
[[nodiscard]] Warning ground_warning(const GroundContact& ground, const std::string& where = {});

/// How much more another side of the station takes than the one that was judged.
[[nodiscard]] Warning side_warning(const WorstSide& side);

/// That a tether which hangs steeply gets hotter in still air than one that lies across, which is
/// what was computed, where that might take it beyond its rating; nothing where
/// `tether.inclination_deg` is stated.
[[nodiscard]] std::optional<Warning> inclination_warning(const Design& design,
                                                         const OperatingPoint& hover);

/// `spec_warnings`, then `cable_warnings`, then the first `inclination_warning` of the
/// cross-sections in a table, and the `ground_warning` and `side_warning` of one.
[[nodiscard]] std::vector<Warning> all_warnings(const DesignFile& file,
                                                std::span<const AreaPoints> table = {},
                                                const std::optional<GroundContact>& ground = {},
                                                const std::optional<WorstSide>& side = {});

/// All of an evaluation.
[[nodiscard]] std::vector<Warning> evaluation_warnings(const DesignFile& file,
                                                       const EvaluationStudy& study);

/// All of an envelope.
[[nodiscard]] std::vector<Warning> envelope_warnings(const DesignFile& file,
                                                     const EnvelopeStudy& study);

/// All of an optimum.
[[nodiscard]] std::vector<Warning> optimum_warnings(const DesignFile& file,
                                                    const OptimumStudy& study);

/// A table of one cross-section.
[[nodiscard]] inline std::span<const AreaPoints> only(const AreaPoints& row) { return {&row, 1}; }

// --- `optimize`, `evaluate` and `compare` ---

/// The answer in words.
struct Answer {
  std::string headline;                ///< the cable to fly, or that none can
  std::vector<std::string> sentences;  ///< why, and what that means in flight
  std::vector<std::string> remedies;   ///< changes that help where none can: "a supply of …"
};

/// What is told of a design before any table.
[[nodiscard]] Answer answer(const DesignFile& file, const OptimumStudy& study);

/// Power, current, voltage and headroom of the optimum, a row a condition. For a feasible result.
[[nodiscard]] TitledTable condition_table(const Optimization& result);

/// `study.sizes`, with what keeps each from being usable.
[[nodiscard]] TitledTable sizes_table(const OptimumStudy& study);

/// `study.table`, the optimum emphasised.
[[nodiscard]] TitledTable power_table(const OptimumStudy& study);

/// Opens with the answer in sentences, then standard sizes and the power table; 100 columns at
/// most.
[[nodiscard]] std::string optimize_text(const DesignFile& file, const OptimumStudy& study,
                                        const TextStyle& style);

/// The result keys of `optimize`.
[[nodiscard]] nlohmann::ordered_json optimize_json(const DesignFile& file,
                                                   const OptimumStudy& study);

/// A header and one row: status, limit, area, and both operating points.
[[nodiscard]] std::string optimize_csv(const OptimumStudy& study);

/// A table a condition, and what keeps an area from being usable.
[[nodiscard]] std::string evaluate_text(const DesignFile& file, const EvaluationStudy& study,
                                        const TextStyle& style);
/// The keys `table`, `as_given`, `thermal` and `cable` of `evaluate`, lists with an entry an area
/// (`thermal` null without a heat balance): the objects of `optimize`, and `verdict_json`.
[[nodiscard]] nlohmann::ordered_json evaluate_json(const DesignFile& file,
                                                   const EvaluationStudy& study);
/// A header and two rows an area, hover first, each with the verdict on its area.
[[nodiscard]] std::string evaluate_csv(const Design& design, std::span<const AreaPoints> table);

/// The feasible motors of a ranking of `compare_motors`.
[[nodiscard]] TitledTable motor_table(const Design& design, std::span<const MotorOptimum> ranking);

/// The infeasible ones, each with the reason in a few words.
[[nodiscard]] std::vector<std::string> refused_motors(std::span<const MotorOptimum> ranking);

/// The ranking as a table, the infeasible motors below it with the reason.
[[nodiscard]] std::string compare_text(const DesignFile& file,
                                       std::span<const MotorOptimum> ranking,
                                       const TextStyle& style);
/// An object a motor, with its optimum as in `optimize`.
[[nodiscard]] nlohmann::ordered_json compare_json(const DesignFile& file,
                                                  std::span<const MotorOptimum> ranking);
/// A header and a row a motor, with the columns of `optimize_csv` after its id.
[[nodiscard]] std::string compare_csv(std::span<const MotorOptimum> ranking);

// --- `design`: the best whole design among those that free fields allow ---

/// Opens with the answer, then what binds, how sure it is, the front and the spec.
[[nodiscard]] std::string design_text(const DesignFile& file, const DesignRequest& request,
                                      const DesignStudy& study, const TextStyle& style);
/// The same for programs.
[[nodiscard]] nlohmann::ordered_json design_json(const DesignFile& file,
                                                 const DesignRequest& request,
                                                 const DesignStudy& study);

/// What is to be known of the design found. Of a motor that the search chose the reader of the spec
/// noted nothing: that it is an estimate is told, and what no comparison of motors counts.
[[nodiscard]] std::vector<Warning> design_warnings(const DesignFile& file,
                                                   const DesignStudy& study);

/// A header and one row: the free fields, whether the design is feasible, and the objective.
[[nodiscard]] std::string design_csv(const DesignRequest& request, const DesignStudy& study);

// --- `envelope`: how high, how heavy, how fast and in how much wind a given cable flies ---

/// A sentence a reach, then a table a curve.
[[nodiscard]] std::string envelope_text(const DesignFile& file, const EnvelopeStudy& study,
                                        const TextStyle& style);

/// `greatest` {`height_m`, `payload_g`, `headwind_m_s`, `airspeed_m_s`: {`value`, `limited_by`,
/// `limiting_condition`, `sentence`}}, `curves` [{`of`, `against`, `points`}].
[[nodiscard]] nlohmann::ordered_json envelope_json(const DesignFile& file,
                                                   const EnvelopeStudy& study);

/// A row a point of a curve.
[[nodiscard]] std::string envelope_csv(const EnvelopeStudy& study);

// --- `list`: what the library holds ---

/// What the library holds of `what`: "motors", "conductors", "insulation" or "sizes", an object an
/// entry with its numbers under keys that end in their units, null where nobody stated one; sources
/// last, where there are any. Throws InputError for anything else.
[[nodiscard]] nlohmann::ordered_json library_json(const std::string& what);

/// The same as a table. Numbers with the digits that distinguish them; sources below it, each once.
[[nodiscard]] std::string library_text(const nlohmann::ordered_json& entries,
                                       const TextStyle& style);
/// A header and a row an entry, all of which have the same keys; at least one.
[[nodiscard]] std::string entries_csv(const nlohmann::ordered_json& entries);

}  // namespace tethercalc
