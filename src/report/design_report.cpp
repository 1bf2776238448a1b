#include "tethercalc/report/design_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "io/json_document.hpp"
#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/sweep_figure.hpp"

namespace tethercalc {
namespace {

/// The values of the free fields by their paths; of named choices the name.
ordered_json free_values(const DesignStudy& study, const std::vector<double>& values) {
  ordered_json out = ordered_json::object();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SweepAxis& axis = study.problem.free[i];
    if (const auto* choices = std::get_if<NamedChoices>(&axis.values)) {
      out[axis.name] = choices->names[static_cast<std::size_t>(values[i])];
    } else {
      out[axis.name] = values[i];
    }
  }
  return out;
}

/// Ready to be flown: the spec of `file` as the best design has it.
ordered_json ready_spec(const DesignFile& file, const DesignStudy& study) {
  Design design = study.answer.best.design;
  if (std::isfinite(study.answer.best.area)) design.tether.cross_section = study.answer.best.area;
  std::map<std::string, std::string> names;
  const ordered_json values = free_values(study, study.answer.values);
  for (const auto& [path, value] : values.items()) {
    if (value.is_string()) names[path] = value.get<std::string>();
  }
  return spec_with(file, design, names);
}

std::string quantity_words(double value, const std::string& unit) {
  return significant(value, 3) + (unit.empty() || unit == "°" ? unit : " " + unit);
}

/// "1.20 V more", "0.0100 less".
std::string step_words(double step, const std::string& unit) {
  return quantity_words(std::abs(step), unit) + (step > 0 ? " more" : " less");
}

/// What a change of the objective means.
std::string effect_words(const std::string& key, double change) {
  const std::string unit = unit_of(key);
  const std::string amount = quantity_words(std::abs(change), unit);
  if (unit.empty()) return fmt::format("{} {} by {}", change > 0 ? "raise" : "lower", key, amount);
  return fmt::format("{} {}", change > 0 ? "cost" : "save", amount);
}

/// "tether.length_m at the low end of its range", with `verb` before "the".
std::string range_end_words(const ShadowPrice& price, const char* verb) {
  return fmt::format("{} {} the {} end of its range", price.name, verb,
                     price.high_end ? "high" : "low");
}

/// What binds: empty for a field that nothing holds.
std::string binding_words(const DesignStudy& study, const ShadowPrice& price) {
  switch (price.of) {
    case Priced::limit:
      return price.name + " binds";
    case Priced::range_end:
      return range_end_words(price, "is at");
    case Priced::demand:
      return demand_words(study.answer.best.design, price.demand) + " binds";
    case Priced::field:
      break;
  }
  return "";
}

/// What would cost or save.
std::string change_words(const ShadowPrice& price) {
  if (price.of != Priced::field) {
    return step_words(price.step, unit_of(price.name.substr(0, price.name.find_first_of("<>"))));
  }
  if (price.name == "tether.length_m") return "One more metre of tether";
  if (price.name == "drone.mass_g") return "100 g more on the drone";
  return "One volt more of the supply";
}

std::string price_sentence(const DesignStudy& study, const std::string& minimized,
                           const ShadowPrice& price) {
  const std::string binding = binding_words(study, price);
  if (price.price == 0) {
    return binding + ", but moving it alone would change nothing: something else binds there too.";
  }
  return fmt::format("{}{}{} would {}.", binding, price.active() ? ": " : "", change_words(price),
                     std::isfinite(price.price) ? effect_words(minimized, price.price)
                                                : "leave no design that meets every demand");
}

std::string value_text(const ordered_json& value) {
  return value.is_number() ? significant(value.get<double>(), 5) : value.get<std::string>();
}

/// "thrust headroom in hover"; a limit of the user's as it was typed.
std::string missed_name(const DemandState& missed) {
  if (missed.is_typed) return '"' + missed.name + '"';
  std::string name = missed.name;
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string missed_words(const DesignAnswer& answer) {
  std::string words;
  for (const DemandState& demand : answer.missed) {
    words += fmt::format("{}{} by {} %", words.empty() ? "" : ", ", missed_name(demand),
                         significant(100 * demand.violation, 3));
  }
  return words;
}

std::string confidence_text(const DesignStudy& study) {
  const Minimum& minimum = study.answer.minimum;
  const int all = study.answer.combinations;
  std::string text;
  if (all > 1) {
    text = fmt::format("Of {} combinations of choices a lower bound ruled out {}; ", all,
                       study.answer.pruned == 0 ? "none" : fmt::to_string(study.answer.pruned));
  }
  text += fmt::format("{} design{} evaluated.", study.answer.evaluations,
                      study.answer.evaluations == 1 ? " was" : "s were");
  if (minimum.starts == 0) return text + " Nothing was left to search: the answer is exact.";
  if (!study.answer.feasible) {
    return text + " None of them meets every demand; the search then went for the least violation.";
  }
  return text + fmt::format(" {} of {} searches{} lead to the same optimum{}.", minimum.agreeing,
                            minimum.starts, all > 1 ? " in the best combination" : "",
                            minimum.agreeing >= 2 ? "" : ": there may be a better one elsewhere");
}

}  // namespace

std::vector<Warning> design_warnings(const DesignFile& file, const DesignStudy& study) {
  const bool motor_chosen = study.problem.frees("drone.motor");
  DesignFile found = file;
  found.design = study.answer.best.design;
  if (motor_chosen) {
    found.warnings.clear();
    if (const auto percent = power_uncertainty_percent(found.design)) {
      found.warnings.push_back(
          {WarningKind::motor_estimated,
           fmt::format("the motor is an estimate, not measured: its power may be off by about {} % "
                       "either way (power_uncertainty_percent)",
                       significant(*percent, 3))});
    }
  }
  std::vector<Warning> warnings =
      all_warnings(found, only(study.answer.best), study.ground, study.side);
  if (motor_chosen) warnings.push_back(motor_mass_warning());
  return warnings;
}

std::string design_text(const DesignFile& file, const DesignRequest& request,
                        const DesignStudy& study, const TextStyle& style) {
  const DesignAnswer& answer = study.answer;
  const ordered_json values = free_values(study, answer.values);
  std::string out = style.bold(file.name) + "\n\n";
  if (!answer.feasible) {
    out += style.bad(style.bold("No design within these fields meets every demand.")) + "\n";
    out += wrapped("The one that comes closest misses " + missed_words(answer) + ":");
  } else {
    out += style.good(style.bold(fmt::format("Least {}: {}", request.minimize,
                                             significant(answer.minimum.value, 6)))) +
           "\n";
  }
  for (const auto& [path, value] : values.items()) {
    out += fmt::format("  {} = {}\n", path, value_text(value));
  }
  if (std::isfinite(answer.best.area)) {
    if (!study.problem.frees(cross_section_path)) {
      const bool held = study.problem.base.tether.cross_section.has_value();
      out += fmt::format("  cross-section {} mm²{}\n",
                         significant(answer.best.area / unit::square_millimetre, 5),
                         held ? ", held as tether.cross_section_mm2 has it" : "");
    }
    TextTable table(
        {word_column(""), "supply W", "lost W", "current A", "at drone V", "headroom", "tether g"});
    for (const auto& [name, point] :
         {std::pair{"hover", &answer.best.hover}, std::pair{"forward", &answer.best.forward}}) {
      table.add({name, fixed(point->total_power, 1), fixed(point->tether_loss, 1),
                 fixed(point->current, 2), fixed(point->received_voltage, 1),
                 fixed(point->headroom, 2), fixed(point->tether_mass / unit::gram, 1)});
    }
    out += "\n" + table.text(style) + "\n";
    for (const std::string& sentence : cable_sentences(answer.best.design, answer.best)) {
      out += wrapped(sentence);
    }
  }
  for (const Warning& warning : design_warnings(file, study)) {
    out += wrapped("Note: " + warning.sentence);
  }
  if (!study.prices.empty()) {
    out += "\n" + style.bold("What binds, and what more of it would change") + "\n";
    for (const ShadowPrice& price : study.prices) {
      out += wrapped(price_sentence(study, request.minimize, price), 96, "  ");
    }
  }
  out += "\n" + wrapped(confidence_text(study));
  if (!study.front.empty()) {
    out += "\n" + style.bold("Pareto front") + "\n";
    std::vector<TextTable::Column> columns{request.pareto[0], request.pareto[1]};
    for (const SweepAxis& axis : study.problem.free) columns.push_back(axis.name);
    TextTable table(columns);
    for (const FrontPoint& point : study.front) {
      std::vector<std::string> cells{significant(point.first, 5), significant(point.second, 5)};
      const ordered_json at_point = free_values(study, point.values);
      for (const auto& [path, value] : at_point.items()) cells.push_back(value_text(value));
      table.add(cells);
    }
    out += table.text(style);
  }
  if (answer.feasible) {
    out += "\n" + style.bold("The spec") + "\n" + json_text(ready_spec(file, study));
  }
  return out;
}

ordered_json design_json(const DesignFile& file, const DesignRequest& request,
                         const DesignStudy& study) {
  const DesignAnswer& answer = study.answer;
  const ordered_json prices = json_list(study.prices, [&](const ShadowPrice& price) {
    return ordered_json{
        {"name", price.of == Priced::range_end ? range_end_words(price, "at") : price.name},
        {"active", price.active()},
        {"step", price.step},
        {"change", number_or_null(price.price)},
        {"sentence", price_sentence(study, request.minimize, price)}};
  });
  const ordered_json front = json_list(study.front, [&](const FrontPoint& point) {
    return ordered_json{{request.pareto[0], point.first},
                        {request.pareto[1], point.second},
                        {"values", free_values(study, point.values)}};
  });
  const bool exists = std::isfinite(answer.best.area);
  ordered_json out{
      {"name", file.name},
      {"status", status_name(answer.feasible)},
      {"minimize", request.minimize},
      {"value", number_or_null(answer.feasible ? answer.minimum.value : nan)},
      {"free", free_values(study, answer.values)},
      {"cross_section_mm2", number_or_null(answer.best.area / unit::square_millimetre)},
      {"hover", exists ? operating_point_json(answer.best.hover) : ordered_json(nullptr)},
      {"forward", exists ? operating_point_json(answer.best.forward) : ordered_json(nullptr)},
      {"voltage_class", voltage_class_json(answer.best.design.supply.voltage)},
      {"thermal", thermal_json(answer.best.design, answer.best)},
      {"cable", cable_json(answer.best.design, answer.best)},
      {"prices", prices},
      {"confidence",
       {{"combinations", answer.combinations},
        {"pruned", answer.pruned},
        {"evaluations", answer.evaluations},
        {"starts", answer.minimum.starts},
        {"agreeing", answer.minimum.agreeing},
        {"sentence", confidence_text(study)}}},
      {"pareto", front},
      {"spec", answer.feasible ? ready_spec(file, study) : ordered_json(nullptr)}};
  add_estimates(out, answer.best.design);
  add_warnings(out, design_warnings(file, study));
  if (!answer.feasible) {
    out["missed"] = json_list(answer.missed, [](const DemandState& demand) {
      return ordered_json{{"demand", demand.name},
                          {"by_percent", number_or_null(100 * demand.violation)}};
    });
  }
  return out;
}

std::string design_csv(const DesignRequest& request, const DesignStudy& study) {
  ordered_json header = ordered_json::array();
  ordered_json row = ordered_json::array();
  const ordered_json values = free_values(study, study.answer.values);
  for (const auto& [path, value] : values.items()) {
    header.push_back(path);
    row.push_back(value);
  }
  header.insert(header.end(), {"feasible", request.minimize});
  row.insert(row.end(), {study.answer.feasible, study.answer.minimum.value});
  return csv_line(header) + csv_line(row);
}

}  // namespace tethercalc
