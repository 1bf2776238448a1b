// Which part of which flight log is looked at, and what is known about the flight: shared by the
// commands that learn from flights.
#pragma once

#include <optional>
#include <string>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc::cli {

/// As given on the command line; what is empty was not given.
struct FlightOptions {
  int core = 0;
  std::string from;  ///< "25%" of the samples, or seconds of the log's clock
  std::string to;
  std::string trim_log;  ///< a hover flight whose mean pitch is the offset
  std::optional<double> pitch_offset_deg;
  std::optional<double> mass_g;
  std::optional<double> air_density_kg_m3;
  std::optional<double> pressure_hPa;
  std::optional<double> temperature_C;
};

/// Where the part of the log begins or ends that `text`, as given to `option`, names: percent of
/// the samples with a "%", else seconds; nothing for an empty text. Throws InputError for anything
/// else.
[[nodiscard]] std::optional<LogPosition> log_position(const std::string& option,
                                                      const std::string& text);

/// rad: given, from the trim log, or 0.
[[nodiscard]] double pitch_offset(const FlightOptions& options);

/// The mass in kg that was given, if any. Throws InputError where it is out of range.
[[nodiscard]] std::optional<double> flown_mass(const FlightOptions& options);

/// kg/m³: given, or from pressure and temperature; nothing where neither was. Throws InputError for
/// impossible values, half a pair, or both.
[[nodiscard]] std::optional<double> air_density(const FlightOptions& options);

}  // namespace tethercalc::cli
