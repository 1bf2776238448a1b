#include "tethercalc/report/design_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/report/sweep_figure.hpp"

namespace tethercalc {
namespace {

/// Null where the library states none.
ordered_json stated(double value) { return number_or_null(value > 0 ? value : nan); }

ordered_json motor_json(const MotorEntry& motor) {
  return {{"id", motor.id},
          {"max_thrust_g", motor.curve.max_thrust() / unit::gram_force},
          {"max_power_W", motor.curve.max_power()},
          {"voltage_V", number_or_null(motor.voltage_V)},
          {"propeller_in", number_or_null(motor.propeller_in)},
          {"points", static_cast<double>(motor.curve.vertices().size() - 1)},
          {"source", motor.source}};
}

ordered_json conductor_json(const ConductorEntry& entry) {
  const Conductor& c = entry.conductor;
  return {{"id", entry.id},
          {"resistivity_ohm_mm2_m", c.resistivity_20C / unit::ohm_square_millimetre_per_metre},
          {"temperature_coefficient_1_K", c.temperature_coefficient},
          {"density_g_cm3", c.density / unit::gram_per_cubic_centimetre},
          {"tensile_strength_MPa", stated(c.tensile_strength / 1e6)},
          {"source", entry.source}};
}

ordered_json insulation_json(const InsulationEntry& entry) {
  const Insulation& i = entry.insulation;
  return {{"id", entry.id},
          {"density_g_cm3", i.density / unit::gram_per_cubic_centimetre},
          {"rated_temperature_C", number_or_null(i.rated_temperature_C)},
          {"thermal_conductivity_W_mK", stated(i.thermal_conductivity)},
          {"breakdown_kV_mm", stated(i.breakdown_strength / 1e6)},
          {"source", entry.source}};
}

ordered_json size_json(const WireSize& size) {
  return {{"name", size.name},
          {"standard", size.standard},
          {"cross_section_mm2", size.area / unit::square_millimetre}};
}

/// What a table calls a key: its words, and on a second line its unit.
std::string column_title(const std::string& key) {
  if (key == "cross_section_mm2") return "cross-section\nmm²";
  std::string title = axis_label(key);
  if (const std::size_t unit = title.find(" ("); unit != std::string::npos) {
    title.pop_back();
    title.replace(unit, 2, "\n");
  }
  return title;
}

std::string cell_text(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "–" : fmt::format("{:.4g}", value.get<double>());
}

/// Each source once, after the entries that have it.
std::string sources_text(const ordered_json& entries) {
  std::vector<std::pair<std::string, std::string>> ids_of;  // by source
  for (const ordered_json& entry : entries) {
    const std::string source = entry["source"];
    const std::string id = entry["id"];
    const auto same =
        std::ranges::find(ids_of, source, &std::pair<std::string, std::string>::first);
    if (same == ids_of.end()) {
      ids_of.emplace_back(source, id);
    } else {
      same->second += ", " + id;
    }
  }
  std::string text;
  for (const auto& [source, ids] : ids_of) text += wrapped(ids + ": " + source, 98, "  ");
  return text;
}

}  // namespace

ordered_json library_json(const std::string& what) {
  if (what == "motors") return json_list(library_motors(), motor_json);
  if (what == "conductors") return json_list(library_conductors(), conductor_json);
  if (what == "insulation") return json_list(library_insulation(), insulation_json);
  if (what == "sizes") return json_list(wire_sizes(), size_json);
  throw InputError("list", "\"" + what +
                               "\" is not something to list; allowed are motors, conductors, "
                               "insulation and sizes");
}

std::string library_text(const ordered_json& entries, const TextStyle& style) {
  std::vector<TextTable::Column> columns;
  for (const auto& [key, value] : entries.front().items()) {
    if (key == "source") continue;
    columns.push_back(value.is_string() ? word_column(column_title(key)) : column_title(key));
  }
  TextTable table(columns);
  for (const ordered_json& entry : entries) {
    std::vector<std::string> cells;
    for (const ordered_json& value : entry) cells.push_back(cell_text(value));
    cells.resize(columns.size());  // without the source
    table.add(cells);
  }
  const std::string out = table.text(style);
  if (!entries.front().contains("source")) return out;
  return out + "\n" + style.bold("Sources") + "\n" + sources_text(entries);
}

std::string entries_csv(const ordered_json& entries) {
  ordered_json keys = ordered_json::array();
  for (const auto& [key, value] : entries.front().items()) keys.push_back(key);
  std::string out = csv_line(keys);
  for (const ordered_json& entry : entries) out += csv_line(entry);
  return out;
}

}  // namespace tethercalc
