// A diagnosis with the spec that it leads to, from reading the logs to the words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/log_questions.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// What the logs say; either may be absent.
struct ToldDiagnosis : DiagnosisStudy {
  nlohmann::ordered_json spec;  ///< of the extended design
};

/// Compares each log of `asked`, which `options` name, with the design of `file` as it stands; what
/// both together do to the design stands in the last of them. Drag that a flight shows directly
/// outranks what the power at the motors says of it. Throws InputError for bad input.
[[nodiscard]] ToldDiagnosis told_diagnosis(const AskedDiagnosis& asked, const LogsAsked& options,
                                           const DesignFile& file,
                                           const SelectionProgress& progress = {});

/// The story of either, or of both together.
[[nodiscard]] std::string told_text(const ToldDiagnosis& told, const TextStyle& style);
/// The result keys of `diagnose`.
[[nodiscard]] nlohmann::ordered_json told_json(const ToldDiagnosis& told);
/// A row a finding, the flight's first.
[[nodiscard]] std::string told_csv(const ToldDiagnosis& told);

}  // namespace tethercalc
