#include "tethercalc/identify/drag_identification.hpp"

#include <fmt/format.h>

#include <cmath>

#include "identify/flight_units.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

Observations observe_part(const FlightLog& log, const DragIdentificationOptions& options) {
  validate(log);
  const bool chosen = options.from || options.to;
  const SampleRange range = chosen ? select_range(log, options.from, options.to) : moving_part(log);
  const double gravity = options.conditions.gravity;
  Observations flight = observe(log, range, options.pitch_offset, gravity, options.kinematics);
  check_flight_units(flight, gravity);
  const auto off = shows_both_axes(flight, gravity) ? std::nullopt : heading_error(flight, gravity);
  if (off) {
    throw UnsuitableFlight(
        fmt::format("the drone speeds up {:.0f}° to the {} of where its nose leans: its heading is "
                    "off, and with it the speed ahead that drag goes with; diagnose tells by how "
                    "much (yaw_misalign)",
                    std::abs(*off) / unit::degree, *off < 0 ? "right" : "left"));
  }
  return flight;
}

std::optional<Warning> unused_flights_warning(const FlightLog& log,
                                              const DragIdentificationOptions& options) {
  if (options.from || options.to) return std::nullopt;
  const auto times = [&log](const SampleRange& part) {
    return fmt::format("{:.1f} s to {:.1f} s", log.time[part.first], log.time[part.last - 1]);
  };
  const SampleRange used = moving_part(log);
  std::string others;
  for (const SampleRange& part : moving_parts(log)) {
    if (part == used) continue;
    others += fmt::format("{}{}", others.empty() ? "" : ", ", times(part));
  }
  if (others.empty()) return std::nullopt;
  return Warning{
      WarningKind::log_flights_unused,
      fmt::format("of its flights the longest is used, {}; not used: {}", times(used), others)};
}

DragIdentification identify_drag(std::span<const FlightLog> logs,
                                 const DragIdentificationOptions& options) {
  DragIdentification out;
  out.options = options;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    try {
      out.flights.push_back(observe_part(logs[i], options));
    } catch (const UnsuitableFlight& error) {
      if (logs.size() == 1) throw;
      throw UnsuitableFlight(fmt::format("log {}: {}", i + 1, error.what()));
    }
    if (out.flights.back().size() == 0) {
      throw UnsuitableFlight(fmt::format("log {} is all gaps", i + 1));
    }
  }
  out.fit = fit_drag(out.flights, options.conditions);
  return out;
}

}  // namespace tethercalc
