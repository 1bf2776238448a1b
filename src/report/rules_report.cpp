#include "tethercalc/report/rules_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/result_values.hpp"

namespace tethercalc {
namespace {

std::string with_unit(const std::string& number, const RuleClause& clause) {
  const std::string_view unit = rule_figure_unit(clause.figure);
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

std::string number_words(double value) { return fmt::format("{:.4g}", value); }

std::string value_words(const RuleCheck& check) {
  const RuleValue& value = check.value;
  if (std::isnan(value.lo)) return "missing";
  if (check.clause.comparison == RuleComparison::is_so) return "yes";
  const std::string lo = number_words(value.lo);
  const std::string hi = number_words(value.hi);
  return with_unit(lo == hi ? lo : lo + " to " + hi, check.clause);
}

std::string_view comparison_words(RuleComparison comparison) {
  constexpr std::array<std::string_view, 4> words{"less than", "at most", "at least", "yes"};
  return words.at(static_cast<std::size_t>(comparison));
}

std::string_view comparison_name(RuleComparison comparison) {
  constexpr std::array<std::string_view, 4> names{"less_than", "at_most", "at_least", "is_so"};
  return names.at(static_cast<std::size_t>(comparison));
}

std::string limit_words(const RuleClause& clause) {
  const std::string words(comparison_words(clause.comparison));
  if (std::isnan(clause.limit)) return words;
  return words + " " + with_unit(number_words(clause.limit), clause);
}

std::string clause_words(const RuleCheck& check) {
  const RuleClause& clause = check.clause;
  std::string out = fmt::format("{}: {}, {} ({}): ", rule_verdict_name(check.verdict),
                                clause.document, clause.clause, clause.edition);
  out += clause.is_quote ? fmt::format("“{}”.", clause.text)
                         : fmt::format("in our words, {}.", clause.text);
  out += clause.checked.empty()
             ? std::string(" Not verified against the official text.")
             : fmt::format(" {} compared with {}.", clause.is_quote ? "Words" : "Meaning",
                           clause.checked);
  if (!check.because.empty())
    out += fmt::format(" It is unknown because {}", with_stop(check.because));
  return out;
}

ordered_json clause_json(const RuleCheck& check) {
  const RuleClause& clause = check.clause;
  return {{"id", clause.id},
          {"document", clause.document},
          {"clause", clause.clause},
          {"edition", clause.edition},
          {"text", clause.text},
          {"is_quote", clause.is_quote},
          {"checked_against",
           clause.checked.empty() ? ordered_json(nullptr) : ordered_json(clause.checked)},
          {"figure", rule_figure_name(clause.figure)},
          {"unit", rule_figure_unit(clause.figure)},
          {"value", {number_or_null(check.value.lo), number_or_null(check.value.hi)}},
          {"comparison", comparison_name(clause.comparison)},
          {"limit", number_or_null(clause.limit)},
          {"margin_percent", check.margin ? ordered_json(100 * *check.margin) : nullptr},
          {"verdict", rule_verdict_name(check.verdict)},
          {"because", check.because.empty() ? ordered_json(nullptr) : ordered_json(check.because)}};
}

std::optional<double> area_mm2(const RuleStudy& study) {
  if (!study.area) return std::nullopt;
  return *study.area / unit::square_millimetre;
}

}  // namespace

std::string rules_headline(const RuleStudy& study) {
  const auto area = area_mm2(study);
  return fmt::format("{}{}: {} clauses are held against figures; {} pass, {} fail, {} are unknown.",
                     study.book.title,
                     area ? fmt::format(", with conductors of {} mm²", significant(*area, 4)) : "",
                     study.checks.size(), study.count(RuleVerdict::pass),
                     study.count(RuleVerdict::fail), study.count(RuleVerdict::unknown));
}

TitledTable rules_table(const RuleStudy& study) {
  TextTable table({word_column(""), word_column("clause"), word_column("figure"),
                   word_column("ours"), word_column("asked"), "margin"});
  for (const RuleCheck& check : study.checks) {
    std::string figure(rule_figure_name(check.clause.figure));
    std::ranges::replace(figure, '_', ' ');
    table.add({std::string(rule_verdict_name(check.verdict)), check.clause.id, figure,
               value_words(check), limit_words(check.clause),
               check.margin ? fmt::format("{:.0f} %", 100 * *check.margin) : "–"},
              check.verdict == RuleVerdict::fail);
  }
  return {"Figures against clauses", std::move(table)};
}

std::vector<std::string> rules_clauses(const RuleStudy& study) {
  std::vector<std::string> out;
  for (const RuleCheck& check : study.checks) {
    out.push_back(check.clause.id + ", " + clause_words(check));
  }
  return out;
}

std::vector<std::string> rules_scope(const RuleStudy& study) {
  return {study.book.scope, study.book.left_out,
          "This compares figures of a calculation with numbers in published texts. It is no legal "
          "advice, and a pass is no more than that the figure is within the number."};
}

std::string rules_text(const std::string& name, const RuleStudy& study, const TextStyle& style) {
  std::string out = style.bold(name) + "\n\n" + wrapped(rules_headline(study));
  out += rules_table(study).text(style) + "\n";
  for (std::size_t i = 0; i < study.checks.size(); ++i) {
    out += style.bold(study.checks[i].clause.id) + "\n";
    out += wrapped(clause_words(study.checks[i]), 96, "  ");
  }
  for (const std::string& paragraph : rules_scope(study)) out += "\n" + wrapped(paragraph);
  return out;
}

ordered_json rules_json(const std::string& name, const RuleStudy& study) {
  return {{"name", name},
          {"rules",
           {{"id", study.book.id},
            {"title", study.book.title},
            {"scope", study.book.scope},
            {"left_out", study.book.left_out}}},
          {"cross_section_mm2", number_or_null(area_mm2(study))},
          {"counts",
           {{"pass", study.count(RuleVerdict::pass)},
            {"fail", study.count(RuleVerdict::fail)},
            {"unknown", study.count(RuleVerdict::unknown)}}},
          {"clauses", json_list(study.checks, clause_json)}};
}

std::string rules_csv(const RuleStudy& study) {
  std::string out =
      "id,document,clause,edition,figure,unit,least,greatest,comparison,limit,margin_percent,"
      "verdict,because\n";
  for (const RuleCheck& check : study.checks) {
    const ordered_json row = clause_json(check);
    out += csv_line({row["id"], row["document"], row["clause"], row["edition"], row["figure"],
                     row["unit"], row["value"][0], row["value"][1], row["comparison"], row["limit"],
                     row["margin_percent"], row["verdict"], row["because"]});
  }
  return out;
}

}  // namespace tethercalc
