#include "cli/design_search_commands.hpp"

#include <nlohmann/json.hpp>

#include "tethercalc/io/design_reader.hpp"

namespace tethercalc::cli {

int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output) {
  const DesignStudy answer = study_design(read_design(spec.file, spec.overrides), request);
  switch (output.format) {
    case Format::table:
      emit(output, design_text(answer, style_for(output)));
      break;
    case Format::json:
      emit(output, json_text(design_json(answer)));
      break;
    case Format::csv:
      emit(output, design_csv(answer));
      break;
  }
  return answer.answer.feasible ? done : answer_is_no;
}

}  // namespace tethercalc::cli
