#include "tethercalc/report/diagnosis_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "tethercalc/report/csv_cell.hpp"
#include "tethercalc/report/json_results.hpp"

namespace tethercalc {

using nlohmann::ordered_json;

namespace {

ordered_json parameters_json(const std::vector<ParameterEstimate>& parameters) {
  ordered_json out = ordered_json::array();
  for (const ParameterEstimate& p : parameters) {
    out.push_back({{"name", p.name},
                   {"value", number_or_null(p.value)},
                   {"unit", p.unit},
                   {"ci95", {number_or_null(p.ci95_lower), number_or_null(p.ci95_upper)}}});
  }
  return out;
}

ordered_json finding_json(const Finding& f) {
  return {{"effect", f.effect},
          {"title", f.title},
          {"mechanism", f.mechanism},
          {"stage", f.stage},
          {"parameters", parameters_json(f.parameters)},
          {"holdout_rmse_before", number_or_null(f.holdout_rmse_before)},
          {"holdout_rmse_after", number_or_null(f.holdout_rmse_after)},
          {"gain_percent", number_or_null(f.gain_percent)},
          {"gain_se_percent", number_or_null(f.gain_se_percent)},
          {"indistinguishable_from", f.indistinguishable_from},
          {"to_separate", f.to_separate}};
}

ordered_json before_after(const BeforeAfter& pair) {
  const auto number = [](const std::optional<double>& value) {
    return value ? number_or_null(*value) : ordered_json(nullptr);
  };
  return ordered_json::array({number(pair.before), number(pair.after)});
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  return fmt::format("{}", fmt::join(words, between));
}

/// Value and uncertainty with as many digits as the uncertainty deserves.
std::string with_interval(const ParameterEstimate& p) {
  const std::string name_unit = p.unit == "1" ? "" : " " + p.unit;
  return fmt::format("{} = {}{} (95 %: {} to {})", p.name, significant(p.value, 3), name_unit,
                     significant(p.ci95_lower, 3), significant(p.ci95_upper, 3));
}

class Story {
 public:
  Story(const Diagnosis& diagnosis, const TextStyle& style) : d_(diagnosis), style_(style) {}

  std::vector<StoryPart> tell() {
    if (std::isfinite(d_.base.holdout_rmse)) {
      open();
      budget();
      for (const Finding& f : d_.findings) finding(f);
      unexplained();
      design();
    }
    not_tested();
    notes();
    return std::move(out_);
  }

 private:
  void paragraph(std::string text) { out_.emplace_back(std::move(text)); }
  void heading(std::string text) { out_.emplace_back(StoryHeading{std::move(text)}); }

  void open() {
    const double gain =
        100 * (1 - d_.extended.holdout_rmse / std::max(d_.base.holdout_rmse, 1e-300));
    if (d_.findings.empty()) {
      paragraph(
          fmt::format("Nothing of the catalogue explains the {} of this log better than the "
                      "base model: it is predicted to {} {} (rms, held out).",
                      d_.quantity, significant(d_.base.holdout_rmse, 3), d_.unit));
    } else {
      std::vector<std::string> names;
      for (const Finding& f : d_.findings) names.push_back(f.effect);
      paragraph(
          fmt::format("{} explain{} {:.0f} % of the error: predicted and measured {} differ by "
                      "{} {} instead of {} {} (rms, on parts of the log that were not fitted).",
                      style_.good(joined(names, ", ")), names.size() == 1 ? "s" : "", gain,
                      d_.quantity, significant(d_.extended.holdout_rmse, 3), d_.unit,
                      significant(d_.base.holdout_rmse, 3), d_.unit));
    }
    paragraph(fmt::format("{} samples, worth {:.0f} independent ones.", d_.samples,
                          d_.effective_samples));
    for (const HoldoutComparison& c : d_.further) {
      paragraph(fmt::format("Beside it, {}: off by {} {} instead of {} {}.", c.quantity,
                            significant(c.extended_rmse, 3), c.unit, significant(c.base_rmse, 3),
                            c.unit));
    }
  }

  void budget() {
    if (d_.budget.findings.size() != d_.findings.size() || d_.budget.noise <= 0) return;
    TextTable table(
        {{"source", TextTable::Align::left}, {"stage", TextTable::Align::left}, {"share"}});
    for (std::size_t k = 0; k < d_.findings.size(); ++k) {
      table.add({d_.findings[k].effect, d_.findings[k].stage,
                 fmt::format("{:.1f} %", d_.budget.findings[k])});
    }
    table.add({"unexplained", "", fmt::format("{:.1f} %", d_.budget.unexplained)});
    table.add({"noise", "", fmt::format("{:.1f} %", d_.budget.noise)});
    out_.emplace_back(TitledTable{"Where the squared error comes from", std::move(table)});
  }

  void finding(const Finding& f) {
    heading(f.title + " (" + f.effect + ", " + f.stage + ")");
    paragraph(f.mechanism);
    std::vector<std::string> values;
    for (const ParameterEstimate& p : f.parameters) values.push_back(with_interval(p));
    paragraph(fmt::format("With {} the held-out error falls from {} to {} {}: {:.1f} ± {:.1f} %.",
                          joined(values, ", "), significant(f.holdout_rmse_before, 3),
                          significant(f.holdout_rmse_after, 3), d_.unit, f.gain_percent,
                          f.gain_se_percent));
    if (!f.indistinguishable_from.empty()) {
      paragraph(fmt::format("This log is explained as well by {}. To tell them apart: {}.",
                            joined(f.indistinguishable_from, " or "), f.to_separate));
    }
  }

  void unexplained() {
    heading("What is left");
    if (!d_.unexplained.detected) {
      paragraph("No structure against any channel or time: what is left looks like noise.");
      return;
    }
    paragraph(fmt::format("{} {:.0f} % of the squared error left is no noise but follows {}: {}.",
                          style_.bad("Unnamed structure:"), d_.unexplained.share_percent,
                          joined(d_.unexplained.channels, ", "), d_.unexplained.shape));
  }

  void design() {
    if (!d_.design_impact) return;
    heading("What it does to the design");
    row("optimum cross-section", d_.design_impact->cross_section_mm2, "mm²", 3);
    row("power there", d_.design_impact->total_power_W, "W", 1);
  }

  void row(const char* what, const BeforeAfter& pair, const char* unit, int decimals) {
    const auto number = [&](const std::optional<double>& value) {
      return value ? fixed(*value, decimals) + " " + unit : std::string("none that can be flown");
    };
    paragraph(fmt::format("{}: {} → {}", what, number(pair.before), number(pair.after)));
  }

  void not_tested() {
    if (!d_.not_testable.empty()) {
      heading("What this log could not test");
      for (const NotTestable& n : d_.not_testable) {
        paragraph(fmt::format("{} needs {}.", n.effect, n.needs));
      }
    }
    if (!d_.not_identifiable.empty()) {
      heading("What this log can never show");
      for (const NotIdentifiable& n : d_.not_identifiable) {
        paragraph(fmt::format("{}: {}.", n.effect, n.because));
      }
    }
  }

  void notes() {
    if (d_.notes.empty()) return;
    heading("Notes");
    for (const std::string& note : d_.notes) paragraph(note + ".");
  }

  const Diagnosis& d_;
  const TextStyle& style_;
  std::vector<StoryPart> out_;
};

}  // namespace

ordered_json extended_spec(ordered_json spec, const Diagnosis& diagnosis) {
  for (const SpecChange& change : diagnosis.spec_changes) {
    ordered_json* place = &spec;
    std::istringstream path(change.field);
    for (std::string key; std::getline(path, key, '.');) {
      if (!place->is_object()) *place = ordered_json::object();
      place = &(*place)[key];
    }
    *place = change.value;
  }
  return spec;
}

ordered_json diagnosis_json(const Diagnosis& d, const ordered_json& extended) {
  ordered_json out;
  out["kind"] = d.kind;
  out["samples"] = d.samples;
  out["effective_samples"] = number_or_null(d.effective_samples);
  out["quantity"] = d.quantity;
  out["base"] = {{"holdout_rmse", number_or_null(d.base.holdout_rmse)},
                 {"unit", d.unit},
                 {"parameters", parameters_json(d.base.parameters)}};
  out["findings"] = ordered_json::array();
  for (const Finding& f : d.findings) out["findings"].push_back(finding_json(f));
  out["not_testable"] = ordered_json::array();
  for (const NotTestable& n : d.not_testable) {
    out["not_testable"].push_back({{"effect", n.effect}, {"needs", n.needs}});
  }
  out["not_identifiable"] = ordered_json::array();
  for (const NotIdentifiable& n : d.not_identifiable) {
    out["not_identifiable"].push_back({{"effect", n.effect}, {"because", n.because}});
  }
  out["unexplained"] = {{"detected", d.unexplained.detected},
                        {"channels", d.unexplained.channels},
                        {"share_percent", number_or_null(d.unexplained.share_percent)},
                        {"shape", d.unexplained.shape},
                        {"regressor", d.unexplained.regressor}};
  out["extended"] = {{"holdout_rmse", number_or_null(d.extended.holdout_rmse)},
                     {"parameters", parameters_json(d.extended.parameters)},
                     {"spec", extended}};
  out["error_budget_percent"] = {{"findings", d.budget.findings},
                                 {"unexplained", d.budget.unexplained},
                                 {"noise", d.budget.noise}};
  out["further"] = ordered_json::array();
  for (const HoldoutComparison& c : d.further) {
    out["further"].push_back({{"quantity", c.quantity},
                              {"unit", c.unit},
                              {"base_rmse", number_or_null(c.base_rmse)},
                              {"extended_rmse", number_or_null(c.extended_rmse)}});
  }
  out["notes"] = d.notes;
  if (d.design_impact) {
    out["design_impact"] = {{"cross_section_mm2", before_after(d.design_impact->cross_section_mm2)},
                            {"total_power_W", before_after(d.design_impact->total_power_W)}};
  } else {
    out["design_impact"] = nullptr;
  }
  return out;
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
    } else {
      out += wrapped(std::get<std::string>(part)) + "\n";
    }
  }
  return out;
}

std::string diagnosis_csv(const Diagnosis& diagnosis) {
  std::string out =
      "effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent\n";
  for (const Finding& f : diagnosis.findings) {
    for (const ParameterEstimate& p : f.parameters) {
      const std::vector<std::string> cells{
          csv_text(f.effect),       csv_text(f.stage),          csv_text(p.name),
          csv_number(p.value),      csv_text(p.unit),           csv_number(p.ci95_lower),
          csv_number(p.ci95_upper), csv_number(f.gain_percent), csv_number(f.gain_se_percent)};
      out += fmt::format("{}\n", fmt::join(cells, ","));
    }
  }
  return out;
}

}  // namespace tethercalc
