#include "cli/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "files/log_file.hpp"
#include "files/output_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/log_options.hpp"
#include "tethercalc/files/effect_file.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/io/mission.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/log_report.hpp"
#include "tethercalc/report/next_flight_report.hpp"

namespace tethercalc::cli {
namespace {

/// A spec that was read at `read_at`, as the file `written` has to hold it; where that is empty, as
/// a command reads it from standard input.
std::string spec_text(nlohmann::ordered_json spec, const std::string& read_at,
                      const std::string& written) {
  return json_text(
      spec_for_folder(std::move(spec), read_at, std::filesystem::path(written).parent_path()));
}

/// The spec with its drag replaced, checked as if a person had edited it.
nlohmann::ordered_json spec_with_drag(const DesignFile& file, const DragFit& fit) {
  Design design = file.design;
  const double asymmetry = design.drone.drag.fore_aft_asymmetry;
  design.drone.drag = fit.drag();
  design.drone.drag.fore_aft_asymmetry = asymmetry;
  return read_design_document(spec_with(file, design), file.file, file.load).document;
}

/// The autopilot whose parameters `--parameters` asks for, if any.
std::optional<Autopilot> parameters_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  const std::vector<std::string> names{"ardupilot", "px4"};  // as in Autopilot
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<Autopilot>(found - names.begin());
  throw InputError("--parameters",
                   fmt::format("\"{}\" is no autopilot; allowed are {}{}", name,
                               fmt::join(names, " and "), did_you_mean(name, names)));
}

/// What was not said and moves the answer, on standard error so that no format hides it.
void tell_assumptions(const FlightOptions& flight, const DragIdentificationOptions& taken) {
  if (!flight.air_density_kg_m3 && !flight.pressure_hPa) {
    remark(fmt::format(
        "drag: no air density given, {} kg/m³ taken (--air-density, or --pressure-hPa with "
        "--temperature-C)\n",
        taken.conditions.air_density));
  }
  if (!flight.pitch_offset_deg && flight.trim_log.empty()) {
    remark(
        "drag: no pitch offset given, 0° taken; what it misses ends up in the wind "
        "(--trim-log or --pitch-offset-deg)\n");
  }
}

void check_range(const char* option, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw InputError(option, fmt::format("{:g} is out of range; allowed is {} to {} {}", value, least,
                                       most, unit));
}

/// One line that is written over, on a terminal only.
SelectionProgress progress_line() {
  if (!shows_progress()) return {};
  return [](const std::string& doing) { std::fprintf(stderr, "\r\x1b[K%s", doing.c_str()); };
}

void clear_progress() {
  if (shows_progress()) std::fprintf(stderr, "\r\x1b[K");
}

/// The effects of the files given, no id twice.
std::vector<Effect> own_effects(const DiagnoseOptions& options) {
  std::vector<Effect> effects;
  for (const std::string& file : options.effect_files) {
    for (Effect& effect : read_effects(file)) {
      const auto same = std::find_if(effects.begin(), effects.end(),
                                     [&](const Effect& other) { return other.id == effect.id; });
      if (same != effects.end()) {
        throw InputError(file, fmt::format("\"{}\" is an effect of another file, too", effect.id));
      }
      effects.push_back(std::move(effect));
    }
  }
  return effects;
}

LoggedFlight read_flights(const DiagnoseOptions& options, std::span<const Effect> own,
                          std::vector<std::string>& notes) {
  LoggedFlight flight;
  flight.mass = flown_mass(options.flight);
  flight.air_density = air_density(options.flight);
  flight.options.base = base_effects(options.base, LogKind::flight, own);
  flight.options.pitch_offset = pitch_offset(options.flight);
  const auto from = log_position("--from", options.flight.from);
  const auto to = log_position("--to", options.flight.to);
  for (const std::string& name : options.flight_logs) {
    FlightLogReading reading =
        read_flight_log(name, {.core = options.flight.core, .level_where_missing = true});
    const bool several = options.flight_logs.size() > 1;
    if (several) {
      notes.push_back(fmt::format("flight {} is {}", flight.flights.size() + 1, name));
    }
    for (const std::string& note : reading.notes) {
      notes.push_back(several ? fmt::format("flight {}: {}", flight.flights.size() + 1, note)
                              : note);
    }
    MeasuredFlight& measured =
        flight.flights.emplace_back(MeasuredFlight{std::move(reading.log), {}});
    try {
      if (from || to) measured.range = select_range(measured.log, from, to);
    } catch (const std::invalid_argument& error) {
      throw InputError(name, error.what());
    }
  }
  return flight;
}

/// What is said of a power log needs one.
void check_power_options(const DiagnoseOptions& options) {
  if (!options.power_log.empty()) return;
  if (options.free_flight) {
    throw InputError("--free-flight", "is of the power; give --power LOG, or --log LOG");
  }
  if (!options.batteries.empty()) {
    throw InputError("--battery", "is of the power; give --power LOG, or --log LOG");
  }
}

DiagnosisStudy studied(const DiagnoseOptions& options, const DiagnosisQuestion& question) {
  try {
    DiagnosisStudy study = study_diagnosis(question, progress_line());
    clear_progress();
    return study;
  } catch (const UnsuitableLog& error) {
    clear_progress();
    throw InputError(error.kind() == LogKind::flight
                         ? fmt::format("{}", fmt::join(options.flight_logs, ", "))
                         : options.power_log,
                     error.what());
  }
}

/// `mission` is where the next flight was written, if anywhere.
void tell(const ToldDiagnosis& told, const std::string& mission, const Output& output) {
  const Diagnosis& only = told.power ? *told.power : *told.flight;
  const bool both = told.flight && told.power;
  emit(
      output,
      [&] {
        std::string text = both ? joint_diagnosis_text(*told.flight, *told.power, style_for(output))
                                : diagnosis_text(only, style_for(output));
        if (told.next_flight) {
          text += next_flight_text(*told.next_flight, mission, style_for(output));
        }
        return text;
      },
      [&] {
        nlohmann::ordered_json json =
            both ? joint_diagnosis_json(*told.flight, *told.power, told.spec)
                 : diagnosis_json(only, told.spec);
        if (told.next_flight) json["next_flight"] = next_flight_json(*told.next_flight, mission);
        return json;
      },
      [&] {
        std::vector<Finding> findings = told.flight ? told.flight->findings : only.findings;
        if (both) {
          findings.insert(findings.end(), told.power->findings.begin(), told.power->findings.end());
        }
        return diagnosis_csv(findings);
      });
}

/// "LAT,LON" in degrees.
Home given_home(const std::string& text) {
  const char* at = text.c_str();
  double numbers[2] = {};
  bool fits = true;
  for (int k = 0; k < 2 && fits; ++k) {
    char* end = nullptr;
    numbers[k] = std::strtod(at, &end);
    fits = end != at && *end == (k == 0 ? ',' : '\0') && std::isfinite(numbers[k]);
    at = end + 1;
  }
  if (!fits || std::abs(numbers[0]) > 85 || std::abs(numbers[1]) > 180) {
    throw InputError("--home",
                     fmt::format("\"{}\" is no place; allowed are a latitude from -85 to 85 and a "
                                 "longitude from -180 to 180, in degrees: 47.3977,8.5456",
                                 text));
  }
  return {numbers[0], numbers[1], 0};
}

/// Where the first flight that knows took off.
std::optional<Home> home_of(const std::vector<std::string>& flight_logs) {
  for (const std::string& name : flight_logs) {
    const LogFile file(name);
    if (looks_like_text(file.bytes()) && !looks_like_dataflash_text(file.bytes())) continue;
    if (const auto home = logged_home(AutopilotLog(file.bytes(), name))) return home;
  }
  return std::nullopt;
}

/// Where and how the next flight's mission is written.
struct MissionTarget {
  MissionFormat format = MissionFormat::waypoints;
  Home home;
};

/// What the options say of it, checked before anything takes time; nothing where none is asked for.
std::optional<MissionTarget> mission_target(const DiagnoseOptions& options) {
  if (options.next_flight_file.empty()) {
    if (!options.home.empty() || options.height_m || options.reach_m) {
      throw InputError(!options.home.empty() ? "--home"
                       : options.height_m    ? "--height-m"
                                             : "--reach-m",
                       "is of the next flight; give --next-flight FILE as well");
    }
    return std::nullopt;
  }
  MissionTarget target{mission_format(options.next_flight_file), {}};
  if (options.into && options.into_file.empty()) {
    throw InputError("--next-flight",
                     "goes with the diagnosis, which --into without a file "
                     "replaces; give --into a file");
  }
  if (options.flight_logs.empty()) {
    throw InputError("--next-flight", "needs a flight to follow up: --flight LOG");
  }
  if (options.height_m) check_range("--height-m", *options.height_m, 1, 500, "m");
  if (options.reach_m) check_range("--reach-m", *options.reach_m, 1, 5000, "m");
  if (!options.home.empty()) {
    target.home = given_home(options.home);
  } else if (const auto home = home_of(options.flight_logs)) {
    target.home = *home;
  } else {
    throw InputError("--next-flight",
                     "needs the place of take-off, which no log holds: --home LAT,LON in degrees");
  }
  return target;
}

}  // namespace

double pitch_offset(const FlightOptions& options) {
  if (options.pitch_offset_deg && !options.trim_log.empty()) {
    throw InputError("--trim-log",
                     "and --pitch-offset-deg both give the pitch offset; only one can be right");
  }
  if (options.pitch_offset_deg) {
    const double degrees = *options.pitch_offset_deg;
    check_range("--pitch-offset-deg", degrees, -45, 45, "degrees");
    return degrees * unit::degree;
  }
  if (options.trim_log.empty()) return 0;
  try {
    return pitch_offset_from_hover(read_flight_log(options.trim_log, {options.core}).log);
  } catch (const UnsuitableFlight& error) {
    throw InputError(options.trim_log, error.what());
  }
}

std::vector<int> battery_numbers(const std::vector<std::string>& typed) {
  std::vector<int> numbers;
  for (const std::string& text : typed) {
    const auto number = parsed_number(text);
    constexpr double most = 255;
    if (!number || !(*number >= 0 && *number <= most) || *number != std::floor(*number)) {
      throw InputError("--battery",
                       fmt::format("\"{}\" is no number of a battery monitor; allowed are whole "
                                   "numbers from 0 to {:g}, separated by commas",
                                   text, most));
    }
    numbers.push_back(static_cast<int>(*number));
  }
  return numbers;
}

DiagnoseOptions with_halves(DiagnoseOptions options) {
  if (options.whole_log.empty()) return options;
  if (!options.flight_logs.empty() || !options.power_log.empty()) {
    throw InputError("--log", "is both, flight and power; give it, or --flight and --power");
  }
  options.flight_logs = {options.whole_log};
  options.power_log = options.whole_log;
  return options;
}

std::optional<double> flown_mass(const FlightOptions& options) {
  if (!options.mass_g) return std::nullopt;
  const SpecField& field = *find_field("drone.mass_g");
  if (!field.range.contains(*options.mass_g)) {
    throw InputError(
        "--mass-g", fmt::format("{:g} is out of range; allowed is {}{}", *options.mass_g,
                                describe_range(field), meant_in_thousands(field, *options.mass_g)));
  }
  return *options.mass_g * unit::gram;
}

std::optional<double> air_density(const FlightOptions& options) {
  const bool by_weather = options.pressure_hPa || options.temperature_C;
  if (options.air_density_kg_m3) {
    if (by_weather) {
      throw InputError("--air-density",
                       "goes without --pressure-hPa and --temperature-C: they give it too");
    }
    check_range("--air-density", *options.air_density_kg_m3, 0.1, 2, "kg/m³");
    return options.air_density_kg_m3;
  }
  if (!by_weather) return std::nullopt;
  if (!options.pressure_hPa || !options.temperature_C) {
    throw InputError("--pressure-hPa",
                     "and --temperature-C give the air density together, not alone");
  }
  check_range("--pressure-hPa", *options.pressure_hPa, 100, 1200, "hPa");
  check_range("--temperature-C", *options.temperature_C, -80, 80, "°C");
  constexpr double pascal_per_hPa = 100;
  return dry_air_density(*options.pressure_hPa * pascal_per_hPa,
                         *options.temperature_C + zero_celsius_K);
}

int run_log(const std::string& file, const std::string& message, const Output& output) {
  const LogFile content(file);
  const AutopilotLog log(content.bytes(), file);
  if (!message.empty()) {
    emit_lines(output, [&](const LineTaker& put) { messages_csv(log, message, put); });
    return done;
  }
  const LogSummary summary = summarize_log(log);
  emit(
      output, [&] { return log_text(summary, file, style_for(output)); },
      [&] { return log_json(summary, file); }, [&] { return log_csv(summary); });
  return done;
}

DragIdentificationOptions identification_options(const FlightOptions& flight) {
  DragIdentificationOptions options;
  const auto mass = flown_mass(flight);
  if (!mass) {
    throw InputError("--mass-g", "is needed: drag is force, the log knows only accelerations");
  }
  options.conditions.mass = *mass;
  if (const auto density = air_density(flight)) options.conditions.air_density = *density;
  options.from = log_position("--from", flight.from);
  options.to = log_position("--to", flight.to);
  options.pitch_offset = pitch_offset(flight);
  if (flight.published_kinematics) options.kinematics = Kinematics::published;
  return options;
}

std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names, int core) {
  std::vector<FlightLog> logs;
  for (const std::string& name : names) {
    FlightLogReading reading = read_flight_log(name, {core});
    for (const std::string& note : reading.notes) {
      remark(fmt::format("{}: {}\n", name, note));
    }
    if (!reading.log.north_wind.empty()) {
      remark(name + ": the measured wind is not used: a steady one is fitted\n");
    }
    logs.push_back(std::move(reading.log));
  }
  return logs;
}

DragStudy studied_drag(const std::string& name, const std::vector<std::string>& logs,
                       const FlightOptions& flight) {
  const DragIdentificationOptions how = identification_options(flight);
  try {
    return study_drag(name, read_flight_logs(logs, flight.core), how);
  } catch (const UnsuitableFlight& error) {
    throw InputError(logs.size() == 1 ? logs.front() : "drag", error.what());
  }
}

int run_drag(const DragOptions& options, const Output& output) {
  const std::optional<Autopilot> parameters = parameters_of(options.autopilot);
  if (parameters && (options.into || output.format != Format::table)) {
    throw InputError("--parameters", fmt::format("and {} each ask for another answer; give one",
                                                 options.into ? "--into" : "--format"));
  }
  std::optional<DesignFile> file;
  if (!options.spec.file.empty()) file = read_spec(options.spec);
  if (options.into && !file) {
    throw InputError("--into",
                     "says where the spec with the learned drag goes; the one that it is learned "
                     "for is given by --spec SPEC");
  }
  if (file && !options.into) {
    throw InputError("--spec", "is what --into writes with its drag replaced; give --into as well");
  }
  const DragIdentification result = studied_drag("", options.logs, options.flight).identified;
  tell_assumptions(options.flight, result.options);
  if (options.into && options.into_file.empty()) {
    for (const Warning& warning : drag_warnings(result.fit)) {
      remark("drag: " + warning.sentence + "\n");
    }
    emit(output, spec_text(spec_with_drag(*file, result.fit), options.spec.file, output.file));
    return done;
  }
  if (options.into) {
    write_whole_file(options.into_file, spec_text(spec_with_drag(*file, result.fit),
                                                  options.spec.file, options.into_file));
  }
  if (parameters) {
    emit(output, autopilot_parameter_file(result, *parameters));
    return done;
  }
  emit(
      output, [&] { return drag_text(result, style_for(output)); },
      [&] { return drag_json(result); }, [&] { return drag_csv(result); });
  return done;
}

ToldDiagnosis diagnose_logs(const DiagnoseOptions& options, const DesignFile& file) {
  if (options.flight_logs.empty() && options.power_log.empty()) {
    throw InputError("diagnose",
                     "needs a measured log: --flight LOG, --power LOG, or --log LOG for both");
  }
  check_power_options(options);
  DiagnosisQuestion question{file.design};
  question.hypotheses = own_effects(options);
  check_effects(options.base, question.hypotheses,
                {!options.flight_logs.empty(), !options.power_log.empty()});
  std::vector<std::string> notes;
  std::vector<std::string> power_notes;
  if (!options.flight_logs.empty())
    question.flight = read_flights(options, question.hypotheses, notes);
  if (!options.power_log.empty()) {
    PowerLogReading reading = read_power_log(
        options.power_log,
        {options.free_flight, battery_numbers(options.batteries), options.flight.core});
    question.power = {.log = std::move(reading.log),
                      .base = base_effects(options.base, LogKind::power, question.hypotheses)};
    // Beside another log's flight these are that one's.
    if (options.flight_logs.empty() || !options.whole_log.empty()) {
      question.power->mass = flown_mass(options.flight);
      question.power->air_density = air_density(options.flight);
    }
    power_notes = std::move(reading.notes);
  }
  question.one_flight = !options.whole_log.empty();
  DiagnosisStudy study = studied(options, question);
  if (study.flight) {
    study.flight->notes.insert(study.flight->notes.begin(), notes.begin(), notes.end());
  }
  if (study.power) {
    study.power->notes.insert(study.power->notes.begin(), power_notes.begin(), power_notes.end());
  }
  if (auto drag = drag_estimate_warning(file.design)) {
    (study.power ? study.power : study.flight)->notes.push_back(std::move(drag->sentence));
  }
  std::optional<NextFlight> next;
  if (!options.next_flight_file.empty()) {
    next = study_next_flight(
        {std::move(question), study.flight.value(), options.height_m, options.reach_m});
  }
  // Checked as if a person had written it.
  DesignFile extended = read_design_document(spec_with(file, study.extended), file.file, file.load);
  return {std::move(study), std::move(extended.document), std::move(next)};
}

int run_diagnose(const DiagnoseOptions& options, const Output& output) {
  const std::optional<MissionTarget> target = mission_target(options);
  const ToldDiagnosis told = diagnose_logs(options, read_spec(options.spec));
  if (options.into && options.into_file.empty()) {
    emit(output, spec_text(told.spec, options.spec.file, output.file));
    return done;
  }
  if (!options.into_file.empty()) {
    write_whole_file(options.into_file, spec_text(told.spec, options.spec.file, options.into_file));
  }
  const bool planned = told.next_flight && !told.next_flight->manoeuvres.empty();
  if (planned) {
    write_whole_file(options.next_flight_file,
                     mission_text(*told.next_flight, target->home, target->format));
  }
  tell(told, planned ? options.next_flight_file : "", output);
  std::vector<std::string> codes;
  for (const auto* diagnosis :
       {told.flight ? &*told.flight : nullptr, told.power ? &*told.power : nullptr}) {
    if (diagnosis == nullptr) continue;
    for (const Finding& finding : diagnosis->findings) codes.push_back(finding.effect);
  }
  point_to_explanations(codes, output);
  return told.next_flight && !planned && !told.next_flight->undecided.empty() ? answer_is_no : done;
}

}  // namespace tethercalc::cli
