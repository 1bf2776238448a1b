#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "io/json_document.hpp"
#include "tethercalc/report/explanation.hpp"

namespace tethercalc::cli {

int run_explain(const std::string& code, ExplanationForm form, const Output& output) {
  if (code.empty()) {
    emit(output, form == ExplanationForm::json       ? json_text(explanation_list_json())
                 : form == ExplanationForm::markdown ? explanations_markdown()
                                                     : explanation_list_text(style_for(output)));
    return done;
  }
  const Explanation& page = explanation_of(code);
  emit(output, form == ExplanationForm::json       ? json_text(explanation_json(page))
               : form == ExplanationForm::markdown ? explanation_markdown(page)
                                                   : explanation_text(page, style_for(output)));
  return done;
}

void point_to_explanations(std::vector<std::string> codes, std::span<const Warning> warnings,
                           const Output& output) {
  if (output.format != Format::table || !output.file.empty() || !shows_progress()) return;
  for (const Warning& warning : warnings) codes.emplace_back(warning_code(warning.kind));
  std::vector<std::string> told;
  for (const std::string& code : codes) {
    if (find_explanation(code) == nullptr || std::ranges::count(told, code) > 0) continue;
    told.push_back(code);
  }
  if (told.empty()) return;
  remark(fmt::format("tethercalc explain CODE says more of {}\n", fmt::join(told, ", ")));
}

}  // namespace tethercalc::cli
