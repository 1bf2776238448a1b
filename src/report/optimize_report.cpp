#include "tethercalc/report/design_report.hpp"

#include <fmt/format.h>

#include <array>

#include "report/result_values.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

std::string area_words(double area) {
  return significant(area / unit::square_millimetre, 4) + " mm²";
}

std::string lost_share(const OperatingPoint& point) {
  return significant(100 * point.tether_loss / point.total_power, 3);
}

Answer feasible_answer(const DesignFile& file, const OptimumStudy& study) {
  const Design& design = file.design;
  const Optimization& result = study.result;
  const OperatingPoint& hover = result.hover;
  Answer out;
  out.headline =
      fmt::format("Fly {} of {}.", area_words(result.area), conductor_words(file.conductor));
  out.sentences.push_back(limit_sentence(design, result));
  out.sentences.push_back(fmt::format(
      "The tether of {} m weighs {} g and has {} ohm; the drone takes off with {} g.",
      significant(hover.tether_length, 3), fixed(hover.tether_mass / unit::gram, 1),
      significant(hover.tether_resistance, 4), fixed(hover.takeoff_mass / unit::gram, 0)));
  for (std::string& sentence : cable_sentences(design, study.result)) {
    out.sentences.push_back(std::move(sentence));
  }
  const double speed = airspeed(design, Condition::forward);
  out.sentences.push_back(
      fmt::format("It draws {} W in hover and {} W in forward flight at {} m/s ({} km/h).",
                  fixed(hover.total_power, 1), fixed(result.forward.total_power, 1),
                  fixed(speed, 2), fixed(3.6 * speed, 1)));
  if (std::string sentence = unchecked_sentence(design); !sentence.empty()) {
    out.sentences.push_back(std::move(sentence));
  }
  return out;
}

/// The field that a remedy changes, and what it is a field of; in the order of `Quantity`.
constexpr std::array<std::pair<const char*, const char*>, 4> remedied_fields{
    {{"supply.voltage_V", "a supply"},
     {"drone.mass_g", "a drone"},
     {"tether.length_m", "a tether"},
     {"flight.airspeed_m_s", "an airspeed"}}};

std::string remedy_words(const Design& design, const Remedy& remedy) {
  const auto& [path, thing] = remedied_fields.at(static_cast<std::size_t>(remedy.quantity));
  const SpecField& field = *find_field(path);
  return fmt::format("{0} of {1} {3} instead of {2} {3}", thing,
                     significant(*field_value(remedied(design, remedy), field), 3),
                     significant(*field_value(design, field), 3), field.unit);
}

Answer refused_answer(const OptimumStudy& study) {
  const Design& design = study.design;
  Answer out{"This design cannot fly as required.", {refusal_sentence(design, *study.refusal)}, {}};
  const auto& no_way = study.refusal->no_way;
  if (no_way && no_way->outcome == CableOutcome::tension_too_low) {
    out.sentences.push_back(
        "The winch has to pull harder (tether.winch_pull_N), or pay out a length of its own "
        "(tether.slack_percent).");
  }
  if (no_way && no_way->needed > 0) {
    out.sentences.push_back("There has to be more cable on the drum (tether.spooled_length_m).");
  }
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

std::string answer_text(const DesignFile& file, const OptimumStudy& study, const TextStyle& style) {
  const Answer told = answer(file, study);
  const std::string headline = style.bold(told.headline);
  std::string out = (study.result.feasible ? style.good(headline) : style.bad(headline)) + "\n";
  for (const std::string& sentence : told.sentences) out += wrapped(sentence);
  for (const std::string& remedy : told.remedies) out += "  " + remedy + "\n";
  if (study.result.feasible) out += "\n" + condition_table(study.result).table.text(style);
  return out;
}

std::string mark(const OptimumStudy& study, const AreaPoints& row) {
  const Optimization& result = study.result;
  std::string marks = shortcoming(study.design, row).empty() ? "feasible" : "";
  if (row.area == result.area) marks = "optimum";
  if (row.area == result.minimum_power.area)
    marks += marks.empty() ? "least power" : ", least power";
  return marks;
}

ordered_json table_json(std::span<const AreaPoints> table) {
  return json_list(table, [](const AreaPoints& row) {
    return ordered_json{{"hover", operating_point_json(row.hover)},
                        {"forward", operating_point_json(row.forward)}};
  });
}

ordered_json remedies_json(const OptimumStudy& study) {
  ordered_json out = ordered_json::object();
  for (const Remedy& remedy : study.remedies) {
    const char* path = remedied_fields.at(static_cast<std::size_t>(remedy.quantity)).first;
    out[path] = *field_value(remedied(study.design, remedy), *find_field(path));
  }
  return out;
}

ordered_json optimum_json(const Optimization& result) {
  return {
      {"cross_section_mm2", number_or_null(result.area / unit::square_millimetre)},
      {"limited_by", limit_name(result.limited_by)},
      {"limiting_condition", condition_name(result.limiting_condition)},
      {"hover", result.feasible ? operating_point_json(result.hover) : ordered_json(nullptr)},
      {"forward", result.feasible ? operating_point_json(result.forward) : ordered_json(nullptr)}};
}

/// Lines of CSV: the names of an optimum's results, and the results.
std::string header_csv() {
  ordered_json names =
      json_list(optimum_results({}), [](const auto& result) { return result.name; });
  for (const auto& [name, value] : estimates_of({})) names.push_back(name);
  return csv_line(names);
}

std::string results_csv(const Design& design, const Optimization& optimum) {
  ordered_json values = json_list(optimum_results(optimum),
                                  [](const auto& result) { return result_json(result.value); });
  for (const auto& [name, value] : estimates_of(design)) values.push_back(number_or_null(value));
  return csv_line(values);
}

std::string notes_text(std::span<const Warning> warnings, const TextStyle& style) {
  std::string out;
  for (const Warning& warning : warnings) {
    out += style.subdued(wrapped("Note: " + warning.sentence));
  }
  return out;
}

/// Everything about steady flight in one condition, a row an area.
TitledTable operating_table(const Design& design, Condition condition,
                            std::span<const AreaPoints> areas) {
  TextTable table({"mm²", "ohm", "tether g", "tilt deg", "avail. g", "needed g", "headroom",
                   "supply W", "lost W", "A", "V"});
  for (const AreaPoints& row : areas) {
    const OperatingPoint& p = row.in(condition);
    table.add({significant(p.cross_section / unit::square_millimetre, 4),
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

}  // namespace

Answer answer(const DesignFile& file, const OptimumStudy& study) {
  return study.result.feasible ? feasible_answer(file, study) : refused_answer(study);
}

TitledTable condition_table(const Optimization& result) {
  TextTable table({word_column(""), "supply W", "drone W", "lost W", "lost %", "current A",
                   "at drone V", "headroom", "tilt deg"});
  for (const auto& [name, point] :
       {std::pair{"hover", &result.hover}, std::pair{"forward", &result.forward}}) {
    table.add({name, fixed(point->total_power, 1), fixed(point->drone_power, 1),
               fixed(point->tether_loss, 1), lost_share(*point), fixed(point->current, 2),
               fixed(point->received_voltage, 1), fixed(point->headroom, 2),
               fixed(point->pitch / unit::degree, 1)});
  }
  return {"The optimum in flight", std::move(table)};
}

TitledTable sizes_table(const OptimumStudy& study) {
  TextTable table({word_column("size"), "mm²", "tether g", "hover W", "forward W", "headroom",
                   word_column("")});
  const Design& design = study.design;
  const Condition headroom_at = design.requirements.headroom_at;
  for (const SizePoints& size : study.sizes) {
    const AreaPoints& p = size.points;
    const std::string fault = shortcoming(design, p);
    table.add({size.name, significant(p.area / unit::square_millimetre, 4),
               fixed(p.hover.tether_mass / unit::gram, 0), fixed(p.hover.total_power, 1),
               fixed(p.forward.total_power, 1), fixed(p.in(headroom_at).headroom, 2),
               fault.empty() ? "meets every requirement" : fault});
  }
  return {"Sizes that can be bought", std::move(table)};
}

TitledTable power_table(const OptimumStudy& study) {
  TextTable table({"mm²", "tether g", "available g", "needed g", "headroom", "hover W", "forward W",
                   "lost %", word_column("")});
  const Condition headroom_at = study.design.requirements.headroom_at;
  for (const AreaPoints& row : study.table) {
    const OperatingPoint& judged = row.in(headroom_at);
    table.add({significant(row.area / unit::square_millimetre, 4),
               fixed(row.hover.tether_mass / unit::gram, 0),
               fixed(judged.available_thrust / unit::gram_force, 0),
               fixed(judged.necessary_thrust / unit::gram_force, 0), fixed(judged.headroom, 2),
               fixed(row.hover.total_power, 1), fixed(row.forward.total_power, 1),
               lost_share(judged), mark(study, row)},
              row.area == study.result.area);
  }
  return {fmt::format("Power against cross-section (thrust per motor, headroom and loss in {})",
                      condition_words(headroom_at)),
          std::move(table)};
}

std::string optimize_text(const DesignFile& file, const OptimumStudy& study,
                          const TextStyle& style) {
  std::string out = style.bold(file.name) + "\n\n";
  out += answer_text(file, study, style);
  if (!study.sizes.empty()) out += sizes_table(study).text(style);
  if (!study.table.empty()) out += power_table(study).text(style);
  const std::string notes = notes_text(optimum_warnings(file, study), style);
  return notes.empty() ? out : out + "\n" + notes;
}

ordered_json optimize_json(const DesignFile& file, const OptimumStudy& study) {
  const Optimization& result = study.result;
  const Design& design = study.design;
  const Requirements& need = design.requirements;
  const ordered_json feasible = json_list(result.headroom_areas, [](const Interval& range) {
    return ordered_json{range.lo / unit::square_millimetre,
                        number_or_null(range.hi / unit::square_millimetre)};
  });
  const ordered_json sizes = json_list(study.sizes, [&](const SizePoints& size) {
    ordered_json entry{{"name", size.name},
                       {"cross_section_mm2", size.points.area / unit::square_millimetre}};
    entry.update(verdict_json(design, size.points));
    entry["hover"] = operating_point_json(size.points.hover);
    entry["forward"] = operating_point_json(size.points.forward);
    return entry;
  });
  ordered_json out{
      {"name", file.name},
      {"status", status_name(result.feasible)},
      {"optimum", optimum_json(result)},
      {"headroom",
       {{"required", need.thrust_headroom},
        {"enforced", !need.buffer_battery},
        {"condition", condition_name(need.headroom_at)},
        {"feasible_mm2", feasible},
        {"best", number_or_null(study.best_headroom.value)},
        {"best_at_mm2", number_or_null(study.best_headroom.area / unit::square_millimetre)}}},
      {"minimum_power",
       {{"condition", condition_name(need.power_at)},
        {"cross_section_mm2", number_or_null(result.minimum_power.area / unit::square_millimetre)},
        {"total_power_W", number_or_null(result.minimum_power.power)}}},
      {"standard_sizes", sizes},
      {"table", table_json(study.table)}};
  out["voltage_class"] = voltage_class_json(design.supply.voltage);
  if (result.feasible) {
    out["thermal"] = thermal_json(design, study.result);
    out["cable"] = cable_json(design, study.result);
  } else {
    out["reason"] = refusal_sentence(design, *study.refusal);
    out["remedies"] = remedies_json(study);
  }
  add_estimates(out, design);
  add_warnings(out, optimum_warnings(file, study));
  return out;
}

std::string optimize_csv(const OptimumStudy& study) {
  return header_csv() + results_csv(study.design, study.result);
}

std::string evaluate_text(const DesignFile& file, const EvaluationStudy& study,
                          const TextStyle& style) {
  std::string out = style.bold(file.name) + "\n";
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    out += operating_table(file.design, condition, study.table).text(style);
  }
  const Tether& tether = file.design.tether;
  if (tether.ambient_temperature_C || tether.model == TetherModel::solved) {
    for (const AreaPoints& row : study.table) {
      out += "\n" + style.bold(area_words(row.area)) + "\n";
      for (const std::string& sentence : cable_sentences(file.design, row)) {
        out += wrapped(sentence);
      }
    }
  }
  for (const AreaPoints& row : study.table) {
    const std::string fault = shortcoming(file.design, row);
    out +=
        "\n" + area_words(row.area) +
        (fault.empty() ? " meets every requirement" : " does not meet the requirements: " + fault);
  }
  out += "\n";
  const std::string unchecked = unchecked_sentence(file.design);
  if (!unchecked.empty()) out += wrapped(unchecked);
  return out + notes_text(evaluation_warnings(file, study), style);
}

ordered_json evaluate_json(const DesignFile& file, const EvaluationStudy& study) {
  const ordered_json as_given =
      json_list(study.table, [&](const AreaPoints& row) { return verdict_json(file.design, row); });
  const ordered_json thermal =
      json_list(study.table, [&](const AreaPoints& row) { return thermal_json(file.design, row); });
  const ordered_json cables =
      json_list(study.table, [&](const AreaPoints& row) { return cable_json(file.design, row); });
  ordered_json out{
      {"name", file.name},
      {"table", table_json(study.table)},
      {"as_given", as_given},
      {"thermal", file.design.tether.ambient_temperature_C ? thermal : ordered_json(nullptr)},
      {"cable", cables},
      {"voltage_class", voltage_class_json(file.design.supply.voltage)}};
  add_estimates(out, file.design);
  add_warnings(out, evaluation_warnings(file, study));
  return out;
}

std::string evaluate_csv(const Design& design, std::span<const AreaPoints> table) {
  std::string out = "condition";
  for (const OperatingPointField& field : operating_point_fields())
    out.append(",").append(field.key);
  out += ",feasible,shortcoming";
  for (const AreaPoints& row : table) {
    const std::string fault = shortcoming(design, row);
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      out.append("\n").append(condition_name(condition));
      for (const OperatingPointField& field : operating_point_fields()) {
        out += "," + csv_number(practical_value(row.in(condition), field));
      }
      out += (fault.empty() ? ",true," : ",false,") + csv_text(fault);
    }
  }
  return out + "\n";
}

TitledTable motor_table(const Design& design, std::span<const MotorOptimum> ranking) {
  TextTable table({word_column("motor"), "mm²", "tether g", "hover W", "forward W", "headroom",
                   word_column("limited by")});
  for (const MotorOptimum& entry : ranking) {
    const Optimization& r = entry.result;
    if (!r.feasible) continue;
    table.add({entry.motor.id, significant(r.area / unit::square_millimetre, 4),
               fixed(r.hover.tether_mass / unit::gram, 0), fixed(r.hover.total_power, 1),
               fixed(r.forward.total_power, 1),
               fixed(entry.result.in(design.requirements.headroom_at).headroom, 2),
               limit_in_short(r.limited_by)});
  }
  return {fmt::format("Motors by power in {}, each with its own best tether",
                      condition_words(design.requirements.power_at)),
          std::move(table)};
}

std::vector<std::string> refused_motors(std::span<const MotorOptimum> ranking) {
  std::vector<std::string> refused;
  for (const MotorOptimum& entry : ranking) {
    if (entry.result.feasible) continue;
    refused.push_back(entry.motor.id + ": " + refusal_words(entry.design, *entry.refusal));
  }
  return refused;
}

namespace {

/// What holds of all motors of a comparison, or of some for the same reason.
std::vector<Warning> comparison_warnings(const DesignFile& file,
                                         std::span<const MotorOptimum> ranking) {
  std::vector<Warning> warnings{motor_mass_warning()};
  std::vector<AreaPoints> flown;
  for (const MotorOptimum& entry : ranking) {
    if (entry.result.feasible) flown.push_back(entry.result);
  }
  if (auto drag = drag_estimate_warning(file.design)) warnings.push_back(std::move(*drag));
  for (const MotorOptimum& entry : ranking) {
    if (auto density = density_warning(entry.design)) {
      warnings.push_back(std::move(*density));
      break;
    }
  }
  for (Warning& warning : cable_warnings(file.design, flown)) {
    warnings.push_back(std::move(warning));
  }
  const auto on_ground = std::ranges::find_if(
      ranking, [](const MotorOptimum& entry) { return entry.ground.has_value(); });
  if (on_ground != ranking.end()) warnings.push_back(ground_warning(*on_ground->ground));
  const auto aside = std::ranges::find_if(
      ranking, [](const MotorOptimum& entry) { return entry.side.has_value(); });
  if (aside != ranking.end()) warnings.push_back(side_warning(*aside->side));
  return warnings;
}

}  // namespace

std::string compare_text(const DesignFile& file, std::span<const MotorOptimum> ranking,
                         const TextStyle& style) {
  const TitledTable motors = motor_table(file.design, ranking);
  std::string out = style.bold(file.name) + "\n\n" + motors.title + "\n";
  out += motors.table.text(style);
  const std::vector<std::string> refused = refused_motors(ranking);
  if (!refused.empty()) out += "\n" + style.bold("Not feasible") + "\n";
  for (const std::string& motor : refused) out += "  " + motor + "\n";
  std::string notes;
  const auto add = [&](std::span<const Warning> warnings) {
    for (const Warning& warning : warnings) notes += wrapped(warning.sentence, 96, "  ");
  };
  add(comparison_warnings(file, ranking));
  for (const MotorOptimum& entry : ranking) add(entry.motor.warnings);
  return out + "\n" + style.bold("Notes") + "\n" + notes;
}

ordered_json compare_json(const DesignFile& file, std::span<const MotorOptimum> ranking) {
  const ordered_json rows = json_list(ranking, [](const MotorOptimum& entry) {
    ordered_json row{
        {"motor", entry.motor.id},
        {"name", entry.motor.name},
        {"status", status_name(entry.result.feasible)},
        {"optimum", optimum_json(entry.result)},
        {"best_headroom", number_or_null(entry.best_headroom.value)},
        {"reason", entry.refusal ? ordered_json(refusal_sentence(entry.design, *entry.refusal))
                                 : ordered_json(nullptr)}};
    add_estimates(row, entry.design);
    add_warnings(row, entry.motor.warnings);
    return row;
  });
  ordered_json out{{"name", file.name}, {"motors", rows}};
  add_warnings(out, comparison_warnings(file, ranking));
  return out;
}

std::string compare_csv(std::span<const MotorOptimum> ranking) {
  std::string out = "motor," + header_csv();
  for (const MotorOptimum& entry : ranking) {
    out += csv_text(entry.motor.id) + "," + results_csv(entry.design, entry.result);
  }
  return out;
}

}  // namespace tethercalc
