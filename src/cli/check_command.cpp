#include "cli/check_command.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tethercalc/io/whole_file.hpp"
#include "tethercalc/report/reference_check.hpp"

namespace tethercalc::cli {
int run_check(const CheckOptions& options, const Output& output) {
  std::vector<ReferenceCheck> checks;
  for (const auto& spec : reference_specs(options.paths)) checks.push_back(check_reference(spec));
  if (!options.junit_file.empty()) write_whole_file(options.junit_file, check_junit(checks));

  std::vector<InputProblem> problems;
  for (const ReferenceCheck& check : checks) {
    problems.insert(problems.end(), check.problems.begin(), check.problems.end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));

  if (options.update) {
    for (const ReferenceCheck& check : checks) update_record(check);
  }
  emit(
      output, [&] { return check_text(checks, options.update, style_for(output)); },
      [&] { return check_json(checks); }, [&] { return check_csv(checks); });
  const bool passed = std::all_of(checks.begin(), checks.end(),
                                  [](const ReferenceCheck& check) { return check.passed(); });
  return passed || options.update ? done : answer_is_no;
}

}  // namespace tethercalc::cli
