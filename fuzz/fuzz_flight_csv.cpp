// Any bytes as a flight log and as a power log, in CSV or whatever they are: accepted with whole
// columns, or refused.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"

namespace {

void require_finite(const std::vector<double>& column, std::size_t rows, bool optional) {
  if (optional && column.empty()) return;
  if (column.size() != rows) std::abort();
  for (const double value : column) {
    if (!std::isfinite(value)) std::abort();
  }
}

template <class Read>
void read_or_be_refused(Read read) {
  try {
    read();
  } catch (const tethercalc::InputError& error) {
    if (error.problems().empty()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tethercalc;
  const auto content = std::as_bytes(std::span(data, size));
  read_or_be_refused([&] {
    const FlightLog log = parse_flight_log(content, "flight.csv", {}).log;
    for (const auto* column : {&log.roll, &log.pitch, &log.yaw, &log.north_velocity,
                               &log.east_velocity, &log.down_velocity}) {
      require_finite(*column, log.time.size(), false);
    }
  });
  for (const bool free_flight : {false, true}) {
    read_or_be_refused([&] {
      const PowerLog log = parse_power_log(content, "power.csv", {.free_flight = free_flight}).log;
      require_finite(log.airspeed, log.time.size(), false);
      for (const PowerChannel& channel : power_channels) {
        require_finite(log.*channel.values, log.time.size(), channel.optional);
      }
    });
  }
  return 0;
}
