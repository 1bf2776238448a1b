// The commands that read logs of real flights.
#pragma once

#include <string>
#include <vector>

#include "cli/flight_options.hpp"
#include "cli/output.hpp"
#include "tethercalc/study/drag.hpp"

namespace tethercalc::cli {

/// What a DataFlash log holds, or all messages of one name as CSV.
int run_log(const std::string& file, const std::string& message, const Output& output);

/// What the options say about the flight, checked; the mass must be given.
[[nodiscard]] DragIdentificationOptions identification_options(const FlightOptions& flight);

/// The logs of these names; what was amiss with them is told on standard error.
[[nodiscard]] std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names,
                                                      int core);

/// The drag of these logs, `name` their heading. Throws InputError where they show none.
[[nodiscard]] DragStudy studied_drag(const std::string& name, const std::vector<std::string>& logs,
                                     const FlightOptions& flight);

struct DragOptions {
  std::vector<std::string> logs;
  FlightOptions flight;
  std::string into;  ///< a spec whose drag block is replaced; empty: report the fit instead
};
int run_drag(const DragOptions& options, const Output& output);

}  // namespace tethercalc::cli
