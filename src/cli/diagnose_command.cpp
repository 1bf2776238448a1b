#include "cli/diagnose_command.hpp"

#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/design_impact.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/io/flight_log_reader.hpp"
#include "tethercalc/io/power_log_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

namespace tethercalc::cli {
namespace {

using nlohmann::ordered_json;

/// A diagnosis with the spec that it leads to.
struct Told {
  Diagnosis diagnosis;
  ordered_json extended;
};

/// One line that is written over, on a terminal only.
SelectionProgress progress_line() {
  if (::isatty(STDERR_FILENO) != 1) return {};
  return [](const std::string& doing) { std::fprintf(stderr, "\r\x1b[K%s", doing.c_str()); };
}

void clear_progress() {
  if (::isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\x1b[K");
}

/// The spec of a design that differs from the one read in numbers, converter curve or resistivity.
ordered_json spec_of(const DesignFile& file, const Design& extended) {
  ordered_json document = file.document;
  for (const SpecField& field : spec_fields()) {
    const auto before = field_value(file.design, field);
    const auto after = field_value(extended, field);
    if (after && before != after) {
      document[ordered_json::json_pointer(std::string(field.pointer))] = *after;
    }
  }
  const auto& curve = extended.supply.converter.efficiency;
  if (curve.size() > 1) {
    ordered_json points = ordered_json::array();
    for (const EfficiencyPoint& point : curve) {
      points.push_back({{"output_W", point.output_power}, {"efficiency", point.efficiency}});
    }
    document["supply"]["converter"]["efficiency"] = points;
  }
  const Conductor& conductor = extended.tether.conductor;
  if (conductor.resistivity_20C != file.design.tether.conductor.resistivity_20C) {
    document["tether"]["conductor"] = {
        {"id", file.conductor.id + "-as-measured"},
        {"name", file.conductor.name + ", resistivity as measured"},
        {"source", "diagnosis of a power log"},
        {"resistivity_20C_ohm_mm2_per_m",
         conductor.resistivity_20C / unit::ohm_square_millimetre_per_metre},
        {"temperature_coefficient_per_K", conductor.temperature_coefficient},
        {"density_g_cm3", conductor.density / unit::gram_per_cubic_centimetre}};
  }
  return document;
}

void add_impact(Told& told, const DesignFile& file) {
  if (told.extended == file.document) return;
  const DesignFile after = read_design_document(told.extended, file.file, file.folder);
  told.diagnosis.design_impact = design_impact(file.design, after.design);
}

Told diagnose_flight_log(const DiagnoseOptions& options, const DesignFile& file) {
  Design flown = file.design;
  if (options.flight.mass_g) flown.drone.mass = *options.flight.mass_g * unit::gram;
  if (const auto density = air_density(options.flight)) flown.flight.air_density = *density;
  FlightDiagnosisOptions how;
  how.base = options.base;
  how.pitch_offset = pitch_offset(options.flight);
  const FlightLogReading reading = read_flight_log(options.flight_log, {options.flight.core});
  try {
    const auto from = log_position("--from", options.flight.from);
    const auto to = log_position("--to", options.flight.to);
    if (from || to) how.range = select_range(reading.log, from, to);
    Told told{diagnose_flight(flown, reading.log, how, progress_line()), {}};
    clear_progress();
    told.diagnosis.notes.insert(told.diagnosis.notes.begin(), reading.notes.begin(),
                                reading.notes.end());
    told.extended = extended_spec(file.document, told.diagnosis);
    return told;
  } catch (const std::invalid_argument& error) {
    clear_progress();
    throw InputError(options.flight_log, error.what());
  }
}

Told diagnose_power_log(const DiagnoseOptions& options, const DesignFile& file) {
  const PowerLog log = read_power_log(options.power_log);
  try {
    PowerDiagnosis found = diagnose_power(file.design, log, options.base, progress_line());
    clear_progress();
    return {std::move(found.diagnosis), spec_of(file, found.extended)};
  } catch (const std::invalid_argument& error) {
    clear_progress();
    throw InputError(options.power_log, error.what());
  }
}

Told tell(const DiagnoseOptions& options, const DesignFile& file) {
  if (options.flight_log.empty() == options.power_log.empty()) {
    throw InputError("diagnose", "needs one measured log: --flight LOG or --power LOG");
  }
  return options.power_log.empty() ? diagnose_flight_log(options, file)
                                   : diagnose_power_log(options, file);
}

std::string answer_text(const Told& told, const Output& output) {
  switch (output.format) {
    case Format::json:
      return json_text(diagnosis_json(told.diagnosis, told.extended));
    case Format::csv:
      return diagnosis_csv(told.diagnosis);
    default:
      return diagnosis_text(told.diagnosis, style_for(output));
  }
}

}  // namespace

Diagnosis diagnose(const DiagnoseOptions& options) {
  return tell(options, read_design(options.spec.file, options.spec.overrides)).diagnosis;
}

Diagnosis diagnose_with_impact(const DiagnoseOptions& options, const DesignFile& file) {
  Told told = tell(options, file);
  add_impact(told, file);
  return std::move(told.diagnosis);
}

int run_diagnose(const DiagnoseOptions& options, const Output& output) {
  const DesignFile file = read_design(options.spec.file, options.spec.overrides);
  Told told = tell(options, file);
  add_impact(told, file);
  emit(output, options.into ? json_text(told.extended) : answer_text(told, output));
  return done;
}

}  // namespace tethercalc::cli
