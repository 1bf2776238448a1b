// Any bytes as a DataFlash log: read every way there is, every byte accounted for.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/report/log_report.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tethercalc;
  const auto log = std::as_bytes(std::span(data, size));
  const DataFlashContents contents = scan_dataflash(log);
  std::size_t bytes = contents.skipped_bytes;
  std::size_t messages = 0;
  for_each_message(log, [&](const DataFlashFormat& format, const std::byte* message) {
    bytes += format.length;
    ++messages;
    for (const LogField& field : format.fields) (void)field_text(message, field);
  });
  if (bytes != size || messages != contents.messages) std::abort();

  try {
    const AutopilotLog opened(log, "log");
    const LogSummary summary = summarize_log(opened);
    (void)log_text(summary, "log");
    (void)log_csv(summary);
    (void)log_json(summary, "log");
    for (const auto& type : opened.contents().types) {
      if (type.count == 0) continue;
      std::ostringstream csv;
      write_messages_csv(opened, type.type.name, csv);
    }
  } catch (const InputError& error) {
    if (error.problems().empty()) std::abort();
  }
  for (const std::vector<int>& batteries : {std::vector<int>{}, {0}, {0, 1}}) {
    try {
      const PowerLog power = parse_power_log(log, "log", {.batteries = batteries}).log;
      for (std::size_t i = 0; i < power.time.size(); ++i) {
        if (i > 0 && !(power.time[i] > power.time[i - 1])) std::abort();
        if (!std::isfinite(power.bus_voltage[i] * power.bus_current[i] + power.airspeed[i] +
                           power.height[i])) {
          std::abort();
        }
      }
    } catch (const InputError& error) {
      if (error.problems().empty()) std::abort();
    }
  }
  for (const int core : {0, 1}) {
    try {
      const FlightLog flight = parse_flight_log(log, "log", {.core = core}).log;
      for (std::size_t i = 1; i < flight.time.size(); ++i) {
        if (!(flight.time[i] > flight.time[i - 1])) std::abort();
      }
    } catch (const InputError& error) {
      if (error.problems().empty()) std::abort();
    }
  }
  return 0;
}
