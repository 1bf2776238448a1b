// A diagnosis told to a person, to a program, and as the spec that it leads to.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// "findings", "suspected" …: the keys under which a diagnosis says what it holds of effects.
[[nodiscard]] std::span<const std::string_view> verdict_names();

/// The result keys of `diagnose`; `extended` is the extended spec and may be null. Numbers that do
/// not exist are null.
[[nodiscard]] nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis,
                                                    const nlohmann::ordered_json& extended);

/// What stands above some paragraphs of a story.
struct StoryHeading {
  std::string text;  ///< one line
};
/// What the last part of an error budget is: noise, where structure in it would have shown.
[[nodiscard]] std::string rest_words(const Unexplained& unexplained);

/// What to fly by a design with the findings of its logs, in one sentence; empty where nothing
/// moves in the digits that are printed.
[[nodiscard]] std::string impact_headline(const DesignImpact& impact);

/// Lines to be copied as they are.
struct StoryLines {
  std::string text;  ///< each ends in a line break
};
/// A heading, a paragraph, a table, or lines.
using StoryPart = std::variant<StoryHeading, std::string, TitledTable, StoryLines>;

/// The story: what was predicted and measured, where the error comes from, each finding in two
/// sentences, what stays unexplained, what the design gains, and what could not be tested.
/// Paragraphs carry the colours that `style` allows.
[[nodiscard]] std::vector<StoryPart> diagnosis_story(const Diagnosis& diagnosis,
                                                     const TextStyle& style = {});

/// The story as text.
[[nodiscard]] std::string diagnosis_text(const Diagnosis& diagnosis, const TextStyle& style);

/// A header and one row a parameter of a finding:
/// effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent.
[[nodiscard]] std::string diagnosis_csv(const std::vector<Finding>& findings);

/// A flight log and a power log of one drone: the lists of both in one, what of the two design
/// impacts `power` carries, and each diagnosis by itself under "flight" and "power".
[[nodiscard]] nlohmann::ordered_json joint_diagnosis_json(const Diagnosis& flight,
                                                          const Diagnosis& power,
                                                          const nlohmann::ordered_json& extended);

/// Both stories, then the design impact that `power` carries.
[[nodiscard]] std::string joint_diagnosis_text(Diagnosis flight, Diagnosis power,
                                               const TextStyle& style);

}  // namespace tethercalc
