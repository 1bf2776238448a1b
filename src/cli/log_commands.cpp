#include "cli/commands.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/mapped_file.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/flight_log_reader.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/log_report.hpp"

namespace tethercalc::cli {
namespace {

/// The spec with its drag replaced, checked as if a person had edited it.
std::string spec_with_drag(const std::string& spec, const DragFit& fit) {
  const DesignFile file = read_design(spec);
  Design design = file.design;
  const double asymmetry = design.drone.drag.fore_aft_asymmetry;
  design.drone.drag = fit.drag();
  design.drone.drag.fore_aft_asymmetry = asymmetry;
  return json_text(read_design_document(spec_with(file, design), file.file, file.load).document);
}

/// What was not said and moves the answer, on standard error so that no format hides it.
void tell_assumptions(const FlightOptions& flight, const DragIdentificationOptions& taken) {
  if (!flight.air_density_kg_m3 && !flight.pressure_hPa) {
    fmt::print(stderr,
               "drag: no air density given, {} kg/m³ taken (--air-density, or --pressure-hPa with "
               "--temperature-C)\n",
               taken.conditions.air_density);
  }
  if (!flight.pitch_offset_deg && flight.trim_log.empty()) {
    fmt::print(stderr,
               "drag: no pitch offset given, 0° taken; what it misses ends up in the wind "
               "(--trim-log or --pitch-offset-deg)\n");
  }
}

}  // namespace

int run_log(const std::string& file, const std::string& message, const Output& output) {
  const MappedFile log(file);
  if (log.bytes().empty()) throw InputError(file, "the file is empty");
  if (!looks_like_dataflash(log.bytes())) {
    throw InputError(file, "is no DataFlash log (.bin): it begins like a text");
  }
  if (!message.empty()) {
    std::ostringstream csv;
    write_messages_csv(log.bytes(), message, file, csv);
    emit(output, csv.str());
    return done;
  }
  const LogSummary summary = summarize_log(log.bytes());
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
  return options;
}

std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names, int core) {
  std::vector<FlightLog> logs;
  for (const std::string& name : names) {
    FlightLogReading reading = read_flight_log(name, {core});
    for (const std::string& note : reading.notes) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), note.c_str());
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

int run_drag(const std::vector<std::string>& logs, const FlightOptions& flight,
             const std::string& into, const Output& output) {
  const DragIdentification result = studied_drag("", logs, flight).identified;
  tell_assumptions(flight, result.options);
  if (!into.empty()) {
    for (const std::string& warning : drag_warnings(result.fit)) {
      fmt::print(stderr, "drag: {}\n", warning);
    }
    emit(output, spec_with_drag(into, result.fit));
    return done;
  }
  emit(
      output, [&] { return drag_text(result, style_for(output)); },
      [&] { return drag_json(result); }, [&] { return drag_csv(result); });
  return done;
}

}  // namespace tethercalc::cli
