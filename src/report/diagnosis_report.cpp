#include "tethercalc/report/diagnosis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/json_document.hpp"
#include "report/result_values.hpp"
#include "tethercalc/diagnose/catalogue.hpp"

namespace tethercalc {

namespace {

/// With the number of the flight, where it belongs to one of several.
ordered_json of_flight(ordered_json told, std::size_t flight) {
  if (flight > 0) told["flight"] = flight;
  return told;
}

ordered_json parameters_json(const std::vector<ParameterEstimate>& parameters) {
  return json_list(parameters, [](const ParameterEstimate& p) {
    return of_flight({{"name", p.name},
                      {"value", number_or_null(p.value)},
                      {"unit", p.unit},
                      {"ci95", {number_or_null(p.ci95_lower), number_or_null(p.ci95_upper)}}},
                     p.flight);
  });
}

ordered_json finding_json(const Finding& f) {
  return of_flight({{"effect", f.effect},
                    {"title", f.title},
                    {"mechanism", f.mechanism},
                    {"stage", f.stage},
                    {"parameters", parameters_json(f.parameters)},
                    {"holdout_rmse_before", number_or_null(f.holdout_rmse_before)},
                    {"holdout_rmse_after", number_or_null(f.holdout_rmse_after)},
                    {"gain_percent", number_or_null(f.gain_percent)},
                    {"gain_se_percent", number_or_null(f.gain_se_percent)},
                    {"indistinguishable_from", f.indistinguishable_from},
                    {"to_separate", f.to_separate}},
                   f.flight);
}

/// What has no name as an effect of one's own, ready to be given one; null where it has no formula.
ordered_json unnamed_effect(const Unexplained& u, LogKind kind) {
  if (!u.detected || u.formula.empty()) return nullptr;
  const double size = std::abs(u.coefficient);
  const auto rounded = [](double value) { return std::stod(significant(value, 2)); };
  return {{"id", "unnamed"},
          {"title", "Follows " + u.regressor},
          {"mechanism", "Not known yet."},
          {kind == LogKind::power ? "power_W" : "force_N", u.formula},
          {"parameters",
           {{{"name", "c"},
             {"lower", rounded(-10 * size)},
             {"upper", rounded(10 * size)},
             {"scale", rounded(size / 10)}}}}};
}

ordered_json before_after(const BeforeAfter& pair) {
  return ordered_json::array({number_or_null(pair.before), number_or_null(pair.after)});
}

/// Value and uncertainty, with as many digits as two of the interval's half width.
std::string with_interval(const ParameterEstimate& p) {
  const double half_width = (p.ci95_upper - p.ci95_lower) / 2;
  int decimals = 2 - static_cast<int>(std::floor(std::log10(std::abs(p.value) + 1e-300))) + 1;
  if (half_width > 0 && std::isfinite(half_width)) {
    decimals = 1 - static_cast<int>(std::floor(std::log10(half_width)));
  }
  decimals = std::clamp(decimals, 0, 9);
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  const std::string value = fmt::format("{} = {}{}", p.name, fixed(p.value, decimals), unit);
  // Only a bound holds a size alike in all blocks.
  if (half_width == 0) return value + " (the end of its range)";
  return fmt::format("{} (95 %: {} to {})", value, fixed(p.ci95_lower, decimals),
                     fixed(p.ci95_upper, decimals));
}

/// An effect by its id, with the flight where it belongs to one of several.
template <typename Told>
std::string id_of(const Told& told) {
  return told.flight > 0 ? fmt::format("{} (flight {})", told.effect, told.flight) : told.effect;
}

/// The same in words.
template <typename Told>
std::string name_of(const Told& told) {
  return in_words(id_of(told));
}

/// An effect in words, with the flight where it belongs to one of several.
template <typename Told>
std::string title_of(const Told& told) {
  return told.flight > 0 ? fmt::format("{} in flight {}", told.title, told.flight) : told.title;
}

/// `title` without the capital of a sentence; that of an abbreviation or a single letter stays.
std::string within_sentence(std::string title) {
  const auto in = [&](std::size_t i, char first, char last) {
    return i < title.size() && first <= title[i] && title[i] <= last;
  };
  if (in(0, 'A', 'Z') && (in(1, 'a', 'z') || title.starts_with("A "))) title[0] += 'a' - 'A';
  return title;
}

constexpr const char* impact_heading = "What it does to the design";

std::string impact_sentence(const DesignImpact& impact) {
  const auto move = [](const BeforeAfter& pair, const char* unit, int decimals) {
    const std::string before = fixed(*pair.before, decimals) + " " + unit;
    const std::string after = fixed(*pair.after, decimals) + " " + unit;
    return before == after ? "stays at " + before : "moves from " + before + " to " + after;
  };
  const BeforeAfter& area = impact.cross_section_mm2;
  if (!area.before && !area.after) {
    return "No cross-section meets the requirements, neither before nor after.";
  }
  if (!area.after) {
    return fmt::format(
        "The optimum cross-section of {} mm² is lost: with the findings no "
        "cross-section meets the requirements any more.",
        fixed(*area.before, 3));
  }
  if (!area.before) {
    return fmt::format(
        "By the spec no cross-section meets the requirements; with the findings "
        "{} mm² does, at {} W.",
        fixed(*area.after, 3), fixed(impact.total_power_W.after.value_or(0), 1));
  }
  return fmt::format("The optimum cross-section {}, the power there {}.", move(area, "mm²", 3),
                     move(impact.total_power_W, "W", 1));
}

class Story {
 public:
  Story(const Diagnosis& diagnosis, const TextStyle& style) : d_(diagnosis), style_(style) {}

  std::vector<StoryPart> tell() {
    if (std::isfinite(d_.base.holdout_rmse)) {
      open();
      errors();
      budget();
      for (const Finding& f : d_.findings) finding(f);
      suspected();
      unexplained();
      design();
      ruled_out();
    } else {
      paragraph(fmt::format("This {} log is too short to judge anything by.", to_string(d_.kind)));
    }
    not_tested();
    notes();
    return std::move(out_);
  }

 private:
  void paragraph(std::string text) { out_.emplace_back(std::move(text)); }
  void heading(std::string text) { out_.emplace_back(StoryHeading{std::move(text)}); }

  void open() {
    std::string text;
    if (d_.findings.empty()) {
      text =
          fmt::format("Nothing of the catalogue explains this {} log better than the base model.",
                      to_string(d_.kind));
    } else {
      const double gain =
          100 * (1 - d_.extended.holdout_rmse / std::max(d_.base.holdout_rmse, 1e-300));
      std::vector<std::string> titles;
      for (const Finding& f : d_.findings) {
        titles.push_back(within_sentence(title_of(f)));
        if (f.indistinguishable_from.empty()) continue;
        titles.back() += fmt::format(
            " (or {})", in_words(fmt::format("{}", fmt::join(f.indistinguishable_from, " or "))));
      }
      const std::string found = fmt::format("Found: {}.", fmt::join(titles, "; "));
      text = fmt::format("{} That explains {:.0f} % of the error of this {} log.",
                         style_.good(found), gain, to_string(d_.kind));
    }
    paragraph(fmt::format("{} It has {} samples, worth {:.0f} independent ones.", text, d_.samples,
                          d_.effective_samples));
  }

  /// Rms in the units of the instruments.
  void errors() {
    const bool found = !d_.findings.empty();
    std::vector<TextTable::Column> columns{word_column("quantity"), "base model"};
    if (found) columns.push_back("with findings");
    TextTable table(columns);
    const auto row = [&](const std::string& quantity, const std::string& unit, double base,
                         double extended) {
      table.add({quantity, significant(base, 3) + " " + unit,
                 found ? significant(extended, 3) + " " + unit : ""});
    };
    if (d_.kind == LogKind::flight) {
      row(d_.quantity, d_.unit, d_.base.holdout_rmse, d_.extended.holdout_rmse);
    }
    for (const HoldoutComparison& c : d_.further) {
      row(c.quantity, c.unit, c.base_rmse, c.extended_rmse);
    }
    out_.emplace_back(
        TitledTable{"Measured against predicted (rms, on parts of the log that were not fitted)",
                    std::move(table)});
    for (const HoldoutComparison& c : d_.further) {
      const bool shows = significant(c.extended_rmse, 3) != significant(c.base_rmse, 3);
      if (!found || !shows || c.extended_rmse < c.base_rmse) continue;
      paragraph(fmt::format(
          "The findings were chosen by the {}. They predict the {} worse: do not rely on them for "
          "that.",
          d_.quantity, c.quantity));
    }
  }

  void budget() {
    if (d_.budget.findings.size() != d_.findings.size() || d_.budget.noise <= 0) return;
    TextTable table({word_column("source"), word_column("stage"), "share"});
    for (std::size_t k = 0; k < d_.findings.size(); ++k) {
      table.add(
          {name_of(d_.findings[k]), d_.findings[k].stage, fixed(d_.budget.findings[k], 1) + " %"});
    }
    table.add({"unexplained", "", fixed(d_.budget.unexplained, 1) + " %"});
    table.add({rest_words(d_.unexplained), "", fixed(d_.budget.noise, 1) + " %"});
    out_.emplace_back(TitledTable{"Where the squared error comes from", std::move(table)});
  }

  void finding(const Finding& f) {
    heading(fmt::format("{} ({}, {})", title_of(f), f.effect, f.stage));
    std::vector<std::string> values;
    for (const ParameterEstimate& p : f.parameters) values.push_back(with_interval(p));
    std::string text = fmt::format(
        "{} With {} the held-out error falls from {} to {} {}, by {:.1f} ± {:.1f} %.", f.mechanism,
        fmt::join(values, ", "), significant(f.holdout_rmse_before, 3),
        significant(f.holdout_rmse_after, 3), d_.unit, f.gain_percent, f.gain_se_percent);
    if (!f.indistinguishable_from.empty()) {
      text += fmt::format(" This log is explained as well by {}. To tell them apart: {}",
                          in_words(fmt::format("{}", fmt::join(f.indistinguishable_from, " or "))),
                          with_stop(f.to_separate));
    }
    paragraph(text);
  }

  void suspected() {
    if (d_.suspected.empty()) return;
    heading("Suspected");
    for (const Suspected& s : d_.suspected) {
      std::vector<std::string> values;
      for (const ParameterEstimate& p : s.parameters) values.push_back(with_interval(p));
      std::string text =
          fmt::format("{} ({}) would help by {:.1f} ± {:.1f} %, with {}. What is missing: {}",
                      title_of(s), s.effect, s.gain_percent, s.gain_se_percent,
                      fmt::join(values, ", "), with_stop(s.missing));
      values.clear();
      for (const ParameterEstimate& p : s.findings_with_it) values.push_back(with_interval(p));
      if (!values.empty()) text += fmt::format(" Were it at work, {}.", fmt::join(values, ", "));
      paragraph(text);
    }
  }

  void ruled_out() {
    if (d_.ruled_out.empty()) return;
    TextTable table({word_column("effect"), word_column("parameter"), "off neutral by more than"});
    for (const RuledOut& r : d_.ruled_out) {
      table.add(
          {name_of(r), r.parameter, significant(r.bound, 2) + (r.unit == "1" ? "" : " " + r.unit)});
    }
    out_.emplace_back(TitledTable{
        "Ruled out, each by itself: what this log would have shown (95 %)", std::move(table)});
  }

  void unexplained() {
    heading("What is left");
    if (!d_.unexplained.detected) {
      paragraph(d_.unexplained.would_have_shown()
                    ? fmt::format("No structure against any channel or time: what is left looks "
                                  "like noise{}.",
                                  d_.suspected.empty() ? "" : ", but for what is suspected")
                    : fmt::format("No structure against any channel or time was found. What makes "
                                  "up less than {:.0f} % of the squared error left would not have "
                                  "shown in a log this short, so it is not said to be noise.",
                                  d_.unexplained.undetectable_percent));
      return;
    }
    const Unexplained& u = d_.unexplained;
    paragraph(
        fmt::format("{} {:.0f} % of the squared error left ({} {}) is no noise but follows "
                    "{}: {}",
                    style_.bad("Unnamed structure:"), u.share_percent, significant(u.size, 2),
                    u.size_unit, fmt::join(u.channels, ", "), with_stop(u.shape)));
    const ordered_json effect = unnamed_effect(u, d_.kind);
    if (effect.is_null()) return;
    paragraph("As a file for --effects, to be given a name and tried again:");
    out_.emplace_back(StoryLines{json_text(effect)});
  }

  void design() {
    if (!d_.design_impact) return;
    heading(impact_heading);
    paragraph(impact_sentence(*d_.design_impact));
  }

  void not_tested() {
    if (!d_.not_testable.empty()) {
      heading("What this log could not test");
      // Effects that lack the same go into one line.
      std::vector<std::pair<std::string, std::vector<std::string>>> lacking;
      for (const NotTestable& n : d_.not_testable) {
        const auto same = std::find_if(lacking.begin(), lacking.end(),
                                       [&n](const auto& entry) { return entry.first == n.needs; });
        (same == lacking.end() ? lacking.emplace_back(n.needs, 0) : *same)
            .second.push_back(name_of(n));
      }
      for (const auto& [needs, effects] : lacking) {
        paragraph(fmt::format("{}: needs {}", fmt::join(effects, ", "), with_stop(needs)));
      }
    }
    if (!d_.not_identifiable.empty()) {
      heading("What this log can never show");
      for (const NotIdentifiable& n : d_.not_identifiable) {
        paragraph(fmt::format("{}: {}", name_of(n), with_stop(n.because)));
      }
    }
  }

  void notes() {
    if (d_.notes.empty()) return;
    heading("Notes");
    for (const Warning& note : d_.notes) paragraph(with_stop(note.sentence));
  }

  const Diagnosis& d_;
  const TextStyle& style_;
  std::vector<StoryPart> out_;
};

}  // namespace

std::span<const std::string_view> verdict_names() {
  static constexpr std::array<std::string_view, 7> names{
      "findings",         "suspected",  "indistinguishable_from", "ruled_out", "not_testable",
      "not_identifiable", "unexplained"};
  return names;
}

ordered_json diagnosis_json(const Diagnosis& d, const ordered_json& extended) {
  ordered_json out{{"kind", to_string(d.kind)},
                   {"samples", d.samples},
                   {"effective_samples", number_or_null(d.effective_samples)},
                   {"quantity", d.quantity},
                   {"base",
                    {{"holdout_rmse", number_or_null(d.base.holdout_rmse)},
                     {"unit", d.unit},
                     {"parameters", parameters_json(d.base.parameters)}}}};
  out["findings"] = json_list(d.findings, finding_json);
  out["suspected"] = json_list(d.suspected, [](const Suspected& x) {
    return of_flight({{"effect", x.effect},
                      {"gain_percent", number_or_null(x.gain_percent)},
                      {"gain_se_percent", number_or_null(x.gain_se_percent)},
                      {"parameters", parameters_json(x.parameters)},
                      {"missing", x.missing},
                      {"findings_with_it", parameters_json(x.findings_with_it)}},
                     x.flight);
  });
  out["ruled_out"] = json_list(d.ruled_out, [](const RuledOut& r) {
    return of_flight({{"effect", r.effect},
                      {"parameter", r.parameter},
                      {"bound", number_or_null(r.bound)},
                      {"unit", r.unit}},
                     r.flight);
  });
  out["not_testable"] = json_list(d.not_testable, [](const NotTestable& n) {
    return of_flight({{"effect", n.effect}, {"needs", n.needs}}, n.flight);
  });
  out["not_identifiable"] = json_list(d.not_identifiable, [](const NotIdentifiable& n) {
    return of_flight({{"effect", n.effect}, {"because", n.because}}, n.flight);
  });
  out["unexplained"] = {{"detected", d.unexplained.detected},
                        {"channels", d.unexplained.channels},
                        {"share_percent", number_or_null(d.unexplained.share_percent)},
                        {"undetectable_percent", d.unexplained.undetectable_percent},
                        {"size", number_or_null(d.unexplained.size)},
                        {"size_unit", d.unexplained.size_unit},
                        {"shape", d.unexplained.shape},
                        {"regressor", d.unexplained.regressor},
                        {"effect", unnamed_effect(d.unexplained, d.kind)}};
  out["extended"] = {{"holdout_rmse", number_or_null(d.extended.holdout_rmse)},
                     {"parameters", parameters_json(d.extended.parameters)},
                     {"spec", extended}};
  out["error_budget_percent"] = {{"findings", d.budget.findings},
                                 {"unexplained", d.budget.unexplained},
                                 {"noise", d.budget.noise}};
  out["further"] = json_list(d.further, [](const HoldoutComparison& c) {
    return ordered_json{{"quantity", c.quantity},
                        {"unit", c.unit},
                        {"base_rmse", number_or_null(c.base_rmse)},
                        {"extended_rmse", number_or_null(c.extended_rmse)},
                        {"base_mean_ratio", number_or_null(c.base_mean_ratio)},
                        {"extended_mean_ratio", number_or_null(c.extended_mean_ratio)}};
  });
  add_notes(out, d.notes);
  out["design_impact"] = nullptr;
  if (d.design_impact) {
    out["design_impact"] = {{"cross_section_mm2", before_after(d.design_impact->cross_section_mm2)},
                            {"total_power_W", before_after(d.design_impact->total_power_W)}};
  }
  return out;
}

std::string rest_words(const Unexplained& unexplained) {
  return unexplained.detected || unexplained.would_have_shown() ? "noise" : "noise or not";
}

std::string impact_headline(const DesignImpact& impact) {
  const BeforeAfter& area = impact.cross_section_mm2;
  const BeforeAfter& power = impact.total_power_W;
  if (!area.after) {
    return area.before ? "By what the logs show, no cross-section meets the requirements any more."
                       : "";
  }
  const auto shown = [](const BeforeAfter& pair, bool after, int decimals) {
    return fixed((after ? pair.after : pair.before).value_or(0), decimals);
  };
  const bool moves = !area.before || shown(area, true, 3) != shown(area, false, 3) ||
                     shown(power, true, 1) != shown(power, false, 1);
  if (!moves) return "";
  return fmt::format("By what the logs show: fly {} mm², at {} W.", shown(area, true, 3),
                     shown(power, true, 1));
}

std::vector<StoryPart> diagnosis_story(const Diagnosis& diagnosis, const TextStyle& style) {
  return Story(diagnosis, style).tell();
}

std::string diagnosis_text(const Diagnosis& diagnosis, const TextStyle& style) {
  std::string out;
  for (const StoryPart& part : diagnosis_story(diagnosis, style)) {
    if (const auto* heading = std::get_if<StoryHeading>(&part)) {
      out += "\n" + style.bold(heading->text) + "\n";
    } else if (const auto* table = std::get_if<TitledTable>(&part)) {
      out += table->text(style);
    } else if (const auto* lines = std::get_if<StoryLines>(&part)) {
      out += lines->text;
    } else {
      out += wrapped(std::get<std::string>(part));
    }
  }
  return out;
}

ordered_json joint_diagnosis_json(const Diagnosis& flight, const Diagnosis& power,
                                  const ordered_json& extended) {
  ordered_json out{{"kind", "flight and power"}};
  const ordered_json parts[] = {diagnosis_json(flight, nullptr), diagnosis_json(power, nullptr)};
  for (const char* list :
       {"findings", "suspected", "ruled_out", "not_testable", "not_identifiable"}) {
    out[list] = ordered_json::array();
    for (const ordered_json& part : parts) {
      for (const ordered_json& entry : part[list]) out[list].push_back(entry);
    }
  }
  std::vector<std::string> channels = flight.unexplained.channels;
  channels.insert(channels.end(), power.unexplained.channels.begin(),
                  power.unexplained.channels.end());
  out["unexplained"] = {{"detected", flight.unexplained.detected || power.unexplained.detected},
                        {"channels", channels}};
  out["extended"] = {{"spec", extended}};
  out["design_impact"] = parts[1]["design_impact"];
  out["flight"] = parts[0];
  out["power"] = parts[1];
  for (const char* log : {"flight", "power"}) {
    out[log].erase("design_impact");
    out[log]["extended"].erase("spec");
  }
  return out;
}

std::string joint_diagnosis_text(Diagnosis flight, Diagnosis power, const TextStyle& style) {
  std::string out;
  const std::optional<DesignImpact> impact = std::exchange(power.design_impact, std::nullopt);
  flight.design_impact.reset();
  out += style.bold("THE FLIGHT LOG") + "\n" + diagnosis_text(flight, style);
  const char* second =
      power.drag_by_tilt ? "THE POWER, WITH THE TILT OF THE SAME FLIGHT" : "THE POWER LOG";
  out += "\n" + style.bold(second) + "\n" + diagnosis_text(power, style);
  if (impact) {
    out += "\n" + style.bold(impact_heading) + ", both logs together\n" +
           wrapped(impact_sentence(*impact));
  }
  return out;
}

std::string diagnosis_csv(const std::vector<Finding>& findings) {
  std::string out =
      "effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent\n";
  for (const Finding& f : findings) {
    for (const ParameterEstimate& p : f.parameters) {
      out += csv_line({id_of(f), f.stage, p.name, p.value, p.unit, p.ci95_lower, p.ci95_upper,
                       f.gain_percent, f.gain_se_percent});
    }
  }
  return out;
}

}  // namespace tethercalc
