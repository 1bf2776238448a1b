#include "tethercalc/report/explanation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "io/closest_name.hpp"
#include "io/embedded_files.hpp"
#include "report/result_values.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/reference_check.hpp"
#include "tethercalc/study/results.hpp"
#include "tethercalc/study/rules.hpp"

namespace tethercalc {
namespace {

struct GroupWords {
  std::string_view title;
  std::string_view name;          ///< in JSON
  std::string_view file;          ///< with its texts
  std::string_view further = {};  ///< texts that not every program has
};

constexpr std::array<GroupWords, code_group_count> group_words{
    {{"Answers", "answer", "explain/answers.md"},
     {"Limits and demands", "limit", "explain/limits.md"},
     {"Warnings and notes", "warning", "explain/warnings.md", "explain/motor-warnings.md"},
     {"Verdicts of a diagnosis", "verdict", "explain/verdicts.md"},
     {"Effects that a flight log shows", "flight_effect", "explain/flight-effects.md"},
     {"Effects that a power log shows", "power_effect", "explain/power-effects.md"},
     {"Outcomes of a hanging cable", "cable", "explain/cable.md"},
     {"Classes of voltage", "voltage", "explain/voltages.md"},
     {"Verdicts of published rules", "rule_verdict", "explain/rule-verdicts.md"},
     {"Reference designs", "record", "explain/records.md"}}};

const GroupWords& words_of(CodeGroup group) {
  return group_words.at(static_cast<std::size_t>(group));
}

constexpr std::string_view meaning = "What it means";
constexpr std::string_view formula = "Formula";

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The pages of a file in `data/explain/`: "# code", a line with the title, the meaning, then "##
/// Heading" and paragraphs; lines indented by four stand as they are. Of effects title and meaning
/// are the catalogue's.
std::vector<Explanation> pages_of(CodeGroup group) {
  std::vector<Explanation> pages;
  bool in_paragraph = false;
  const GroupWords& words = words_of(group);
  std::string texts(embedded_file(words.file));
  if (const EmbeddedFile* further = find_embedded_file(words.further)) texts += further->content;
  for (const std::string& line : lines_of(texts)) {
    if (line.starts_with("# ")) {
      pages.push_back({line.substr(2), group, "", {}});
    } else if (line.starts_with("## ")) {
      pages.back().parts.push_back({line.substr(3), {}});
    } else if (line.empty()) {
      in_paragraph = false;
      continue;
    } else if (Explanation& page = pages.back(); page.parts.empty()) {
      page.title = line;
      page.parts.push_back({std::string(meaning), {}});
    } else if (ExplanationPart& part = page.parts.back(); line.starts_with("    ")) {
      part.lines = true;
      part.texts.push_back(line.substr(4));
      continue;
    } else if (in_paragraph) {
      part.texts.back() += " " + line;
      continue;
    } else {
      part.texts.push_back(line);
      in_paragraph = true;
      continue;
    }
    in_paragraph = false;
  }
  return pages;
}

std::string parameter_words(const EffectParameter& p) {
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  if (p.look_through == LookThrough::moments) return p.name + ": a moment of the log";
  std::string out = fmt::format("{}: neutral {:g}{}, from {:g} to {:g}{}", p.name, p.neutral, unit,
                                p.lower, p.upper, unit);
  if (!p.spec_field.empty()) out += "; goes into the spec at " + p.spec_field;
  return out;
}

/// Puts what the catalogue says of an effect around the texts of its page.
void complete(Explanation& page, const Effect& effect) {
  page.title = effect.title;
  page.parts.insert(page.parts.begin(), {std::string(meaning), {effect.mechanism}});
  const auto source = std::ranges::find(page.parts, "Source", &ExplanationPart::heading);
  std::vector<std::string> parameters;
  for (const EffectParameter& p : effect.parameters) parameters.push_back(parameter_words(p));
  std::string apart = with_stop(effect.to_separate);
  apart.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(apart.front())));
  std::vector<ExplanationPart> told{{"To tell it apart", {std::move(apart)}}};
  if (!effect.needs.empty()) {
    told.push_back({"Channels it needs", {fmt::format("{}.", fmt::join(effect.needs, ", "))}});
  }
  told.push_back({"Parameters", std::move(parameters), true});
  told.push_back({std::string(formula), {effect.change}, true});
  page.parts.insert(source, told.begin(), told.end());
}

std::vector<Explanation> all_pages() {
  std::vector<Explanation> pages;
  for (std::size_t g = 0; g < code_group_count; ++g) {
    const auto group = static_cast<CodeGroup>(g);
    // The program of a browser's page is built without those that it never shows.
    const GroupWords& words = words_of(group);
    if (find_embedded_file(words.file) == nullptr) continue;
    const bool whole = words.further.empty() || find_embedded_file(words.further) != nullptr;
    std::vector<Explanation> own = pages_of(group);
    for (const std::string& code : codes_of(group)) {
      const auto page = std::ranges::find(own, code, &Explanation::code);
      if (page == own.end() && !whole) continue;
      if (page == own.end()) throw std::logic_error("no page explains " + code);
      if (const Effect* effect = find_effect(code)) complete(*page, *effect);
      pages.push_back(std::move(*page));
      own.erase(page);
    }
    if (!own.empty()) throw std::logic_error("nothing prints " + own.front().code);
  }
  return pages;
}

std::vector<std::string> effect_ids(LogKind kind) {
  std::vector<std::string> ids;
  for (const Effect& effect : effect_catalogue(kind)) ids.push_back(effect.id);
  return ids;
}

/// Limits, then demands that are told as another limit.
std::vector<std::string> limits_and_demands() {
  std::vector<std::string> codes;
  const auto add = [&codes](std::string_view code) {
    if (std::ranges::count(codes, code) == 0) codes.emplace_back(code);
  };
  for (std::size_t i = 0; i < limit_count; ++i) {
    add(limit_name(static_cast<Limit>(i)));
  }
  for (std::size_t i = 0; i < demand_count; ++i) add(demand_name(static_cast<Demand>(i)));
  return codes;
}

std::vector<std::string> rule_verdicts() {
  std::vector<std::string> codes;
  for (const RuleVerdict verdict : {RuleVerdict::pass, RuleVerdict::fail, RuleVerdict::unknown}) {
    codes.emplace_back(rule_verdict_name(verdict));
  }
  return codes;
}

template <typename Names>
std::vector<std::string> as_strings(const Names& names) {
  return {names.begin(), names.end()};
}

/// A code as a link to its page in the same document.
std::string linked(const std::string& code) { return fmt::format("[`{0}`](#{0})", code); }

}  // namespace

std::string_view group_title(CodeGroup group) { return words_of(group).title; }

std::vector<std::string> codes_of(CodeGroup group) {
  switch (group) {
    case CodeGroup::answers:
      return as_strings(design_status_names());
    case CodeGroup::limits:
      return limits_and_demands();
    case CodeGroup::warnings: {
      std::vector<std::string> codes;
      for (std::size_t i = 0; i < warning_kind_count; ++i) {
        codes.emplace_back(warning_code(static_cast<WarningKind>(i)));
      }
      return codes;
    }
    case CodeGroup::verdicts:
      return as_strings(verdict_names());
    case CodeGroup::flight_effects:
      return effect_ids(LogKind::flight);
    case CodeGroup::power_effects:
      return effect_ids(LogKind::power);
    case CodeGroup::cable:
      return as_strings(cable_outcome_names());
    case CodeGroup::voltages:
      return as_strings(voltage_class_names());
    case CodeGroup::rule_verdicts:
      return rule_verdicts();
    case CodeGroup::records:
      break;
  }
  return as_strings(check_status_names());
}

const ExplanationPart* Explanation::part(std::string_view heading) const {
  const auto found = std::ranges::find(parts, heading, &ExplanationPart::heading);
  return found == parts.end() ? nullptr : &*found;
}

std::span<const Explanation> explanations() {
  static const std::vector<Explanation> pages = all_pages();
  return pages;
}

const Explanation* find_explanation(std::string_view words) {
  std::string code(words);
  std::ranges::replace(code, ' ', '_');
  const auto pages = explanations();
  const auto found = std::ranges::find(pages, code, &Explanation::code);
  return found == pages.end() ? nullptr : &*found;
}

const Explanation& explanation_of(const std::string& code) {
  if (const Explanation* page = find_explanation(code)) return *page;
  std::vector<std::string> codes;
  for (const Explanation& page : explanations()) codes.push_back(page.code);
  throw InputError(
      "explain", fmt::format("\"{}\" is no code of an answer (explain alone lists all {}){}", code,
                             codes.size(), did_you_mean(code, codes)));
}

std::string explanation_list_text(const TextStyle& style) {
  std::string out;
  for (std::size_t g = 0; g < code_group_count; ++g) {
    const auto group = static_cast<CodeGroup>(g);
    out += (out.empty() ? "" : "\n") + style.bold(std::string(group_title(group))) + "\n";
    for (const Explanation& page : explanations()) {
      if (page.group == group) out += fmt::format("  {:<27} {}\n", page.code, page.title);
    }
  }
  return out + "\ntethercalc explain CODE says more of each.\n";
}

ordered_json explanation_list_json() {
  return json_list(explanations(), [](const Explanation& page) {
    return ordered_json{
        {"code", page.code}, {"group", words_of(page.group).name}, {"title", page.title}};
  });
}

std::string explanation_list_markdown() {
  std::string out;
  for (std::size_t g = 0; g < code_group_count; ++g) {
    const auto group = static_cast<CodeGroup>(g);
    out += fmt::format("{}**{}**\n\n", out.empty() ? "" : "\n", group_title(group));
    for (const Explanation& page : explanations()) {
      if (page.group == group) out += fmt::format("- {}: {}\n", linked(page.code), page.title);
    }
  }
  return out;
}

std::string explanation_text(const Explanation& page, const TextStyle& style) {
  std::string out = style.bold(page.code + ": " + page.title) + "\n";
  for (const ExplanationPart& part : page.parts) {
    out += "\n" + style.bold(part.heading) + "\n";
    for (const std::string& text : part.texts) out += wrapped(text, 96, part.lines ? "    " : "  ");
  }
  return out;
}

ordered_json explanation_json(const Explanation& page) {
  return {{"code", page.code},
          {"group", words_of(page.group).name},
          {"title", page.title},
          {"parts", json_list(page.parts, [](const ExplanationPart& part) {
             return ordered_json{{"heading", part.heading}, {"texts", part.texts}};
           })}};
}

std::string explanation_markdown(const Explanation& page, int depth) {
  std::string out = fmt::format("{} {}\n\n{}.\n", std::string(static_cast<std::size_t>(depth), '#'),
                                page.code, page.title);
  for (const ExplanationPart& part : page.parts) {
    if (part.lines) {
      out += fmt::format("\n**{}**\n\n", part.heading);
      for (const std::string& line : part.texts) out += "    " + line + "\n";
      continue;
    }
    const std::string lead = fmt::format("**{}.** ", part.heading);
    for (std::size_t i = 0; i < part.texts.size(); ++i) {
      out += "\n" + wrapped((i == 0 ? lead : "") + part.texts[i], 110);
    }
  }
  return out;
}

std::string explanations_markdown() {
  std::string out =
      "# What the answers' codes mean\n\nEach limit, warning, verdict and effect that an answer "
      "names has a code that stays the same when\nits sentence changes: `limited_by`, "
      "`warning_codes`, `note_codes`, `effect`, `outcome`, `voltage_class`, `status`, `verdict`. "
      "`tethercalc\nexplain CODE` prints "
      "the pages below, `tethercalc explain` lists them, `--format json` and\n`--format markdown` "
      "give them to programs and documents.\n\n";
  out += explanation_list_markdown();
  for (std::size_t g = 0; g < code_group_count; ++g) {
    const auto group = static_cast<CodeGroup>(g);
    out += fmt::format("\n## {}\n", group_title(group));
    for (const Explanation& page : explanations()) {
      if (page.group == group) out += "\n" + explanation_markdown(page, 3);
    }
  }
  return out;
}

}  // namespace tethercalc
