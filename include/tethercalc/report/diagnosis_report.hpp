// A diagnosis told to a person, to a program, and as the spec that it leads to.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// `spec` with every field of `diagnosis.spec_changes` in its place; objects on the way are made
/// where they are missing. What the spec says otherwise is kept.
[[nodiscard]] nlohmann::ordered_json extended_spec(nlohmann::ordered_json spec,
                                                   const Diagnosis& diagnosis);

/// The result keys of `diagnose`; `extended` is the extended spec and may be null. Numbers that do
/// not exist are null.
[[nodiscard]] nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis,
                                                    const nlohmann::ordered_json& extended);

/// The story: what was predicted and measured, where the error comes from, each finding in two
/// sentences, what stays unexplained, what the design gains, and what could not be tested.
[[nodiscard]] std::string diagnosis_text(const Diagnosis& diagnosis, const TextStyle& style);

/// A header and one row a parameter of a finding:
/// effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent.
[[nodiscard]] std::string diagnosis_csv(const Diagnosis& diagnosis);

}  // namespace tethercalc
