#include "cli/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "files/output_files.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

namespace tethercalc::cli {
namespace {

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

LoggedFlight read_flight(const DiagnoseOptions& options, std::vector<std::string>& notes) {
  LoggedFlight flight;
  flight.mass = flown_mass(options.flight);
  flight.air_density = air_density(options.flight);
  flight.options.base = base_effects(options, LogKind::flight);
  flight.options.pitch_offset = pitch_offset(options.flight);
  const auto from = log_position("--from", options.flight.from);
  const auto to = log_position("--to", options.flight.to);
  FlightLogReading reading = read_flight_log(
      options.flight_log, {.core = options.flight.core, .level_where_missing = true});
  notes = std::move(reading.notes);
  flight.log = std::move(reading.log);
  try {
    if (from || to) flight.options.range = select_range(flight.log, from, to);
  } catch (const std::invalid_argument& error) {
    throw InputError(options.flight_log, error.what());
  }
  return flight;
}

DiagnosisStudy studied(const DiagnoseOptions& options, const DiagnosisQuestion& question) {
  try {
    DiagnosisStudy study = study_diagnosis(question, progress_line());
    clear_progress();
    return study;
  } catch (const UnsuitableLog& error) {
    clear_progress();
    throw InputError(error.kind() == LogKind::flight ? options.flight_log : options.power_log,
                     error.what());
  }
}

void tell(const ToldDiagnosis& told, const Output& output) {
  const Diagnosis& only = told.power ? *told.power : *told.flight;
  const bool both = told.flight && told.power;
  emit(
      output,
      [&] {
        return both ? joint_diagnosis_text(*told.flight, *told.power, style_for(output))
                    : diagnosis_text(only, style_for(output));
      },
      [&] {
        return both ? joint_diagnosis_json(*told.flight, *told.power, told.spec)
                    : diagnosis_json(only, told.spec);
      },
      [&] {
        std::vector<Finding> findings = told.flight ? told.flight->findings : only.findings;
        if (both) {
          findings.insert(findings.end(), told.power->findings.begin(), told.power->findings.end());
        }
        return diagnosis_csv(findings);
      });
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
  if (options.flight_log.empty() && options.power_log.empty()) {
    throw InputError("diagnose", "needs a measured log: --flight LOG, --power LOG or both");
  }
  check_base(options);
  DiagnosisQuestion question{file.design};
  std::vector<std::string> notes;
  if (!options.flight_log.empty()) question.flight = read_flight(options, notes);
  if (!options.power_log.empty()) {
    question.power = {read_power_log(options.power_log), base_effects(options, LogKind::power)};
  }
  DiagnosisStudy study = studied(options, question);
  if (study.flight) {
    study.flight->notes.insert(study.flight->notes.begin(), notes.begin(), notes.end());
  }
  // Checked as if a person had written it.
  DesignFile extended = read_design_document(spec_with(file, study.extended), file.file, file.load);
  return {std::move(study), std::move(extended.document)};
}

int run_diagnose(const DiagnoseOptions& options, const Output& output) {
  check_into(options);
  const ToldDiagnosis told = diagnose_logs(options, read_spec(options.spec));
  if (options.into && options.into_file.empty()) {
    emit(output, json_text(told.spec));
    return done;
  }
  if (!options.into_file.empty()) write_whole_file(options.into_file, json_text(told.spec));
  tell(told, output);
  return done;
}

}  // namespace tethercalc::cli
