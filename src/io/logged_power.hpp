// The power of an autopilot's flight: what its battery monitors and its estimator tell together.
#pragma once

#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"

namespace tethercalc {

/// As `parse_power_log`, from what was read of the log already: its flight, by the wanted core, and
/// when it was in the air.
[[nodiscard]] PowerLogReading logged_power(const AutopilotLog& log, const FlightLogReading& flight,
                                           const std::optional<LogSummary::Flying>& flying,
                                           const PowerLogOptions& options);

}  // namespace tethercalc
