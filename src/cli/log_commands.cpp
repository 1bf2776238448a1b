#include "cli/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "files/log_file.hpp"
#include "files/logs_in_files.hpp"
#include "files/output_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/files/effect_file.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/io/mission.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/design_report.hpp"
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

/// One line that is written over, on a terminal only.
SelectionProgress progress_line() {
  if (!shows_progress()) return {};
  return [](const std::string& doing) { std::fprintf(stderr, "\r\x1b[K%s", doing.c_str()); };
}

void clear_progress() {
  if (shows_progress()) std::fprintf(stderr, "\r\x1b[K");
}

ToldDiagnosis studied(const AskedDiagnosis& asked, const DiagnoseOptions& options,
                      const DesignFile& file) {
  try {
    ToldDiagnosis told = told_diagnosis(studied_diagnosis(asked, options, progress_line()), file);
    clear_progress();
    return told;
  } catch (const InputError&) {
    clear_progress();
    throw;
  }
}

/// `mission` is where the next flight was written, if anywhere.
void tell(const AnsweredDiagnosis& told, const std::string& mission, const Output& output) {
  emit(
      output,
      [&] {
        std::string text = told_text(told, style_for(output));
        if (told.next_flight) {
          text += next_flight_text(*told.next_flight, mission, style_for(output));
        }
        return text;
      },
      [&] {
        nlohmann::ordered_json json = told_json(told);
        if (told.next_flight) json["next_flight"] = next_flight_json(*told.next_flight, mission);
        return json;
      },
      [&] { return told_csv(told); });
}

/// "LAT,LON" in degrees.
Home given_home(const std::string& text) {
  const std::string_view typed = text;
  const std::size_t comma = typed.find(',');
  const auto latitude = parsed_number(typed.substr(0, comma));
  const auto longitude =
      comma == typed.npos ? std::nullopt : parsed_number(typed.substr(comma + 1));
  if (!latitude || !longitude || std::abs(*latitude) > 85 || std::abs(*longitude) > 180) {
    throw InputError("--home",
                     fmt::format("\"{}\" is no place; allowed are a latitude from -85 to 85 and a "
                                 "longitude from -180 to 180, in degrees: 47.3977,8.5456",
                                 text));
  }
  return {*latitude, *longitude, 0};
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

/// Whether --into has no name, so that the spec takes the answer's place.
template <typename Options>
bool prints_spec(const Options& options) {
  return options.into && options.into_file.empty();
}

template <typename Options>
void check_prints_spec(const Options& options, const Output& output) {
  if (!prints_spec(options) || output.format != Format::csv) return;
  throw InputError("--format", "csv is not what --into prints, a spec in JSON; give --into a file");
}

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
  if (prints_spec(options)) {
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

void note_on_error(const Warning& note) { remark(note.sentence + "\n"); }

LearnedDrag learn_drag(std::string_view command, const std::vector<std::string>& logs,
                       const FlightOptions& flight) {
  LearnedDrag learned = learned_drag(logs, flight, logs_in_files(), note_on_error);
  remark_warnings(command, learned.assumed);
  return learned;
}

DiagnoseOptions with_both_halves(DiagnoseOptions options) {
  static_cast<LogsAsked&>(options) = with_halves(options);
  return options;
}

int run_log(const std::string& file, const std::string& message, const Output& output) {
  if (!message.empty() && output.format == Format::json) {
    throw InputError("--format", "json is not what --csv exports; give one of them");
  }
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
  check_prints_spec(options, output);
  if (file && !options.into) {
    throw InputError("--spec", "is what --into writes with its drag replaced; give --into as well");
  }
  const LearnedDrag learned = learn_drag(
      "drag", options.logs, file ? flown_as(options.flight, file->design) : options.flight);
  const DragIdentification& result = learned.study.identified;
  if (prints_spec(options)) {
    remark_warnings("drag", drag_warnings(result.fit));
    emit(output, spec_text(spec_with_drag(*file, result.fit), options.spec.file, output.file));
    return done;
  }
  if (options.into) {
    write_asked("--into", options.into_file,
                spec_text(spec_with_drag(*file, result.fit), options.spec.file, options.into_file));
  }
  if (parameters) {
    emit(output, autopilot_parameter_file(result, *parameters));
    return done;
  }
  emit(
      output, [&] { return drag_text(result, style_for(output)); },
      [&] { return drag_json(result, learned.notes); }, [&] { return drag_csv(result); });
  point_to_explanations({}, learned.notes, output);
  return done;
}

AnsweredDiagnosis diagnose_logs(const DiagnoseOptions& options, const DesignFile& file) {
  AskedDiagnosis asked = diagnosis_question(
      options, file.design, read_effect_files(options.effect_files), logs_in_files());
  AnsweredDiagnosis told{studied(asked, options, file)};
  if (!options.next_flight_file.empty()) {
    told.next_flight = study_next_flight(
        {std::move(asked.question), told.flight.value(), options.height_m, options.reach_m});
  }
  return told;
}

int run_diagnose(const DiagnoseOptions& options, const Output& output) {
  const std::optional<MissionTarget> target = mission_target(options);
  check_prints_spec(options, output);
  const AnsweredDiagnosis told = diagnose_logs(options, read_spec(options.spec));
  if (prints_spec(options)) {
    emit(output, spec_text(told.spec, options.spec.file, output.file));
    return done;
  }
  if (!options.into_file.empty()) {
    write_asked("--into", options.into_file,
                spec_text(told.spec, options.spec.file, options.into_file));
  }
  const bool planned = told.next_flight && !told.next_flight->manoeuvres.empty();
  if (planned) {
    write_asked("--next-flight", options.next_flight_file,
                mission_text(*told.next_flight, target->home, target->format));
  }
  tell(told, planned ? options.next_flight_file : "", output);
  std::vector<std::string> codes;
  std::vector<Warning> notes;
  for (const auto* diagnosis :
       {told.flight ? &*told.flight : nullptr, told.power ? &*told.power : nullptr}) {
    if (diagnosis == nullptr) continue;
    for (const Finding& finding : diagnosis->findings) codes.push_back(finding.effect);
    notes.insert(notes.end(), diagnosis->notes.begin(), diagnosis->notes.end());
  }
  point_to_explanations(codes, notes, output);
  return told.next_flight && !planned && !told.next_flight->undecided.empty() ? answer_is_no : done;
}

}  // namespace tethercalc::cli
