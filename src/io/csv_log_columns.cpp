#include "io/csv_log_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/column_choice.hpp"
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
    within("quaternion_w", "1", "Instead of these angles: attitude as a rotation, its real part",
           is_taken, is_ignored, 1.1),
    within("quaternion_x", "1", "About forward of the drone, which it turns to north", is_taken,
           is_ignored, 1.1),
    within("quaternion_y", "1", "About its right, turned to east", is_taken, is_ignored, 1.1),
    within("quaternion_z", "1", "About its down, turned to down", is_taken, is_ignored, 1.1),
    within("body_forward_m_s", "m/s", "Instead of that velocity: along the drone's own nose",
           is_taken, is_ignored, fastest_m_s),
    within("body_right_m_s", "m/s", "Along its right side", is_taken, is_ignored, fastest_m_s),
    within("body_down_m_s", "m/s", "Along its own down", is_taken, is_ignored, fastest_m_s),
    within("wind_north_m_s", "m/s", "Measured velocity of the air over ground to the north",
           is_taken, is_taken, fastest_m_s),
    within("wind_east_m_s", "m/s", "The same to the east", is_taken, is_taken, fastest_m_s),
    within("airspeed_forward_m_s", "m/s", "Instead of that wind: airspeed measured along the nose",
           is_taken, is_taken, fastest_m_s),
    LogCsvColumn{"height_m", "m", "Height above the station, or above take-off", is_ignored,
                 is_needed},
    within("airspeed_m_s", "m/s", "Airspeed, whatever its direction", is_taken, is_needed,
           fastest_m_s),
    within("air_from_deg", "°",
           "With it instead of a wind: where that air comes from, clockwise from north", is_taken,
           is_ignored, furthest_yaw_deg),
    LogCsvColumn{"ambient_temperature_C", "°C", "Temperature of the air", is_ignored, is_taken,
                 -zero_celsius_K},
    LogCsvColumn{"supply_voltage_V", "V", "At the ground end of the tether", is_ignored, is_taken},
    LogCsvColumn{"supply_current_A", "A", "At the ground end of the tether", is_ignored, is_taken},
    LogCsvColumn{"drone_voltage_V", "V", "At the converter's input", is_ignored, is_taken},
    LogCsvColumn{"bus_voltage_V", "V", "At the motors' bus: the converter's output, or the battery",
                 is_ignored, is_taken},
    LogCsvColumn{"bus_current_A", "A", "Into the motors' bus", is_ignored, is_taken},
    LogCsvColumn{"bus_power_W", "W", "Instead of these two: their product", is_ignored, is_taken},
    LogCsvColumn{"acceleration_along_m_s2", "m/s²",
                 "By which the airspeed grows; steady flight where absent", is_ignored, is_taken},
    LogCsvColumn{"acceleration_across_m_s2", "m/s²", "Level, across the airspeed", is_ignored,
                 is_taken}};

constexpr std::array all_units{LogCsvUnit{"s", "min", 60},
                               LogCsvUnit{"s", "ms", 1e-3},
                               LogCsvUnit{"s", "us", 1e-6},
                               LogCsvUnit{"deg", "rad", 1 / unit::degree},
                               LogCsvUnit{"m_s", "km_h", 1 / 3.6},
                               LogCsvUnit{"m_s", "cm_s", 1e-2},
                               LogCsvUnit{"m_s", "kn", 1852 / 3600.0},
                               LogCsvUnit{"m_s", "mph", 1609.344 / 3600},
                               LogCsvUnit{"m_s", "ft_s", 0.3048},
                               LogCsvUnit{"m", "cm", 1e-2},
                               LogCsvUnit{"m", "ft", 0.3048},
                               LogCsvUnit{"C", "K", 1, -zero_celsius_K},
                               LogCsvUnit{"C", "F", 5 / 9.0, -32 * 5 / 9.0},
                               LogCsvUnit{"V", "mV", 1e-3},
                               LogCsvUnit{"A", "mA", 1e-3},
                               LogCsvUnit{"W", "kW", 1e3}};

/// Columns that may stand for others.
struct Instead {
  std::vector<std::string_view> of;
  std::vector<std::string_view> given;  ///< all of them, or none
};

const std::array<Instead, 2> substitutes{
    Instead{{"roll_deg", "pitch_deg", "yaw_deg"},
            {"quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z"}},
    Instead{{"vn_m_s", "ve_m_s", "vd_m_s"},
            {"body_forward_m_s", "body_right_m_s", "body_down_m_s"}}};

bool holds(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

std::size_t index_of(std::string_view name) {
  const auto found = std::ranges::find(all_columns, name, &LogCsvColumn::name);
  return static_cast<std::size_t>(found - all_columns.begin());
}

/// The unit at the end of a column's name; empty where it has none.
std::string_view own_unit(std::string_view name) {
  std::string_view longest;
  for (const LogCsvUnit& unit : all_units) {
    const bool ends = name.ends_with(unit.own) && name.ends_with("_" + std::string(unit.own));
    if (ends && unit.own.size() > longest.size()) longest = unit.own;
  }
  return longest;
}

/// The name of a column in another unit.
std::string in_unit(const LogCsvColumn& column, std::string_view unit) {
  const std::size_t own = own_unit(column.name).size();
  return std::string(column.name.substr(0, column.name.size() - own)) + std::string(unit);
}

/// Which column, and how its numbers come from those of the unit.
struct ConvertedColumn {
  std::size_t index = 0;
  double factor = 1;
  double offset = 0;
};

/// The column that is called so, in its own unit or in another.
std::optional<ConvertedColumn> converted_column(std::string_view name) {
  for (std::size_t i = 0; i < all_columns.size(); ++i) {
    if (all_columns[i].name == name) return ConvertedColumn{i};
    for (const LogCsvUnit& unit : all_units) {
      if (own_unit(all_columns[i].name) == unit.own &&
          in_unit(all_columns[i], unit.other) == name) {
        return ConvertedColumn{i, unit.factor, unit.offset};
      }
    }
  }
  return std::nullopt;
}

/// Why nothing is called `name`.
std::string unknown_name(const std::string& name) {
  for (const LogCsvColumn& column : all_columns) {
    const std::string_view own = own_unit(column.name);
    if (own.empty() || !name.starts_with(in_unit(column, ""))) continue;
    std::vector<std::string> allowed{std::string(column.name)};
    for (const LogCsvUnit& unit : all_units) {
      if (unit.own == own) allowed.push_back(in_unit(column, unit.other));
    }
    return fmt::format("\"{}\" has no unit of {}; allowed are {}", name, column.name,
                       fmt::join(allowed, ", "));
  }
  std::vector<std::string> known;
  for (const LogCsvColumn& column : all_columns) known.emplace_back(column.name);
  return fmt::format("\"{}\" is no column of a log; known are {}{}", name, fmt::join(known, ", "),
                     did_you_mean(name, known));
}

/// Gives each of `wanted` that is chosen its column of the file. Returns which columns of the file
/// were taken.
std::vector<bool> choose(std::vector<CsvColumn>& wanted, std::span<const std::string> chosen,
                         std::span<const std::string> header, std::string_view file) {
  Problems problems;
  std::vector<bool> taken(header.size(), false);
  for (const std::string& text : chosen) {
    const auto choice = column_choice(text);
    if (!choice) {
      problems.add("--columns",
                   fmt::format("\"{}\" does not say what a column holds; allowed is NAME=COLUMN, "
                               "such as airspeed_m_s=wind_speed or yaw_rad=heading",
                               text));
      continue;
    }
    const auto named = converted_column(choice->quantity);
    if (!named) {
      problems.add("--columns", unknown_name(choice->quantity));
      continue;
    }
    const auto at = chosen_column(*choice, header);
    if (!at) {
      problems.add(fmt::format("{}:1", file),
                   fmt::format("there is no column \"{}\" for {}{}", choice->header,
                               choice->quantity, did_you_mean(choice->header, header)));
      continue;
    }
    CsvColumn& column = wanted[named->index];
    if (!column.header.empty()) {
      problems.add("--columns", fmt::format("{} is given twice", column.name));
    } else if (taken[at->index]) {
      problems.add("--columns", fmt::format("the column \"{}\" is given twice", header[at->index]));
    }
    taken[at->index] = true;
    column.header = header[at->index];
    column.factor = at->sign * named->factor;
    column.offset = named->offset;
  }
  problems.throw_if_any();
  return taken;
}

/// Lets columns stand for others where `has` some of them.
void substitute(std::vector<CsvColumn>& wanted, const std::function<bool(std::string_view)>& has,
                std::string_view file) {
  for (const Instead& substitute : substitutes) {
    if (wanted[index_of(substitute.given.front())].ignored) continue;
    if (std::ranges::none_of(substitute.given, has)) continue;
    const auto twice = std::ranges::find_if(substitute.of, has);
    if (twice != substitute.of.end()) {
      throw InputError(fmt::format("{}:1", file),
                       fmt::format("{} go without {}: they give it too",
                                   fmt::join(substitute.given, ", "), *twice));
    }
    for (const std::string_view name : substitute.of) wanted[index_of(name)].required = false;
    for (const std::string_view name : substitute.given) wanted[index_of(name)].required = true;
  }
}

}  // namespace

std::span<const LogCsvColumn> log_csv_columns() { return all_columns; }

std::span<const LogCsvUnit> log_csv_units() { return all_units; }

LogTable::LogTable(std::string_view text, std::string_view file, ColumnUse LogCsvColumn::*use,
                   std::span<const std::string> chosen,
                   std::span<const std::string_view> optional) {
  std::vector<CsvColumn> wanted;
  for (const LogCsvColumn& column : all_columns) {
    wanted.push_back({.name = column.name,
                      .required = column.*use == is_needed && !holds(optional, column.name),
                      .minimum = column.minimum,
                      .maximum = column.maximum,
                      .increasing = column.name == "time_s",
                      .ignored = column.*use == is_ignored});
  }
  const std::vector<std::string> header = csv_header(text);
  const std::vector<bool> taken = choose(wanted, chosen, header, file);
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::size_t own = index_of(header[i]);
    const bool stands = own < wanted.size() && wanted[own].header.empty();
    if (taken[i] && stands) wanted[own].absent = true;
    if (!taken[i] && !stands) passed_over_.push_back(header[i]);
  }
  const auto has = [&](std::string_view name) {
    const CsvColumn& column = wanted[index_of(name)];
    return !column.header.empty() ||
           (!column.absent && std::ranges::find(header, name) != header.end());
  };
  substitute(wanted, has, file);
  // Of a flight an airspeed is a wind only with its direction.
  CsvColumn& from = wanted[index_of("air_from_deg")];
  CsvColumn& airspeed = wanted[index_of("airspeed_m_s")];
  if (!from.ignored && has("air_from_deg")) {
    airspeed.required = true;
  } else if (!from.ignored) {
    airspeed.ignored = true;
  }
  columns_ = read_csv_columns(
      text, file, wanted, chosen.empty() ? OtherCsvColumns::rejected : OtherCsvColumns::ignored,
      "; --columns NAME=COLUMN,... says what a column of another name holds, and passes over what "
      "is then unknown");
}

std::vector<double>& LogTable::operator[](std::string_view name) {
  return columns_.at(index_of(name));
}

void LogTable::note_passed_over(std::vector<Warning>& notes) const {
  if (passed_over_.empty()) return;
  notes.push_back({WarningKind::log_columns_passed_over,
                   fmt::format("not used: the columns {}", fmt::join(passed_over_, ", "))});
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
  std::vector<std::string_view> ways;
  for (const std::string_view name : {"wind_north_m_s", "airspeed_forward_m_s", "air_from_deg"}) {
    if (table.has(name)) ways.push_back(name);
  }
  if (ways.size() > 1) {
    throw InputError(std::string(file),
                     fmt::format("{} and {} go without each other: each gives the wind, and only "
                                 "one can be what was measured",
                                 ways[0], ways[1]));
  }
}

void check_no_columns(std::span<const std::string> chosen, std::string_view file) {
  if (chosen.empty()) return;
  throw InputError("--columns",
                   fmt::format("names columns of a log in CSV; {} is an autopilot's", file));
}

void check_no_core(int core, std::string_view file) {
  if (core == 0) return;
  throw InputError(std::string(file),
                   "is CSV and holds one estimate: --core has no other to choose");
}

}  // namespace tethercalc
