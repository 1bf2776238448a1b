#include "cli/diagnose_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/whole_file.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/design_impact.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/flight_log_reader.hpp"
#include "tethercalc/io/power_log_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

namespace tethercalc::cli {
namespace {

using nlohmann::ordered_json;

/// One line that is written over, on a terminal only.
SelectionProgress progress_line() {
  if (::isatty(STDERR_FILENO) != 1) return {};
  return [](const std::string& doing) { std::fprintf(stderr, "\r\x1b[K%s", doing.c_str()); };
}

void clear_progress() {
  if (::isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\x1b[K");
}

/// The effects of --base that a log of `kind` can show. Every name must be one of a given log.
std::vector<std::string> base_effects(const DiagnoseOptions& options, LogKind kind) {
  std::vector<std::string> chosen;
  for (const std::string& id : options.base) {
    const Effect* effect = find_effect(id);
    if (effect != nullptr && effect->log == kind) chosen.push_back(id);
  }
  return chosen;
}

void check_base(const DiagnoseOptions& options) {
  std::vector<std::string> known;
  for (const Effect& effect : effect_catalogue()) {
    const bool given =
        effect.log == LogKind::flight ? !options.flight_log.empty() : !options.power_log.empty();
    if (given) known.push_back(effect.id);
  }
  for (const std::string& id : options.base) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    const Effect* effect = find_effect(id);
    if (effect != nullptr) {
      const bool flight = effect->log == LogKind::flight;
      throw InputError("--base",
                       fmt::format("\"{}\" is an effect of {} logs; give one with {}", id,
                                   flight ? "flight" : "power", flight ? "--flight" : "--power"));
    }
    throw InputError("--base", fmt::format("\"{}\" is not an effect; allowed are {}{}", id,
                                           fmt::join(known, ", "), did_you_mean(id, known)));
  }
}

/// What the flight has shown, in the design.
Design with_changes(const DesignFile& file, const std::vector<SpecChange>& changes) {
  Design design = file.design;
  try {
    for (const SpecChange& change : changes) {
      set_field(design, *find_field(change.field), change.value);
    }
  } catch (const std::invalid_argument& error) {
    throw InputError(file.file, error.what());
  }
  return design;
}

Diagnosis flight_diagnosis(const DiagnoseOptions& options, const DesignFile& file) {
  Design flown = file.design;
  if (options.flight.mass_g) {
    if (!(*options.flight.mass_g >= 1 && *options.flight.mass_g <= 1e6)) {
      throw InputError("--mass-g", fmt::format("{} is out of range; allowed is 1 to 1000000 g",
                                               *options.flight.mass_g));
    }
    flown.drone.mass = *options.flight.mass_g * unit::gram;
  }
  if (const auto density = air_density(options.flight)) flown.flight.air_density = *density;
  FlightDiagnosisOptions how;
  how.base = base_effects(options, LogKind::flight);
  how.pitch_offset = pitch_offset(options.flight);
  const auto from = log_position("--from", options.flight.from);
  const auto to = log_position("--to", options.flight.to);
  const FlightLogReading reading = read_flight_log(
      options.flight_log, {.core = options.flight.core, .level_where_missing = true});
  try {
    if (from || to) how.range = select_range(reading.log, from, to);
    Diagnosis d = diagnose_flight(flown, reading.log, how, progress_line());
    clear_progress();
    d.notes.insert(d.notes.begin(), reading.notes.begin(), reading.notes.end());
    return d;
  } catch (const std::invalid_argument& error) {
    clear_progress();
    throw InputError(options.flight_log, error.what());
  }
}

PowerDiagnosis power_diagnosis(const DiagnoseOptions& options, const DesignFile& file) {
  const PowerLog log = read_power_log(options.power_log);
  try {
    PowerDiagnosis found =
        diagnose_power(file.design, log, base_effects(options, LogKind::power), progress_line());
    clear_progress();
    return found;
  } catch (const std::invalid_argument& error) {
    clear_progress();
    throw InputError(options.power_log, error.what());
  }
}

std::string answer(const ToldDiagnosis& told, const Output& output) {
  const Diagnosis& only = told.power ? *told.power : *told.flight;
  const bool both = told.flight && told.power;
  switch (output.format) {
    case Format::json:
      return json_text(both ? joint_diagnosis_json(*told.flight, *told.power, told.extended)
                            : diagnosis_json(only, told.extended));
    case Format::csv: {
      std::vector<Finding> findings = only.findings;
      if (both) {
        findings.insert(findings.begin(), told.flight->findings.begin(),
                        told.flight->findings.end());
      }
      return diagnosis_csv(findings);
    }
    default:
      return both ? joint_diagnosis_text(*told.flight, *told.power, style_for(output))
                  : diagnosis_text(only, style_for(output));
  }
}

/// Refuses to write the extended spec over what it is made from.
void check_into(const DiagnoseOptions& options) {
  if (options.into_file.empty()) return;
  for (const std::string& read : {options.spec.file, options.flight_log, options.power_log}) {
    std::error_code ignored;
    if (std::filesystem::equivalent(options.into_file, read, ignored)) {
      throw InputError(
          "--into", fmt::format("\"{}\" is read; give another file to write", options.into_file));
    }
  }
}

}  // namespace

ToldDiagnosis diagnose_logs(const DiagnoseOptions& options, const DesignFile& file) {
  ToldDiagnosis told;
  DesignFile extended = file;  // its document takes one log's changes after the other
  if (options.flight_log.empty() && options.power_log.empty()) {
    throw InputError("diagnose", "needs a measured log: --flight LOG, --power LOG or both");
  }
  check_base(options);
  if (!options.flight_log.empty()) {
    told.flight = flight_diagnosis(options, file);
    extended.document = spec_with(extended, with_changes(file, told.flight->spec_changes));
  }
  if (!options.power_log.empty()) {
    PowerDiagnosis found = power_diagnosis(options, file);
    const bool drag_known = told.flight && !told.flight->spec_changes.empty();
    if (drag_known) found.extended.drone.drag = file.design.drone.drag;
    extended.document = spec_with(extended, found.extended);
    told.power = std::move(found.diagnosis);
  }
  if (told.flight && told.power) {
    // What a flight can never show the power log may.
    std::erase_if(told.flight->not_identifiable, [](const NotIdentifiable& n) {
      return find_effect(n.effect)->log == LogKind::power;
    });
  }
  const DesignFile after = read_design_document(extended.document, file.file, file.load);
  (told.power ? told.power : told.flight)->design_impact = design_impact(file.design, after.design);
  told.extended = std::move(extended.document);
  return told;
}

int run_diagnose(const DiagnoseOptions& options, const Output& output) {
  check_into(options);
  const ToldDiagnosis told =
      diagnose_logs(options, read_design(options.spec.file, options.spec.overrides));
  if (options.into && options.into_file.empty()) {
    emit(output, json_text(told.extended));
    return done;
  }
  if (!options.into_file.empty()) write_whole_file(options.into_file, json_text(told.extended));
  emit(output, answer(told, output));
  return done;
}

}  // namespace tethercalc::cli
