// Any bytes as a ULog: read every way there is, every byte accounted for.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <vector>

#include "io/ulog.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/report/log_report.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tethercalc;
  const auto bytes = std::as_bytes(std::span(data, size));
  constexpr std::size_t file_header = 16;
  const LogContents contents = scan_ulog(bytes);
  std::size_t accounted = contents.skipped_bytes + std::min(size, file_header);
  std::size_t messages = 0;
  for_each_raw_ulog_message(bytes, [&](char, const std::byte*, std::size_t length) {
    accounted += length;
    ++messages;
  });
  if (accounted != size || messages != contents.messages) std::abort();
  try {
    const AutopilotLog log(bytes, "log");
    const LogSummary summary = summarize_log(log);
    (void)log_text(summary, "log");
    (void)log_csv(summary);
    (void)log_json(summary, "log").dump();
    for (const LogSummary::Message& type : summary.types) {
      std::ostringstream csv;
      write_messages_csv(log, type.name, csv);
    }
    for (const int core : {0, 1}) {
      const FlightLog flight = parse_flight_log(log, {.core = core}).log;
      for (std::size_t i = 1; i < flight.time.size(); ++i) {
        if (!(flight.time[i] > flight.time[i - 1])) std::abort();
      }
    }
  } catch (const InputError& error) {
    if (error.problems().empty()) std::abort();
  }
  for (const std::vector<int>& batteries : {std::vector<int>{}, {0}, {0, 1}}) {
    try {
      const PowerLogOptions options{.free_flight = true, .batteries = batteries};
      const PowerLog power = parse_power_log(bytes, "log", options).log;
      for (std::size_t i = 0; i < power.time.size(); ++i) {
        if (i > 0 && !(power.time[i] > power.time[i - 1])) std::abort();
        if (!std::isfinite(power.bus_voltage[i] * power.bus_current[i] + power.airspeed[i])) {
          std::abort();
        }
      }
    } catch (const InputError& error) {
      if (error.problems().empty()) std::abort();
    }
  }
  return 0;
}
