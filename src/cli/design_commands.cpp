#include "cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "files/input_files.hpp"
#include "files/output_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "report/characters.hpp"
#include "report/result_values.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/cable_cases.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/reference_check.hpp"
#include "tethercalc/study/motor.hpp"
#include "tethercalc/study/results.hpp"

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
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  if (error) {
    throw InputError(folder.string(), fmt::format("cannot be read: {}", error.message()));
  }
  for (const fs::directory_entry& entry : entries) {
    const fs::path& path = entry.path();
    const std::string name = path.filename().string();
    if (name.ends_with(record_suffix)) {
      const fs::path spec = folder / (name.substr(0, name.size() - record_suffix.size()) + ".json");
      std::error_code unknown;  // in a folder that can be listed but not entered
      if (!fs::exists(spec, unknown) && !unknown) {
        problems.push_back({path.string(), "there is no spec " + spec.filename().string() +
                                               " beside this record"});
      }
    } else if (name.ends_with(".json")) {
      specs.push_back(path);
    }
  }
  if (specs.empty()) problems.push_back({folder.string(), "holds no design specs (.json)"});
  if (!problems.empty()) throw InputError(std::move(problems));
  std::ranges::sort(specs);
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

/// A pipe beside specs would be waited for without end.
void refuse_pipe(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_other(fs::status(path, ignored))) {
    throw InputError(path.string(), "is a pipe, socket or device, not a file");
  }
}

std::optional<LoadedText> record_of(const fs::path& spec) {
  const std::string record = record_path(spec);
  refuse_pipe(record);
  std::error_code ignored;
  if (fs::status(record, ignored).type() == fs::file_type::not_found) return std::nullopt;
  return read_text_file(record);
}

ReferenceCheck checked(const fs::path& spec) {
  try {
    refuse_pipe(spec);
    const DesignFile file = read_design(spec.string());
    return check_reference(spec.string(), file, reference_results(file.design), record_of(spec));
  } catch (const InputError& error) {
    ReferenceCheck check;
    check.spec = spec.string();
    check.problems = error.problems();
    return check;
  }
}

}  // namespace

DesignFile read_spec(const SpecOptions& spec) { return read_design(spec.file, spec.overrides); }

void remark_unused(const SpecOptions& spec, std::span<const SweepAxis> axes,
                   std::string_view command, std::string_view option) {
  for (const std::string& set : spec.overrides) {
    const std::string path = set.substr(0, set.find('='));
    if (std::ranges::count(axes, path, &SweepAxis::name) == 0) continue;
    remark(fmt::format("{}: --set {} is not used: {} gives {} its values\n", command, set, option,
                       path));
  }
}

int run_optimize(const SpecOptions& spec, const Output& output) {
  const DesignFile file = read_spec(spec);
  const OptimumStudy answer = study_optimum(file.design, wire_sizes());
  emit(
      output, [&] { return optimize_text(file, answer, style_for(output)); },
      [&] { return optimize_json(file, answer); }, [&] { return optimize_csv(answer); });
  point_to_explanations({std::string(limit_name(answer.result.limited_by))},
                        optimum_warnings(file, answer), output);
  return answer.result.feasible ? done : answer_is_no;
}

int run_evaluate(const SpecOptions& spec, const std::vector<std::string>& areas_mm2,
                 const Output& output) {
  Problems problems;
  std::vector<double> areas;
  DesignFile file;
  problems.succeeds([&] { areas = parsed_areas(areas_mm2); });
  problems.succeeds([&] { file = read_spec(spec); });
  problems.throw_if_any();
  const EvaluationStudy answer = study_evaluation(file.design, chosen_areas(areas, file.design));
  emit(
      output, [&] { return evaluate_text(file, answer, style_for(output)); },
      [&] { return evaluate_json(file, answer); },
      [&] { return evaluate_csv(file.design, answer.table); });
  point_to_explanations({}, evaluation_warnings(file, answer), output);
  return done;
}

int run_compare(const SpecOptions& spec, const std::vector<std::string>& motors,
                const Output& output) {
  const DesignFile file = read_spec(spec);
  const std::vector<MotorOptimum> ranking =
      compare_motors(file.design, chosen_motors(motors, file, files_in("")));
  emit(
      output, [&] { return compare_text(file, ranking, style_for(output)); },
      [&] { return compare_json(file, ranking); }, [&] { return compare_csv(ranking); });
  return !ranking.empty() && ranking.front().result.feasible ? done : answer_is_no;
}

int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output) {
  const DesignFile file = read_spec(spec);
  const DesignQuestion question = read_design_request(file, request);
  remark_unused(spec, question.problem.free, "design", "--free");
  const DesignStudy answer = study_design(question);
  emit(
      output, [&] { return design_text(file, request, answer, style_for(output)); },
      [&] { return design_json(file, request, answer); },
      [&] { return design_csv(request, answer); });
  point_to_explanations({}, design_warnings(file, answer), output);
  return answer.answer.feasible ? done : answer_is_no;
}

int run_envelope(const SpecOptions& spec, const std::vector<std::string>& areas_mm2,
                 const Output& output) {
  DesignFile file = read_spec(spec);
  file.design.tether.cross_section = one_area(areas_mm2, file.design, "an envelope");
  const EnvelopeStudy answer = study_envelope(file.design);
  emit(
      output, [&] { return envelope_text(file, answer, style_for(output)); },
      [&] { return envelope_json(file, answer); }, [&] { return envelope_csv(answer); });
  std::vector<std::string> codes;
  for (const ReachResult& result : answer.greatest) {
    if (result.end && result.end->bounded) codes.emplace_back(limit_name(result.end->limit));
  }
  point_to_explanations(std::move(codes), envelope_warnings(file, answer), output);
  return answer.any() ? done : answer_is_no;
}

namespace {

int run_cable_cases(const ShapeOptions& options, const Output& output) {
  const LoadedText file = read_text_file(options.cases_file);
  std::vector<SolvedCase> solved;
  for (CableCase& one : parse_cable_cases(file.text, file.name)) {
    solved.push_back(solve_cable_case(std::move(one)));
  }
  emit(output, json_text(cable_cases_json(solved)));
  return done;
}

}  // namespace

int run_shape(const ShapeOptions& options, const Output& output) {
  if (!options.cases_file.empty()) {
    Problems problems;
    if (!options.spec.file.empty()) {
      problems.add("--cases", "takes the place of the spec; give one of them");
    }
    constexpr std::array<std::string_view, 4> kept{"--cases", "--output", "--color", "--quiet"};
    for (const std::string& name : options.given) {
      if (std::ranges::find(kept, name) != kept.end() || !name.starts_with("--")) continue;
      if (name != "--format") {
        problems.add(name, "says nothing beside --cases, whose file has the whole cable");
      } else if (output.format != Format::json) {
        problems.add(name, "has to be json beside --cases, whose answer has no other form");
      }
    }
    problems.throw_if_any();
    return run_cable_cases(options, output);
  }
  if (options.spec.file.empty()) throw InputError("SPEC", "is needed, or --cases FILE");
  const AskedShapes asked = asked_shapes(options, read_spec(options.spec));
  if (asked.requests.size() > 1) {
    throw InputError("--wind, --slack", "a shape is that of one of each; plot shape draws several");
  }
  const ShapeRequest& request = asked.requests.front();
  const ShapeStudy answer = study_cable_shape(asked.file.design, asked.area, request);
  emit(
      output,
      [&] { return cable_shape_text(asked.file, asked.area, request, answer, style_for(output)); },
      [&] { return cable_shape_json(asked.file, asked.area, answer); },
      [&] { return cable_shape_csv(answer); });
  std::vector<std::string> codes;
  const bool hangs = answer.outcome == CableOutcome::hangs && answer.hangs_free;
  if (!hangs) codes.emplace_back(cable_outcome_name(answer));
  point_to_explanations(std::move(codes), spec_warnings(asked.file), output);
  return hangs ? done : answer_is_no;
}

int run_validate(const std::vector<std::string>& files, const std::vector<std::string>& overrides,
                 const Output& output) {
  struct Valid {
    std::string file;
    std::vector<Warning> warnings;
  };
  std::vector<Valid> valid;
  Problems problems;
  for (const std::string& name : files) {
    problems.succeeds([&] {
      const DesignFile file = read_design(name, overrides);
      valid.push_back({file.file, spec_warnings(file)});
    });
  }
  problems.throw_if_any();
  const auto text = [&] {
    std::string out;
    for (const auto& [file, warnings] : valid) {
      out += printable(file) + ": valid\n";
      for (const Warning& warning : warnings)
        out += "  Note: " + printable(warning.sentence) + "\n";
    }
    return out;
  };
  const auto json = [&] {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const auto& [file, warnings] : valid) {
      out.push_back({{"file", file}, {"valid", true}});
      add_warnings(out.back(), warnings);
    }
    return out;
  };
  const auto csv = [&] {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const auto add = [&rows](const std::string& file, const nlohmann::ordered_json& code,
                             const nlohmann::ordered_json& sentence) {
      rows.push_back({{"file", file}, {"valid", true}, {"code", code}, {"warning", sentence}});
    };
    for (const auto& [file, warnings] : valid) {
      if (warnings.empty()) add(file, nullptr, nullptr);
      for (const Warning& w : warnings) add(file, warning_code(w.kind), w.sentence);
    }
    return entries_csv(rows);
  };
  emit(output, text, json, csv);
  return done;
}

int run_list(const std::string& what, const Output& output) {
  const nlohmann::ordered_json entries = library_json(what);
  emit(
      output, [&] { return library_text(entries, style_for(output)); }, [&] { return entries; },
      [&] { return entries_csv(entries); });
  return done;
}

int run_check(const CheckOptions& options, const Output& output) {
  std::vector<ReferenceCheck> checks;
  for (const auto& spec : reference_specs(options.paths)) checks.push_back(checked(spec));
  if (!options.junit_file.empty())
    write_asked("--junit", options.junit_file, check_junit(checks, options.update));

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
  const bool passed = std::ranges::all_of(checks, &ReferenceCheck::passed);
  return passed || options.update ? done : answer_is_no;
}

}  // namespace tethercalc::cli
