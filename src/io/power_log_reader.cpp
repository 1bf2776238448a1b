#include "tethercalc/io/power_log_reader.hpp"

#include <utility>
#include <vector>

#include "diagnose/power_channels.hpp"
#include "io/csv.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

PowerLog parse_power_log(std::string_view text, std::string_view name) {
  std::vector<CsvColumn> wanted{{.name = "time_s", .increasing = true}};
  for (const PowerChannel& channel : power_channels) {
    wanted.push_back({.name = channel.name, .required = !channel.optional});
    if (channel.values == &PowerLog::ambient_temperature_C) wanted.back().minimum = -zero_celsius_K;
  }
  auto columns = read_csv_columns(text, name, wanted, OtherCsvColumns::rejected);
  PowerLog log;
  log.time = std::move(columns[0]);
  for (std::size_t c = 0; c < power_channels.size(); ++c) {
    log.*power_channels[c].values = std::move(columns[c + 1]);
  }
  return log;
}

}  // namespace tethercalc
