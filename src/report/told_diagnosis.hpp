// A diagnosis with the spec that it leads to, in words.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/diagnosis.hpp"

namespace tethercalc {

/// What the logs say; either may be absent.
struct ToldDiagnosis : DiagnosisStudy {
  nlohmann::ordered_json spec;  ///< of the extended design
};

/// What a study says of logs held against the design of `file`, with that file's own warnings among
/// the notes of the last log. Throws InputError where the extended design makes no spec.
[[nodiscard]] ToldDiagnosis told_diagnosis(DiagnosisStudy study, const DesignFile& file);

/// The story of either, or of both together.
[[nodiscard]] std::string told_text(const ToldDiagnosis& told, const TextStyle& style);
/// The result keys of `diagnose`.
[[nodiscard]] nlohmann::ordered_json told_json(const ToldDiagnosis& told);
/// A row a finding, the flight's first.
[[nodiscard]] std::string told_csv(const ToldDiagnosis& told);

}  // namespace tethercalc
