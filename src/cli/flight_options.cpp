#include "cli/flight_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "tethercalc/files/read_files.hpp"
#include "tethercalc/identify/drag_fit.hpp"
#include "tethercalc/io/flight_log_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc::cli {
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
    if (!(std::abs(degrees) <= 45)) {
      throw InputError("--pitch-offset-deg",
                       fmt::format("{:g} is out of range; allowed is -45 to 45 degrees", degrees));
    }
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
  if (!(*options.mass_g >= 1 && *options.mass_g <= 1e6)) {
    throw InputError("--mass-g", fmt::format("{:g} is out of range; allowed is 1 to 1000000 g",
                                             *options.mass_g));
  }
  return *options.mass_g * unit::gram;
}

std::optional<double> air_density(const FlightOptions& options) {
  const auto in_range = [](const char* option, double value, double least, double most,
                           const char* unit_name) {
    if (value >= least && value <= most) return;
    throw InputError(option, fmt::format("{:g} is out of range; allowed is {:g} to {:g} {}", value,
                                         least, most, unit_name));
  };
  const bool by_weather = options.pressure_hPa || options.temperature_C;
  if (options.air_density_kg_m3) {
    if (by_weather) {
      throw InputError("--air-density",
                       "goes without --pressure-hPa and --temperature-C: they give it too");
    }
    in_range("--air-density", *options.air_density_kg_m3, 0.1, 2, "kg/m³");
    return options.air_density_kg_m3;
  }
  if (!by_weather) return std::nullopt;
  if (!options.pressure_hPa || !options.temperature_C) {
    throw InputError("--pressure-hPa",
                     "and --temperature-C give the air density together, not alone");
  }
  in_range("--pressure-hPa", *options.pressure_hPa, 100, 1200, "hPa");
  in_range("--temperature-C", *options.temperature_C, -80, 80, "°C");
  constexpr double pascal_per_hPa = 100;
  return dry_air_density(*options.pressure_hPa * pascal_per_hPa,
                         *options.temperature_C + zero_celsius_K);
}

}  // namespace tethercalc::cli
