#include "cli/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
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
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/reference_check.hpp"
#include "tethercalc/study/motor.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc::cli {
namespace {

/// The area of the standard size of that name, however its blank and letters are typed: "AWG 18",
/// "awg18".
std::optional<double> standard_area(std::string_view text) {
  const auto plain = [](std::string_view name) {
    std::string out;
    for (const char c : name) {
      if (c != ' ') out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return out;
  };
  for (const WireSize& size : wire_sizes()) {
    if (plain(size.name) == plain(text)) return size.area;
  }
  return std::nullopt;
}

/// The cross-sections that were typed in mm² or as names of standard sizes, in m².
std::vector<double> parsed_areas(const std::vector<std::string>& texts) {
  std::vector<double> areas;
  Problems problems;
  for (const std::string& text : texts) {
    if (const auto area = standard_area(text)) {
      areas.push_back(*area);
      continue;
    }
    char* end = nullptr;
    const double area = std::strtod(text.c_str(), &end);
    // Beyond these, square millimetres were surely not meant, and the physics loses its digits.
    if (end == text.c_str() || *end != '\0' || !(area >= 1e-6 && area <= 1e6)) {
      problems.add("--area-mm2",
                   "\"" + text + "\" is not a cross-section from 0.000001 to 1000000 mm², nor a " +
                       "standard size such as AWG18");
    }
    areas.push_back(area * unit::square_millimetre);
  }
  problems.throw_if_any();
  return areas;
}

/// `areas`, or else the spec's own.
std::vector<double> chosen_areas(std::vector<double> areas, const Design& design) {
  if (!areas.empty()) return areas;
  if (!design.tether.cross_section) {
    throw InputError("--area-mm2", "is needed: the spec sets no tether.cross_section_mm2");
  }
  return {*design.tether.cross_section};
}

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
    return check_reference(spec.string(), file, record_of(spec));
  } catch (const InputError& error) {
    ReferenceCheck check;
    check.spec = spec.string();
    check.problems = error.problems();
    return check;
  }
}

}  // namespace

DesignFile read_spec(const SpecOptions& spec) { return read_design(spec.file, spec.overrides); }

std::vector<MotorEntry> chosen_motors(const std::vector<std::string>& names,
                                      const DesignFile& file) {
  std::vector<MotorEntry> motors;
  Problems problems;
  for (const std::string& name : names) {
    if (name == "all") {
      const std::vector<MotorEntry> library = library_motors();
      motors.insert(motors.end(), library.begin(), library.end());
      if (std::ranges::find(library, file.motor.id, &MotorEntry::id) == library.end()) {
        motors.push_back(file.motor);
      }
      continue;
    }
    if (name == "alike") {
      const std::vector<MotorEntry> alike = alike_motors(library_motors(), file.motor);
      motors.insert(motors.end(), alike.begin(), alike.end());
      continue;
    }
    try {
      motors.push_back(find_motor(name, files_in(""), "--motors"));
    } catch (const InputError& error) {
      problems.add(error.problems());
    }
  }
  problems.throw_if_any();
  return motors;
}

int run_optimize(const SpecOptions& spec, const Output& output) {
  const DesignFile file = read_spec(spec);
  const OptimumStudy answer = study_optimum(file.design, wire_sizes());
  emit(
      output, [&] { return optimize_text(file, answer, style_for(output)); },
      [&] { return optimize_json(file, answer); }, [&] { return optimize_csv(answer); });
  std::vector<std::string> codes{std::string(limit_name(answer.result.limited_by))};
  for (const Warning& warning : all_warnings(file)) codes.emplace_back(warning_code(warning.kind));
  point_to_explanations(codes, output);
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
  const std::vector<AreaPoints> table =
      evaluate_areas(file.design, chosen_areas(areas, file.design));
  emit(
      output, [&] { return evaluate_text(file, table, style_for(output)); },
      [&] { return evaluate_json(file, table); }, [&] { return evaluate_csv(table); });
  return done;
}

int run_compare(const SpecOptions& spec, const std::vector<std::string>& motors,
                const Output& output) {
  const DesignFile file = read_spec(spec);
  const std::vector<MotorOptimum> ranking =
      compare_motors(file.design, chosen_motors(motors, file));
  emit(
      output, [&] { return compare_text(file, ranking, style_for(output)); },
      [&] { return compare_json(file, ranking); }, [&] { return compare_csv(ranking); });
  return !ranking.empty() && ranking.front().result.feasible ? done : answer_is_no;
}

int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output) {
  const DesignFile file = read_spec(spec);
  const DesignStudy answer = study_design(read_design_request(file, request));
  emit(
      output, [&] { return design_text(file, request, answer, style_for(output)); },
      [&] { return design_json(file, request, answer); },
      [&] { return design_csv(request, answer); });
  return answer.answer.feasible ? done : answer_is_no;
}

int run_envelope(const SpecOptions& spec, const std::vector<std::string>& areas_mm2,
                 const Output& output) {
  const std::vector<double> areas = parsed_areas(areas_mm2);
  DesignFile file = read_spec(spec);
  if (areas.size() > 1) throw InputError("--area-mm2", "an envelope is that of one cross-section");
  file.design.tether.cross_section = chosen_areas(areas, file.design).front();
  const EnvelopeStudy answer = study_envelope(file.design);
  emit(
      output, [&] { return envelope_text(file, answer, style_for(output)); },
      [&] { return envelope_json(file, answer); }, [&] { return envelope_csv(answer); });
  return answer.any() ? done : answer_is_no;
}

namespace {

WindProfile parsed_profile(const std::string& text) {
  const std::vector<std::string> names{"uniform", "power-law", "logarithmic"};  // as in WindProfile
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) return static_cast<WindProfile>(found - names.begin());
  throw InputError("--profile", "\"" + text +
                                    "\" is not a profile; allowed are uniform, power-law " +
                                    "and logarithmic" + did_you_mean(text, names));
}

/// The number in its range; `least`, with the reason among the problems, outside.
double checked(Problems& problems, const char* option, double value, double least, double most,
               const char* unit) {
  if (value >= least && value <= most) return value;
  problems.add(option, fmt::format("{:g} is out of range; allowed is {:g} to {:g} {}", value, least,
                                   most, unit));
  return least;
}

/// The numbers of a list, each in its range.
std::vector<double> checked(Problems& problems, const char* option,
                            const std::vector<std::string>& texts, double least, double most,
                            const char* unit) {
  std::vector<double> numbers;
  for (const std::string& text : texts) {
    if (const auto number = parsed_number(text)) {
      numbers.push_back(checked(problems, option, *number, least, most, unit));
    } else {
      problems.add(option, "\"" + text + "\" is not a number");
    }
  }
  return numbers;
}

/// What decides how much cable is out; several where several slacks are asked for.
std::vector<PaidOut> parsed_paid_out(const ShapeOptions& options, const Design& design,
                                     const ShapeRequest& request, Problems& problems) {
  const int given = int(!options.slacks_percent.empty()) + int(options.length.has_value()) +
                    int(options.winch_tension.has_value());
  if (given > 1) {
    problems.add("--slack, --length, --winch-tension",
                 "one of them decides how much cable is out; give no more");
    return {};
  }
  if (options.length) {
    return {{.length = checked(problems, "--length", *options.length, 1e-3, 1e6, "m"),
             .winch_tension = {}}};
  }
  if (options.winch_tension) {
    return {{.length = {},
             .winch_tension =
                 checked(problems, "--winch-tension", *options.winch_tension, 1e-6, 1e6, "N")}};
  }
  if (given == 0) return {paid_out_to(design.tether, request.height, request.offset)};
  std::vector<PaidOut> out;
  for (const double percent :
       checked(problems, "--slack", options.slacks_percent, 1e-6, 1000, "percent")) {
    Tether tether = design.tether;
    tether.winch_pull = 0;
    tether.slack = percent / 100;
    out.push_back(paid_out_to(tether, request.height, request.offset));
  }
  return out;
}

std::vector<ShapeRequest> parsed_requests(const ShapeOptions& options, const Design& design) {
  Problems problems;
  ShapeRequest request;
  request.height =
      checked(problems, "--height", options.height.value_or(design.tether.length), 0.01, 1e5, "m");
  const Flight& flight = design.flight;
  request.offset =
      checked(problems, "--offset", options.offset.value_or(flight.horizontal_offset), 0, 1e5, "m");
  request.wind_from =
      checked(problems, "--wind-from", options.wind_from, -360, 360, "degrees") * unit::degree;
  request.station_height =
      checked(problems, "--station-height", options.station_height.value_or(flight.station_height),
              0, 1e5, "m");
  request.profile = flight.wind_profile;
  if (options.profile) {
    problems.succeeds([&] { request.profile = parsed_profile(*options.profile); });
  }
  request.reference_height = checked(
      problems, "--reference-height",
      options.reference_height.value_or(flight.wind_reference_height.value_or(10)), 0.1, 1e4, "m");
  request.exponent =
      checked(problems, "--exponent", options.exponent.value_or(flight.wind_exponent), 0, 1, "");
  request.roughness_length =
      checked(problems, "--roughness", options.roughness_length.value_or(flight.roughness_length),
              1e-6, 10, "m");
  if (request.roughness_length >= request.reference_height) {
    problems.add("--roughness", "has to be less than --reference-height");
  }
  request.axial_stiffness = design.tether.axial_stiffness;
  if (options.axial_stiffness) {
    request.axial_stiffness =
        checked(problems, "--stiffness", *options.axial_stiffness, 1, 1e12, "N");
  }
  std::vector<double> winds = checked(problems, "--wind", options.winds, 0, 200, "m/s");
  if (options.winds.empty()) winds = {std::abs(design.flight.airspeed)};
  const std::vector<PaidOut> lengths = parsed_paid_out(options, design, request, problems);
  problems.throw_if_any();
  std::vector<ShapeRequest> requests;
  for (const double wind : winds) {
    for (const PaidOut& paid_out : lengths) {
      requests.push_back(request);
      requests.back().wind = wind;
      requests.back().paid_out = paid_out;
    }
  }
  return requests;
}

int run_cable_cases(const ShapeOptions& options, const Output& output) {
  const LoadedText file = read_text_file(options.cases_file);
  const auto cases = parse_cable_cases(file.text, file.name);
  emit(output, json_text(cable_cases_json(cases)));
  return done;
}

}  // namespace

AskedShapes asked_shapes(const ShapeOptions& options) {
  const std::vector<double> areas = parsed_areas(options.areas_mm2);
  AskedShapes out{read_spec(options.spec), 0, {}};
  if (areas.size() > 1) throw InputError("--area-mm2", "a shape is that of one cross-section");
  out.area = chosen_areas(areas, out.file.design).front();
  out.requests = parsed_requests(options, out.file.design);
  return out;
}

int run_shape(const ShapeOptions& options, const Output& output) {
  if (!options.cases_file.empty()) {
    if (!options.spec.file.empty()) {
      throw InputError("--cases", "takes the place of the spec; give one of them");
    }
    return run_cable_cases(options, output);
  }
  if (options.spec.file.empty()) throw InputError("SPEC", "is needed, or --cases FILE");
  const AskedShapes asked = asked_shapes(options);
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
  return answer.outcome == CableOutcome::hangs && answer.hangs_free ? done : answer_is_no;
}

int run_validate(const std::vector<std::string>& files, const std::vector<std::string>& overrides,
                 const Output& output) {
  std::vector<InputProblem> problems;
  std::string text;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::string& name : files) {
    try {
      const DesignFile file = read_design(name, overrides);
      text += printable(file.file) + ": valid\n";
      std::vector<Warning> warnings = file.warnings;
      if (auto drag = drag_estimate_warning(file.design)) warnings.push_back(std::move(*drag));
      for (const Warning& warning : warnings) {
        text += "  Note: " + printable(warning.sentence) + "\n";
      }
      json.push_back({{"file", file.file}, {"valid", true}});
      add_warnings(json.back(), warnings);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  emit(output, output.format == Format::json ? json_text(json) : text);
  return done;
}

int run_list(const std::string& what, const Output& output) {
  const nlohmann::ordered_json entries = library_json(what);
  emit(
      output, [&] { return library_text(entries, style_for(output)); }, [&] { return entries; },
      [&] { return library_csv(entries); });
  return done;
}

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
  const bool passed = std::ranges::all_of(checks, &ReferenceCheck::passed);
  return passed || options.update ? done : answer_is_no;
}

}  // namespace tethercalc::cli
