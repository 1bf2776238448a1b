#include "cli/commands.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "files/input_files.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
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

void check_range(const char* option, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw InputError(option, fmt::format("{:g} is out of range; allowed is {} to {} {}", value, least,
                                       most, unit));
}

}  // namespace

std::optional<LogPosition> log_position(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string suffix = end;
  if (end == text.c_str() || !std::isfinite(value) ||
      !(suffix.empty() || suffix == "s" || suffix == "%")) {
    throw InputError(option,
                     "\"" + text +
                         "\" is not a place in a log; allowed are seconds (120 or 120s) and "
                         "percent of the samples (25%)");
  }
  return LogPosition{value, suffix == "%"};
}

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

std::optional<double> flown_mass(const FlightOptions& options) {
  if (!options.mass_g) return std::nullopt;
  check_range("--mass-g", *options.mass_g, 1, 1000000, "g");
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
  require_messages(summary, file);
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
      fmt::print(stderr, "{}: {}\n", name, note);
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
