#include "tethercalc/identify/drag_identification.hpp"

#include <fmt/format.h>

namespace tethercalc {

Observations observe_part(const FlightLog& log, const DragIdentificationOptions& options) {
  validate(log);
  const bool chosen = options.from || options.to;
  const SampleRange range = chosen ? select_range(log, options.from, options.to) : moving_part(log);
  return observe(log, range, options.pitch_offset, options.conditions.gravity);
}

DragIdentification identify_drag(std::span<const FlightLog> logs,
                                 const DragIdentificationOptions& options) {
  DragIdentification out;
  out.options = options;
  std::vector<Observations> flights;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    try {
      flights.push_back(observe_part(logs[i], options));
    } catch (const UnsuitableFlight& error) {
      if (logs.size() == 1) throw;
      throw UnsuitableFlight(fmt::format("log {}: {}", i + 1, error.what()));
    }
    const Observations& flight = flights.back();
    if (flight.size() == 0) throw UnsuitableFlight(fmt::format("log {} is all gaps", i + 1));
    out.parts.push_back({flight.time.front(), flight.time.back(), flight.size()});
  }
  out.fit = fit_drag(flights, options.conditions);
  return out;
}

}  // namespace tethercalc
