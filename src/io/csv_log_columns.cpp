#include "io/csv_log_columns.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "io/foreign_files.hpp"
#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr auto is_ignored = ColumnUse::ignored;
constexpr auto is_taken = ColumnUse::taken;
constexpr auto is_needed = ColumnUse::needed;

constexpr LogCsvColumn within(std::string_view name, std::string_view unit,
                              std::string_view meaning, ColumnUse flight, ColumnUse power,
                              double limit) {
  return {name, unit, meaning, flight, power, -limit, limit};
}

constexpr std::array all_columns{
    LogCsvColumn{"time_s", "s", "Time, which increases from row to row", is_needed, is_needed},
    within("roll_deg", "°", "Roll, right side down", is_needed, is_ignored, furthest_roll_deg),
    within("pitch_deg", "°", "Pitch, nose up", is_needed, is_ignored, steepest_pitch_deg),
    within("yaw_deg", "°", "Heading, clockwise from north", is_needed, is_taken, furthest_yaw_deg),
    within("vn_m_s", "m/s", "Velocity over ground to the north", is_needed, is_taken, fastest_m_s),
    within("ve_m_s", "m/s", "Velocity over ground to the east", is_needed, is_taken, fastest_m_s),
    within("vd_m_s", "m/s", "Velocity downward", is_needed, is_ignored, fastest_m_s),
    within("wind_north_m_s", "m/s", "Measured velocity of the air over ground to the north",
           is_taken, is_taken, fastest_m_s),
    within("wind_east_m_s", "m/s", "The same to the east", is_taken, is_taken, fastest_m_s),
    within("airspeed_forward_m_s", "m/s", "Instead of that wind: airspeed measured along the nose",
           is_taken, is_taken, fastest_m_s),
    LogCsvColumn{"height_m", "m", "Height above the station, or above take-off", is_ignored,
                 is_needed},
    within("airspeed_m_s", "m/s", "Airspeed, whatever its direction", is_ignored, is_needed,
           fastest_m_s),
    LogCsvColumn{"ambient_temperature_C", "°C", "Temperature of the air", is_ignored, is_taken,
                 -zero_celsius_K},
    LogCsvColumn{"supply_voltage_V", "V", "At the ground end of the tether", is_ignored, is_taken},
    LogCsvColumn{"supply_current_A", "A", "At the ground end of the tether", is_ignored, is_taken},
    LogCsvColumn{"drone_voltage_V", "V", "At the converter's input", is_ignored, is_taken},
    LogCsvColumn{"bus_voltage_V", "V", "At the motors' bus: the converter's output, or the battery",
                 is_ignored, is_taken},
    LogCsvColumn{"bus_current_A", "A", "Into the motors' bus", is_ignored, is_taken},
    LogCsvColumn{"bus_power_W", "W", "Instead of these two: their product", is_ignored, is_taken}};

std::size_t index_of(std::string_view name) {
  const auto found = std::ranges::find(all_columns, name, &LogCsvColumn::name);
  return static_cast<std::size_t>(found - all_columns.begin());
}

}  // namespace

std::span<const LogCsvColumn> log_csv_columns() { return all_columns; }

LogTable::LogTable(std::string_view text, std::string_view file, ColumnUse LogCsvColumn::*use,
                   std::span<const std::string_view> optional) {
  std::vector<CsvColumn> wanted;
  for (const LogCsvColumn& column : all_columns) {
    const bool may_lack = std::ranges::find(optional, column.name) != optional.end();
    wanted.push_back({.name = column.name,
                      .required = column.*use == is_needed && !may_lack,
                      .minimum = column.minimum,
                      .maximum = column.maximum,
                      .increasing = column.name == "time_s",
                      .ignored = column.*use == is_ignored});
  }
  columns_ = read_csv_columns(text, file, wanted, OtherCsvColumns::rejected);
}

std::vector<double>& LogTable::operator[](std::string_view name) {
  return columns_.at(index_of(name));
}

bool looks_like_table(std::span<const std::byte> content) {
  return looks_like_text(content) && !looks_like_dataflash_text(content) &&
         foreign_kind(content).empty();
}

void check_wind_columns(LogTable& table, std::string_view file) {
  if (table.has("wind_north_m_s") != table.has("wind_east_m_s")) {
    throw InputError(std::string(file),
                     "wind_north_m_s and wind_east_m_s are one wind: give both or none");
  }
  if (table.has("wind_north_m_s") && table.has("airspeed_forward_m_s")) {
    throw InputError(
        std::string(file),
        "airspeed_forward_m_s goes without wind_north_m_s and wind_east_m_s: each gives the "
        "other, and only one can be what was measured");
  }
}

}  // namespace tethercalc
