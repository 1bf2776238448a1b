#include "cli/design_search_commands.hpp"

#include <nlohmann/json.hpp>

#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/envelope_report.hpp"

namespace tethercalc::cli {

int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output) {
  const DesignFile file = read_design(spec.file, spec.overrides);
  const DesignStudy answer = study_design(read_design_request(file, request));
  emit(
      output, [&] { return design_text(file, request, answer, style_for(output)); },
      [&] { return design_json(file, request, answer); },
      [&] { return design_csv(request, answer); });
  return answer.answer.feasible ? done : answer_is_no;
}

int run_envelope(const EvaluateOptions& options, const Output& output) {
  DesignFile file = read_design(options.spec.file, options.spec.overrides);
  if (options.areas_mm2.size() > 1) {
    throw InputError("--area-mm2", "an envelope is that of one cross-section");
  }
  if (!options.areas_mm2.empty()) {
    file.design.tether.cross_section = options.areas_mm2.front() * unit::square_millimetre;
  }
  if (!file.design.tether.cross_section) {
    throw InputError("--area-mm2", "is needed: the spec sets no tether.cross_section_mm2");
  }
  const EnvelopeStudy answer = study_envelope(file.design);
  emit(
      output, [&] { return envelope_text(file, answer, style_for(output)); },
      [&] { return envelope_json(file, answer); }, [&] { return envelope_csv(answer); });
  return answer.any() ? done : answer_is_no;
}

}  // namespace tethercalc::cli
