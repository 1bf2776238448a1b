#include "report/told_diagnosis.hpp"

#include <utility>

#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

namespace tethercalc {
namespace {

/// Of one log alone.
const Diagnosis& only_one(const ToldDiagnosis& told) {
  return told.power ? *told.power : *told.flight;
}

}  // namespace

ToldDiagnosis told_diagnosis(DiagnosisStudy study, const DesignFile& file) {
  for (Warning& warning : spec_warnings(file)) {
    (study.power ? study.power : study.flight)->notes.push_back(std::move(warning));
  }
  // Checked as if a person had written it.
  DesignFile extended = read_design_document(spec_with(file, study.extended), file.file, file.load);
  return {std::move(study), std::move(extended.document)};
}

std::string told_text(const ToldDiagnosis& told, const TextStyle& style) {
  return told.flight && told.power ? joint_diagnosis_text(*told.flight, *told.power, style)
                                   : diagnosis_text(only_one(told), style);
}

nlohmann::ordered_json told_json(const ToldDiagnosis& told) {
  return told.flight && told.power ? joint_diagnosis_json(*told.flight, *told.power, told.spec)
                                   : diagnosis_json(only_one(told), told.spec);
}

std::string told_csv(const ToldDiagnosis& told) {
  std::vector<Finding> findings;
  for (const std::optional<Diagnosis>* one : {&told.flight, &told.power}) {
    if (*one) findings.insert(findings.end(), (*one)->findings.begin(), (*one)->findings.end());
  }
  return diagnosis_csv(findings);
}

}  // namespace tethercalc
