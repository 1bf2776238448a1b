#include "tethercalc/io/power_log_reader.hpp"

#include <array>
#include <utility>

#include "io/csv_columns.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

PowerLog parse_power_log(std::string_view text, std::string_view name) {
  constexpr std::array<CsvColumn, 9> wanted = {
      CsvColumn{.name = "time_s", .increasing = true},
      CsvColumn{.name = "height_m"},
      CsvColumn{.name = "airspeed_m_s"},
      CsvColumn{.name = "ambient_temperature_C", .required = false, .minimum = -zero_celsius_K},
      CsvColumn{.name = "supply_voltage_V"},
      CsvColumn{.name = "supply_current_A"},
      CsvColumn{.name = "drone_voltage_V", .required = false},
      CsvColumn{.name = "bus_voltage_V", .required = false},
      CsvColumn{.name = "bus_current_A", .required = false}};
  auto columns = read_csv_columns(text, name, wanted, OtherCsvColumns::rejected);
  PowerLog log;
  log.time = std::move(columns[0]);
  log.height = std::move(columns[1]);
  log.airspeed = std::move(columns[2]);
  log.ambient_temperature_C = std::move(columns[3]);
  log.supply_voltage = std::move(columns[4]);
  log.supply_current = std::move(columns[5]);
  log.drone_voltage = std::move(columns[6]);
  log.bus_voltage = std::move(columns[7]);
  log.bus_current = std::move(columns[8]);
  return log;
}

}  // namespace tethercalc
