#include "tethercalc/report/optimize_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/csv_cell.hpp"
#include "tethercalc/report/json_results.hpp"
#include "tethercalc/report/limit_sentences.hpp"
#include "tethercalc/report/operating_point_fields.hpp"

namespace tethercalc {
namespace {

using nlohmann::ordered_json;

double square_millimetres(double area) { return area / unit::square_millimetre; }

std::string area_words(double area) { return significant(square_millimetres(area), 4) + " mm²"; }

/// `value` rounded to two significant digits.
double rounded(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / step) * step;
}

/// Round areas around what matters, and what matters itself, rising.
std::vector<double> table_areas(const Optimization& result, const BestHeadroom& best) {
  std::vector<double> exact;
  const auto add = [&](double area) {
    if (std::isfinite(area) && area > 0) exact.push_back(area);
  };
  add(result.feasible ? result.area : best.area);
  add(result.minimum_power.area);
  for (const Interval& range : result.feasible_areas) {
    add(range.lo);
    add(range.hi);
  }
  if (exact.empty()) return exact;
  const auto [least, most] = std::minmax_element(exact.begin(), exact.end());
  const double from = 0.5 * *least;
  const double to = 1.5 * *most;
  std::vector<double> areas = exact;
  constexpr int steps = 12;
  for (int i = 0; i <= steps; ++i) {
    const double area = from * std::pow(to / from, double(i) / steps);
    areas.push_back(rounded(square_millimetres(area)) * unit::square_millimetre);
  }
  std::sort(areas.begin(), areas.end());
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };
  areas.erase(std::unique(areas.begin(), areas.end(), same), areas.end());
  return areas;
}

/// The standard sizes below and above the optimum, and the cable of the spec.
std::vector<SizePoints> sizes_near(const DesignFile& file, double area) {
  std::vector<SizePoints> sizes;
  const auto add = [&](const std::string& name, double size) {
    sizes.push_back({name, evaluate_areas(file.design, std::span(&size, 1)).front()});
  };
  if (std::isfinite(area)) {
    // The end of a short standard is no neighbour; it counts where no standard goes further.
    std::vector<WireNeighbours> standards = wire_sizes_near(area);
    const auto brackets = [](const WireNeighbours& s) { return s.below && s.above; };
    if (std::any_of(standards.begin(), standards.end(), brackets)) {
      std::erase_if(standards, std::not_fn(brackets));
    }
    for (const WireNeighbours& standard : standards) {
      for (const auto& size : {standard.below, standard.above}) {
        if (size) add(size->name, size->area);
      }
    }
  }
  if (file.design.tether.cross_section) add("as specified", *file.design.tether.cross_section);
  std::stable_sort(sizes.begin(), sizes.end(), [](const SizePoints& a, const SizePoints& b) {
    return a.points.area < b.points.area;
  });
  const auto same = [](const SizePoints& a, const SizePoints& b) { return a.name == b.name; };
  sizes.erase(std::unique(sizes.begin(), sizes.end(), same), sizes.end());
  return sizes;
}

std::string lost_share(const OperatingPoint& point) {
  return significant(100 * point.tether_loss / point.total_power, 3);
}

void add_condition_row(TextTable& table, const char* name, const OperatingPoint& point) {
  table.add({name, fixed(point.total_power, 1), fixed(point.drone_power, 1),
             fixed(point.tether_loss, 1), lost_share(point), fixed(point.current, 2),
             fixed(point.received_voltage, 1), fixed(point.headroom, 2),
             fixed(point.pitch / unit::degree, 1)});
}

Answer feasible_answer(const OptimizeStudy& study) {
  const Optimization& result = study.result;
  const Design& design = study.file.design;
  const OperatingPoint& hover = result.hover;
  Answer out;
  out.headline = fmt::format("Fly {} of {}.", area_words(result.area), study.file.conductor.id);
  out.sentences.push_back(limit_sentence(design, result));
  out.sentences.push_back(fmt::format(
      "The tether of {} m weighs {} g and has {} ohm; the drone takes off with {} g.",
      significant(design.tether.length, 3), fixed(hover.tether_mass / unit::gram, 1),
      significant(hover.tether_resistance, 4), fixed(hover.takeoff_mass / unit::gram, 0)));
  for (std::string& sentence : cable_sentences(design, hover, result.forward)) {
    out.sentences.push_back(std::move(sentence));
  }
  const double speed = airspeed(design, Condition::forward);
  out.sentences.push_back(
      fmt::format("It draws {} W in hover and {} W in forward flight at {} m/s ({} km/h).",
                  fixed(hover.total_power, 1), fixed(result.forward.total_power, 1),
                  fixed(speed, 2), fixed(3.6 * speed, 1)));
  return out;
}

std::string remedy_words(const Design& design, const Remedy& remedy) {
  switch (remedy.quantity) {
    case Quantity::supply_voltage:
      return fmt::format("a supply of {} V instead of {} V", significant(remedy.value, 3),
                         significant(design.supply.voltage, 3));
    case Quantity::drone_mass:
      return fmt::format("a drone of {} g instead of {} g", fixed(remedy.value / unit::gram, 0),
                         fixed(design.drone.mass / unit::gram, 0));
    case Quantity::tether_length:
      return fmt::format("a tether of {} m instead of {} m", significant(remedy.value, 3),
                         significant(design.tether.length, 3));
    case Quantity::airspeed:
      return fmt::format("an airspeed of {} m/s instead of {} m/s", significant(remedy.value, 3),
                         significant(design.flight.airspeed, 3));
  }
  return "";
}

Answer refusal(const OptimizeStudy& study) {
  const Design& design = study.file.design;
  Answer out{
      "This design cannot fly as required.", {infeasible_sentence(design, study.result)}, {}};
  out.sentences.push_back(
      study.remedies.empty()
          ? "No single change of supply voltage, drone mass, tether length or airspeed would make "
            "it feasible."
          : "Any one of these changes would make it feasible:");
  for (const Remedy& remedy : study.remedies) {
    out.remedies.push_back(remedy_words(design, remedy));
  }
  return out;
}

std::string answer_text(const OptimizeStudy& study, const TextStyle& style) {
  const Answer told = answer(study);
  const std::string headline = style.bold(told.headline);
  std::string out = (study.result.feasible ? style.good(headline) : style.bad(headline)) + "\n";
  for (const std::string& sentence : told.sentences) out += wrapped(sentence);
  for (const std::string& remedy : told.remedies) out += "  " + remedy + "\n";
  if (study.result.feasible) out += "\n" + condition_table(study).table.text(style);
  return out;
}

std::string mark(const OptimizeStudy& study, const AreaPoints& row) {
  const Optimization& result = study.result;
  std::string marks = shortcoming(study.file.design, row).empty() ? "feasible" : "";
  if (row.area == result.area) marks = "optimum";
  if (row.area == result.minimum_power.area)
    marks += marks.empty() ? "least power" : ", least power";
  return marks;
}

ordered_json table_json(std::span<const AreaPoints> table) {
  ordered_json rows = ordered_json::array();
  for (const AreaPoints& row : table) {
    rows.push_back({{"hover", operating_point_json(row.hover)},
                    {"forward", operating_point_json(row.forward)}});
  }
  return rows;
}

ordered_json remedies_json(std::span<const Remedy> remedies) {
  ordered_json out = ordered_json::object();
  for (const Remedy& remedy : remedies) {
    switch (remedy.quantity) {
      case Quantity::supply_voltage:
        out["supply.voltage_V"] = remedy.value;
        break;
      case Quantity::drone_mass:
        out["drone.mass_g"] = remedy.value / unit::gram;
        break;
      case Quantity::tether_length:
        out["tether.length_m"] = remedy.value;
        break;
      case Quantity::airspeed:
        out["flight.airspeed_m_s"] = remedy.value;
        break;
    }
  }
  return out;
}

ordered_json optimum_json(const Optimization& result) {
  return {
      {"cross_section_mm2", number_or_null(square_millimetres(result.area))},
      {"limited_by", limit_name(result.limited_by)},
      {"limiting_condition", condition_name(result.limiting_condition)},
      {"hover", result.feasible ? operating_point_json(result.hover) : ordered_json(nullptr)},
      {"forward", result.feasible ? operating_point_json(result.forward) : ordered_json(nullptr)}};
}

std::string csv_keys(const std::string& prefix) {
  std::string out;
  for (const OperatingPointField& field : operating_point_fields()) {
    out += "," + prefix + std::string(field.key);
  }
  return out;
}

std::string csv_values(const OperatingPoint& point) {
  std::string out;
  for (const OperatingPointField& field : operating_point_fields()) {
    out += "," + csv_number(practical_value(point, field));
  }
  return out;
}

std::string csv_header() {
  return "status,limited_by,limiting_condition,cross_section_mm2" + csv_keys("hover.") +
         csv_keys("forward.") + "\n";
}

std::string csv_row(const Optimization& result) {
  std::string row = fmt::format("{},{},{},{}", status_name(result), limit_name(result.limited_by),
                                condition_name(result.limiting_condition),
                                csv_number(square_millimetres(result.area)));
  const std::size_t empty_cells = 2 * operating_point_fields().size();
  row += result.feasible ? csv_values(result.hover) + csv_values(result.forward)
                         : std::string(empty_cells, ',');
  return row + "\n";
}

std::string warnings_text(const DesignFile& file, const TextStyle& style) {
  std::string out;
  for (const std::string& warning : file.warnings) {
    out += style.subdued(wrapped("Note: " + warning));
  }
  return out;
}

}  // namespace

std::vector<AreaPoints> evaluate_areas(const Design& design, std::span<const double> areas) {
  const SteadyFlight hover(design, Condition::hover);
  const SteadyFlight forward(design, Condition::forward);
  std::vector<AreaPoints> table;
  for (const double area : areas) {
    table.push_back({area, evaluate(hover, area), evaluate(forward, area)});
  }
  return table;
}

std::string shortcoming(const Design& design, const AreaPoints& points) {
  const Margins margins = demand_margins(design, points.hover, points.forward);
  const DemandMargin& worst = margins.worst();
  if (worst.met()) return "";
  return missed_words(design, worst.condition == Condition::hover ? points.hover : points.forward,
                      worst);
}

OptimizeStudy study(DesignFile file) {
  OptimizeStudy study;
  const Design& design = file.design;
  study.result = optimize(design);
  study.best_headroom = best_headroom(design, design.requirements.headroom_at);
  study.table = evaluate_areas(design, table_areas(study.result, study.best_headroom));
  study.sizes =
      sizes_near(file, study.result.feasible ? study.result.area : study.best_headroom.area);
  if (!study.result.feasible) study.remedies = remedies(design);
  const std::vector<std::string> warnings = cable_warnings(design);
  file.warnings.insert(file.warnings.end(), warnings.begin(), warnings.end());
  study.file = std::move(file);
  return study;
}

Answer answer(const OptimizeStudy& study) {
  return study.result.feasible ? feasible_answer(study) : refusal(study);
}

TitledTable condition_table(const OptimizeStudy& study) {
  TextTable table({{"", TextTable::Align::left},
                   {"supply W"},
                   {"drone W"},
                   {"lost W"},
                   {"lost %"},
                   {"current A"},
                   {"at drone V"},
                   {"headroom"},
                   {"tilt deg"}});
  add_condition_row(table, "hover", study.result.hover);
  add_condition_row(table, "forward", study.result.forward);
  return {"The optimum in flight", std::move(table)};
}

TitledTable sizes_table(const OptimizeStudy& study) {
  TextTable table({{"size", TextTable::Align::left},
                   {"mm²"},
                   {"tether g"},
                   {"hover W"},
                   {"forward W"},
                   {"headroom"},
                   {"", TextTable::Align::left}});
  const Design& design = study.file.design;
  const Condition headroom_at = design.requirements.headroom_at;
  for (const SizePoints& size : study.sizes) {
    const AreaPoints& p = size.points;
    const OperatingPoint& judged = headroom_at == Condition::hover ? p.hover : p.forward;
    const std::string fault = shortcoming(design, p);
    table.add({size.name, significant(square_millimetres(p.area), 4),
               fixed(p.hover.tether_mass / unit::gram, 0), fixed(p.hover.total_power, 1),
               fixed(p.forward.total_power, 1), fixed(judged.headroom, 2),
               fault.empty() ? "meets every requirement" : fault});
  }
  return {"Sizes that can be bought", std::move(table)};
}

TitledTable power_table(const OptimizeStudy& study) {
  TextTable table({{"mm²"},
                   {"tether g"},
                   {"available g"},
                   {"needed g"},
                   {"headroom"},
                   {"hover W"},
                   {"forward W"},
                   {"lost %"},
                   {"", TextTable::Align::left}});
  const bool by_hover = study.file.design.requirements.headroom_at == Condition::hover;
  for (const AreaPoints& row : study.table) {
    const OperatingPoint& judged = by_hover ? row.hover : row.forward;
    table.add(
        {significant(square_millimetres(row.area), 4), fixed(row.hover.tether_mass / unit::gram, 0),
         fixed(judged.available_thrust / unit::gram_force, 0),
         fixed(judged.necessary_thrust / unit::gram_force, 0), fixed(judged.headroom, 2),
         fixed(row.hover.total_power, 1), fixed(row.forward.total_power, 1), lost_share(judged),
         mark(study, row)},
        row.area == study.result.area);
  }
  return {fmt::format("Power against cross-section (thrust per motor, headroom and loss in {})",
                      condition_words(study.file.design.requirements.headroom_at)),
          std::move(table)};
}

TitledTable operating_table(const Design& design, Condition condition,
                            std::span<const AreaPoints> areas) {
  TextTable table({{"mm²"},
                   {"ohm"},
                   {"tether g"},
                   {"tilt deg"},
                   {"avail. g"},
                   {"needed g"},
                   {"headroom"},
                   {"supply W"},
                   {"lost W"},
                   {"A"},
                   {"V"}});
  for (const AreaPoints& row : areas) {
    const OperatingPoint& p = condition == Condition::hover ? row.hover : row.forward;
    table.add({significant(square_millimetres(p.cross_section), 4),
               significant(p.tether_resistance, 4), fixed(p.tether_mass / unit::gram, 1),
               fixed(p.pitch / unit::degree, 2), fixed(p.available_thrust / unit::gram_force, 0),
               fixed(p.necessary_thrust / unit::gram_force, 0), fixed(p.headroom, 2),
               fixed(p.total_power, 1), fixed(p.tether_loss, 1), fixed(p.current, 2),
               fixed(p.received_voltage, 1)});
  }
  return {fmt::format("{} at {} m/s airspeed, thrust per motor",
                      condition == Condition::hover ? "Hover" : "Forward flight",
                      fixed(airspeed(design, condition), 2)),
          std::move(table)};
}

std::string optimize_text(const OptimizeStudy& study, const TextStyle& style) {
  std::string out = style.bold(study.file.name) + "\n\n";
  out += answer_text(study, style);
  if (!study.sizes.empty()) out += sizes_table(study).text(style);
  if (!study.table.empty()) out += power_table(study).text(style);
  const std::string notes = warnings_text(study.file, style);
  return notes.empty() ? out : out + "\n" + notes;
}

ordered_json optimize_json(const OptimizeStudy& study) {
  const Optimization& result = study.result;
  const Requirements& need = study.file.design.requirements;
  ordered_json feasible = ordered_json::array();
  for (const Interval& range : result.headroom_areas) {
    feasible.push_back(
        {square_millimetres(range.lo), number_or_null(square_millimetres(range.hi))});
  }
  ordered_json sizes = ordered_json::array();
  for (const SizePoints& size : study.sizes) {
    const std::string fault = shortcoming(study.file.design, size.points);
    sizes.push_back({{"name", size.name},
                     {"cross_section_mm2", square_millimetres(size.points.area)},
                     {"feasible", fault.empty()},
                     {"shortcoming", fault.empty() ? ordered_json(nullptr) : ordered_json(fault)},
                     {"hover", operating_point_json(size.points.hover)},
                     {"forward", operating_point_json(size.points.forward)}});
  }
  ordered_json out{
      {"name", study.file.name},
      {"status", status_name(result)},
      {"optimum", optimum_json(result)},
      {"headroom",
       {{"required", need.thrust_headroom},
        {"enforced", !need.buffer_battery},
        {"condition", condition_name(need.headroom_at)},
        {"feasible_mm2", feasible},
        {"best", number_or_null(study.best_headroom.value)},
        {"best_at_mm2", number_or_null(square_millimetres(study.best_headroom.area))}}},
      {"minimum_power",
       {{"condition", condition_name(need.power_at)},
        {"cross_section_mm2", number_or_null(square_millimetres(result.minimum_power.area))},
        {"total_power_W", number_or_null(result.minimum_power.power)}}},
      {"standard_sizes", sizes},
      {"table", table_json(study.table)}};
  const Design& design = study.file.design;
  out["voltage_class"] = voltage_class_json(design.supply.voltage);
  if (result.feasible) {
    out["thermal"] = thermal_json(design, result.hover, result.forward);
    out["cable"] = cable_json(design, result.hover, result.forward);
  }
  if (!result.feasible) {
    out["reason"] = infeasible_sentence(study.file.design, result);
    out["remedies"] = remedies_json(study.remedies);
  }
  out["warnings"] = study.file.warnings;
  return out;
}

std::string optimize_csv(const OptimizeStudy& study) {
  return csv_header() + csv_row(study.result);
}

std::string evaluate_text(const DesignFile& file, std::span<const AreaPoints> table,
                          const TextStyle& style) {
  std::string out = style.bold(file.name) + "\n";
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    out += operating_table(file.design, condition, table).text(style);
  }
  if (file.design.tether.ambient_temperature_C) {
    for (const AreaPoints& row : table) {
      out += "\n" + style.bold(area_words(row.area)) + "\n";
      for (const std::string& sentence : cable_sentences(file.design, row.hover, row.forward)) {
        out += wrapped(sentence);
      }
    }
    for (const std::string& warning : cable_warnings(file.design)) {
      out += style.subdued(wrapped("Note: " + warning));
    }
  }
  for (const AreaPoints& row : table) {
    const std::string fault = shortcoming(file.design, row);
    if (!fault.empty()) {
      out += fmt::format("\n{} does not meet the requirements: {}", area_words(row.area), fault);
    }
  }
  if (out.back() != '\n') out += "\n";
  return out + warnings_text(file, style);
}

ordered_json evaluate_json(const DesignFile& file, std::span<const AreaPoints> table) {
  ordered_json thermal = ordered_json::array();
  for (const AreaPoints& row : table) {
    thermal.push_back(thermal_json(file.design, row.hover, row.forward));
  }
  std::vector<std::string> warnings = file.warnings;
  for (std::string& warning : cable_warnings(file.design)) warnings.push_back(std::move(warning));
  return {{"name", file.name},
          {"table", table_json(table)},
          {"thermal", file.design.tether.ambient_temperature_C ? thermal : ordered_json(nullptr)},
          {"voltage_class", voltage_class_json(file.design.supply.voltage)},
          {"warnings", warnings}};
}

std::string evaluate_csv(std::span<const AreaPoints> table) {
  std::string out = "condition" + csv_keys("") + "\n";
  for (const AreaPoints& row : table) {
    out += "hover" + csv_values(row.hover) + "\n";
    out += "forward" + csv_values(row.forward) + "\n";
  }
  return out;
}

std::vector<MotorOptimum> compare_motors(const Design& design, std::vector<MotorEntry> motors) {
  std::vector<MotorOptimum> ranking;
  for (MotorEntry& motor : motors) {
    MotorOptimum entry{std::move(motor), design, {}, {}};
    entry.design.drone.motor = entry.motor.curve;
    entry.result = optimize(entry.design);
    entry.best_headroom = best_headroom(entry.design, design.requirements.headroom_at);
    ranking.push_back(std::move(entry));
  }
  const bool by_hover = design.requirements.power_at == Condition::hover;
  const auto power = [by_hover](const MotorOptimum& entry) {
    return by_hover ? entry.result.hover.total_power : entry.result.forward.total_power;
  };
  std::stable_sort(ranking.begin(), ranking.end(),
                   [&](const MotorOptimum& a, const MotorOptimum& b) {
                     if (a.result.feasible != b.result.feasible) return a.result.feasible;
                     return a.result.feasible ? power(a) < power(b)
                                              : a.best_headroom.value > b.best_headroom.value;
                   });
  return ranking;
}

TitledTable motor_table(const Design& design, std::span<const MotorOptimum> ranking) {
  TextTable table({{"motor", TextTable::Align::left},
                   {"mm²"},
                   {"tether g"},
                   {"hover W"},
                   {"forward W"},
                   {"headroom"},
                   {"limited by", TextTable::Align::left}});
  const bool by_hover = design.requirements.headroom_at == Condition::hover;
  for (const MotorOptimum& entry : ranking) {
    const Optimization& r = entry.result;
    if (!r.feasible) continue;
    table.add({entry.motor.id, significant(square_millimetres(r.area), 4),
               fixed(r.hover.tether_mass / unit::gram, 0), fixed(r.hover.total_power, 1),
               fixed(r.forward.total_power, 1), fixed((by_hover ? r.hover : r.forward).headroom, 2),
               std::string(limit_name(r.limited_by))});
  }
  return {fmt::format("Motors by power in {}, each with its own best tether",
                      condition_words(design.requirements.power_at)),
          std::move(table)};
}

std::vector<std::string> refused_motors(std::span<const MotorOptimum> ranking) {
  std::vector<std::string> refused;
  for (const MotorOptimum& entry : ranking) {
    if (entry.result.feasible) continue;
    refused.push_back(entry.motor.id + ": " + infeasible_words(entry.design, entry.result));
  }
  return refused;
}

std::string compare_text(const DesignFile& file, std::span<const MotorOptimum> ranking,
                         const TextStyle& style) {
  const TitledTable motors = motor_table(file.design, ranking);
  std::string out = style.bold(file.name) + "\n\n" + motors.title + "\n";
  out += motors.table.text(style);
  const std::vector<std::string> refused = refused_motors(ranking);
  if (!refused.empty()) out += "\n" + style.bold("Not feasible") + "\n";
  for (const std::string& motor : refused) out += "  " + motor + "\n";
  return out;
}

ordered_json compare_json(const DesignFile& file, std::span<const MotorOptimum> ranking) {
  ordered_json rows = ordered_json::array();
  for (const MotorOptimum& entry : ranking) {
    ordered_json row{{"motor", entry.motor.id},
                     {"name", entry.motor.name},
                     {"status", status_name(entry.result)},
                     {"optimum", optimum_json(entry.result)},
                     {"best_headroom", number_or_null(entry.best_headroom.value)},
                     {"reason", nullptr}};
    if (!entry.result.feasible) row["reason"] = infeasible_sentence(entry.design, entry.result);
    rows.push_back(std::move(row));
  }
  return {{"name", file.name}, {"motors", rows}};
}

std::string compare_csv(std::span<const MotorOptimum> ranking) {
  std::string out = "motor," + csv_header();
  for (const MotorOptimum& entry : ranking) {
    out += csv_text(entry.motor.id) + "," + csv_row(entry.result);
  }
  return out;
}

}  // namespace tethercalc
