#include "tethercalc/report/library_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/constants.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/report/csv_cell.hpp"
#include "tethercalc/report/json_results.hpp"

namespace tethercalc {
namespace {

constexpr double unstated = nan;

LibraryListing list_motors() {
  LibraryListing listing{{{"id", "id"},
                          {"max_thrust_g", "max thrust\ng"},
                          {"max_power_W", "max power\nW"},
                          {"voltage_V", "voltage\nV"},
                          {"propeller_in", "propeller\nin"},
                          {"points", "points"},
                          {"source", ""}},
                         {}};
  for (const MotorEntry& motor : library_motors()) {
    const auto points = static_cast<double>(motor.curve.vertices().size() - 1);
    listing.rows.push_back({motor.id, motor.curve.max_thrust() / unit::gram_force,
                            motor.curve.max_power(), motor.voltage_V.value_or(unstated),
                            motor.propeller_in.value_or(unstated), points, motor.source});
  }
  return listing;
}

LibraryListing list_conductors() {
  LibraryListing listing{{{"id", "id"},
                          {"resistivity_ohm_mm2_m", "resistivity\nΩ·mm²/m"},
                          {"temperature_coefficient_1_K", "temperature coefficient\n1/K"},
                          {"density_g_cm3", "density\ng/cm³"},
                          {"tensile_strength_MPa", "tensile strength\nMPa"},
                          {"source", ""}},
                         {}};
  for (const ConductorEntry& entry : library_conductors()) {
    const Conductor& c = entry.conductor;
    listing.rows.push_back({entry.id, c.resistivity_20C / unit::ohm_square_millimetre_per_metre,
                            c.temperature_coefficient, c.density / unit::gram_per_cubic_centimetre,
                            c.tensile_strength > 0 ? c.tensile_strength / 1e6 : unstated,
                            entry.source});
  }
  return listing;
}

LibraryListing list_insulation() {
  LibraryListing listing{{{"id", "id"},
                          {"density_g_cm3", "density\ng/cm³"},
                          {"rated_temperature_C", "rated temperature\n°C"},
                          {"thermal_conductivity_W_mK", "thermal conductivity\nW/(m·K)"},
                          {"breakdown_kV_mm", "breakdown\nkV/mm"},
                          {"source", ""}},
                         {}};
  const auto stated = [](double value) { return value > 0 ? value : unstated; };
  for (const InsulationEntry& entry : library_insulation()) {
    const Insulation& i = entry.insulation;
    listing.rows.push_back({entry.id, i.density / unit::gram_per_cubic_centimetre,
                            i.rated_temperature_C.value_or(unstated),
                            stated(i.thermal_conductivity), stated(i.breakdown_strength) / 1e6,
                            entry.source});
  }
  return listing;
}

LibraryListing list_sizes() {
  LibraryListing listing{
      {{"name", "name"}, {"standard", "standard"}, {"cross_section_mm2", "cross-section\nmm²"}},
      {}};
  for (const WireSize& size : wire_sizes()) {
    listing.rows.push_back({size.name, size.standard, size.area / unit::square_millimetre});
  }
  return listing;
}

std::string cell_text(const LibraryListing::Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const double value = std::get<double>(cell);
  return value == value ? fmt::format("{:.4g}", value) : "–";
}

/// Each source once, after the entries that have it.
std::string sources_text(const LibraryListing& listing) {
  std::vector<std::pair<std::string, std::string>> entries_of;  // source, ids
  for (const auto& row : listing.rows) {
    const std::string source = cell_text(row.back());
    const auto same = std::find_if(entries_of.begin(), entries_of.end(),
                                   [&](const auto& known) { return known.first == source; });
    if (same == entries_of.end()) {
      entries_of.emplace_back(source, cell_text(row.front()));
    } else {
      same->second += ", " + cell_text(row.front());
    }
  }
  std::string text;
  for (const auto& [source, ids] : entries_of) text += wrapped(ids + ": " + source, 98, "  ");
  return text;
}

}  // namespace

LibraryListing list_library(const std::string& what) {
  if (what == "motors") return list_motors();
  if (what == "conductors") return list_conductors();
  if (what == "insulation") return list_insulation();
  if (what == "sizes") return list_sizes();
  throw InputError({{"list", "\"" + what +
                                 "\" is not something to list; allowed are motors, conductors, "
                                 "insulation and sizes"}});
}

std::string listing_text(const LibraryListing& listing, const TextStyle& style) {
  std::vector<TextTable::Column> columns;
  const bool sourced = listing.columns.back().key == "source";
  const std::size_t shown = listing.columns.size() - (sourced ? 1 : 0);
  for (std::size_t i = 0; i < shown; ++i) {
    const bool words =
        !listing.rows.empty() && std::holds_alternative<std::string>(listing.rows.front()[i]);
    columns.push_back(
        {listing.columns[i].title, words ? TextTable::Align::left : TextTable::Align::right});
  }
  TextTable table(columns);
  for (const auto& row : listing.rows) {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < shown; ++i) cells.push_back(cell_text(row[i]));
    table.add(cells);
  }
  std::string out = table.text(style);
  if (sourced) out += "\n" + style.bold("Sources") + "\n" + sources_text(listing);
  return out;
}

nlohmann::ordered_json listing_json(const LibraryListing& listing) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : listing.rows) {
    nlohmann::ordered_json object;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto* text = std::get_if<std::string>(&row[i]);
      object[listing.columns[i].key] =
          text ? nlohmann::ordered_json(*text) : number_or_null(std::get<double>(row[i]));
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

std::string listing_csv(const LibraryListing& listing) {
  std::string out;
  for (std::size_t i = 0; i < listing.columns.size(); ++i)
    out += (i ? "," : "") + listing.columns[i].key;
  out += "\n";
  for (const auto& row : listing.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto* text = std::get_if<std::string>(&row[i]);
      out += (i ? "," : "") + (text ? csv_text(*text) : csv_number(std::get<double>(row[i])));
    }
    out += "\n";
  }
  return out;
}

}  // namespace tethercalc
