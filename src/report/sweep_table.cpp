#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/csv.hpp"
#include "model/constants.hpp"
#include "tethercalc/report/sweep_figure.hpp"

namespace tethercalc {
namespace {

// More would scroll the first, which is usually the cause, off the screen.
constexpr std::size_t most_problems = 20;

/// Of fields that only sweeps know, such as a material's density, the first row tells.
bool takes_numbers(const std::string& path, const std::string& first_cell) {
  const SpecField* field = find_field(path);
  return field != nullptr ? is_numeric(*field) : parsed_number(first_cell).has_value();
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const std::string& value)
      : rows_(text, file), problems_(most_problems, file) {
    table_.file = file;
    table_.value_column = value.empty() ? "forward.total_power_W" : value;
  }

  SweepTable read() {
    if (!rows_.next(table_.columns)) throw InputError(table_.file, "is empty");
    header();
    std::vector<std::string> cells;
    while (rows_.next(cells)) row(cells);
    problems_.throw_if_any();
    if (table_.value.empty()) throw InputError(table_.file, "has a header and no rows");
    return std::move(table_);
  }

 private:
  void header() {
    const auto& names = table_.columns;
    const auto status = std::find(names.begin(), names.end(), "status");
    if (status == names.end()) {
      throw InputError(rows_.where(),
                       "is no header of a sweep: it has no column \"status\". A later part of a "
                       "sweep in parts (--shard) has no header; join the parts first");
    }
    if (status == names.begin()) {
      throw InputError(rows_.where(), "has no column of a varied field before \"status\"");
    }
    for (auto name = names.begin(); name != status; ++name)
      table_.varied.push_back({*name, {}, {}});
    const auto value = std::find(names.begin(), names.end(), table_.value_column);
    if (value == names.end()) {
      throw InputError("--value",
                       fmt::format("\"{}\" is no column of {}{}", table_.value_column, table_.file,
                                   did_you_mean(table_.value_column, names)));
    }
    value_ = std::size_t(value - names.begin());
  }

  /// The number that a cell is; nothing, with a problem unless it is empty, where it is none.
  std::optional<double> number(const std::string& column, const std::string& cell, bool required) {
    const std::optional<double> value = parsed_number(cell);
    if (!value && (required || !cell.empty())) {
      problems_.add(rows_.where(),
                    fmt::format("{}: \"{}\" is no number", column, cell.substr(0, 40)));
    }
    return value;
  }

  void row(const std::vector<std::string>& cells) {
    if (cells.size() != table_.columns.size()) {
      return problems_.add(rows_.where(), fmt::format("has {} cells, the header has {}",
                                                      cells.size(), table_.columns.size()));
    }
    for (std::size_t c = 0; c < table_.varied.size(); ++c) varied_cell(table_.varied[c], cells[c]);
    const auto value = number(table_.value_column, cells[value_], false);
    if (!value) ++table_.infeasible;
    table_.value.push_back(value.value_or(nan));
  }

  void varied_cell(SweepColumn& column, const std::string& cell) {
    const bool first = column.values.empty();
    const bool numbers = first ? takes_numbers(column.path, cell) : column.names.empty();
    if (numbers) {
      return column.values.push_back(number(column.path, cell, true).value_or(0));
    }
    const auto known = std::find(column.names.begin(), column.names.end(), cell);
    column.values.push_back(double(known - column.names.begin()));
    if (known == column.names.end()) column.names.push_back(cell);
  }

  CsvRows rows_;
  SweepTable table_;
  std::size_t value_ = 0;
  Problems problems_;
};

/// The ending of a name that says its unit, and the unit; empty where it has none.
std::pair<std::string_view, const char*> unit_ending(std::string_view name) {
  // The longest ending first: "_m_s" before "_s".
  constexpr std::array<std::pair<std::string_view, const char*>, 28> units{
      {{"_ohm_mm2_per_m", "Ω mm²/m"},
       {"_ohm_mm2_m", "Ω·mm²/m"},
       {"_1_K", "1/K"},
       {"_per_K", "1/K"},
       {"_kg_m3", "kg/m³"},
       {"_g_cm3", "g/cm³"},
       {"_kg_per_kW", "kg/kW"},
       {"_g_per_W", "g/W"},
       {"_W_mK", "W/(m·K)"},
       {"_W_m2", "W/m²"},
       {"_kV_mm", "kV/mm"},
       {"_m_s2", "m/s²"},
       {"_m_s", "m/s"},
       {"_mm2", "mm²"},
       {"_m2", "m²"},
       {"_mm", "mm"},
       {"_MPa", "MPa"},
       {"_ohm", "Ω"},
       {"_percent", "%"},
       {"_deg", "°"},
       {"_in", "in"},
       {"_N", "N"},
       {"_W", "W"},
       {"_V", "V"},
       {"_A", "A"},
       {"_C", "°C"},
       {"_m", "m"},
       {"_g", "g"}}};
  for (const auto& unit : units) {
    if (name.ends_with(unit.first)) return unit;
  }
  return {"", ""};
}

}  // namespace

std::vector<double> SweepColumn::distinct() const {
  std::vector<double> out = values;
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

SweepTable parse_sweep_csv(std::string_view text, const std::string& file,
                           const std::string& value) {
  return Reader(text, file, value).read();
}

std::string unit_of(std::string_view name) {
  if (const SpecField* field = find_field(name)) return std::string(field->unit);
  return unit_ending(name).second;
}

std::string axis_label(std::string_view name) {
  const std::string unit = unit_of(name);
  if (!unit.empty()) name.remove_suffix(unit_ending(name).first.size());
  std::string out(name);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  return unit.empty() ? out : fmt::format("{} ({})", out, unit);
}

}  // namespace tethercalc
