#include "cli/commands.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "files/input_files.hpp"
#include "files/output_files.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/report/reference_check.hpp"

namespace tethercalc::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view record_suffix = ".expected.json";

/// "design.expected.json" beside "design.json".
std::string record_path(fs::path spec) {
  return spec.replace_extension().string() + std::string(record_suffix);
}

/// Every .json file of a folder that is no record, by name.
std::vector<fs::path> specs_of_folder(const fs::path& folder) {
  std::vector<fs::path> specs;
  std::vector<InputProblem> problems;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    const std::string name = path.filename().string();
    if (name.ends_with(record_suffix)) {
      const fs::path spec = folder / (name.substr(0, name.size() - record_suffix.size()) + ".json");
      if (!fs::exists(spec)) {
        problems.push_back({path.string(), "there is no spec " + spec.filename().string() +
                                               " beside this record"});
      }
    } else if (name.ends_with(".json")) {
      specs.push_back(path);
    }
  }
  if (specs.empty()) problems.push_back({folder.string(), "holds no design specs (.json)"});
  if (!problems.empty()) throw InputError(std::move(problems));
  std::sort(specs.begin(), specs.end());
  return specs;
}

/// The specs that `paths` mean: files themselves (a record means its spec), and those of folders.
std::vector<fs::path> reference_specs(std::span<const std::string> paths) {
  std::vector<fs::path> specs;
  for (const std::string& path : paths) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      const std::vector<fs::path> found = specs_of_folder(path);
      specs.insert(specs.end(), found.begin(), found.end());
    } else if (path.ends_with(record_suffix)) {
      specs.emplace_back(path.substr(0, path.size() - record_suffix.size()) + ".json");
    } else {
      specs.emplace_back(path);
    }
  }
  return specs;
}

std::optional<LoadedText> record_of(const fs::path& spec) {
  const std::string record = record_path(spec);
  return fs::exists(record) ? std::optional(read_text_file(record)) : std::nullopt;
}

ReferenceCheck checked(const fs::path& spec) {
  try {
    return check_reference(spec.string(), read_design(spec.string()), record_of(spec));
  } catch (const InputError& error) {
    ReferenceCheck check;
    check.spec = spec.string();
    check.problems = error.problems();
    return check;
  }
}

}  // namespace

int run_check(const CheckOptions& options, const Output& output) {
  std::vector<ReferenceCheck> checks;
  for (const auto& spec : reference_specs(options.paths)) checks.push_back(checked(spec));
  if (!options.junit_file.empty()) write_whole_file(options.junit_file, check_junit(checks));

  std::vector<InputProblem> problems;
  for (const ReferenceCheck& check : checks) {
    problems.insert(problems.end(), check.problems.begin(), check.problems.end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));

  if (options.update) {
    for (const ReferenceCheck& check : checks) {
      if (check.passed()) continue;
      write_whole_file(record_path(check.spec), updated_record(check, record_of(check.spec)));
    }
  }
  emit(
      output, [&] { return check_text(checks, options.update, style_for(output)); },
      [&] { return check_json(checks); }, [&] { return check_csv(checks); });
  const bool passed = std::all_of(checks.begin(), checks.end(),
                                  [](const ReferenceCheck& check) { return check.passed(); });
  return passed || options.update ? done : answer_is_no;
}

}  // namespace tethercalc::cli
