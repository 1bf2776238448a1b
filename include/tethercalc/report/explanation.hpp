// What every code that the answers print means, why it comes about and what to do: one page a code,
// for the terminal, for documents and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// What a code is of.
enum class CodeGroup {
  answers,         ///< `status`: whether there is an optimum, or a given cable will do
  limits,          ///< `limited_by` and demands
  warnings,        ///< `warning_codes` and `note_codes`
  verdicts,        ///< what a diagnosis says of an effect
  flight_effects,  ///< effects of the catalogue that flight logs show
  power_effects,   ///< those that logs of the power show
  cable,           ///< `outcome` of a hanging cable
  voltages,        ///< `voltage_class`
  rule_verdicts,   ///< `verdict`: how a figure stands to a clause
  records,         ///< `status` of a reference design
};

/// How many there are.
inline constexpr std::size_t code_group_count = 10;

/// "Limits and demands" …: a heading.
[[nodiscard]] std::string_view group_title(CodeGroup group);

/// The codes of a group, as the tables of the program have them that print them.
[[nodiscard]] std::vector<std::string> codes_of(CodeGroup group);

/// A part of a page: paragraphs, or lines that stand as they are.
struct ExplanationPart {
  std::string heading;             ///< "Why"
  std::vector<std::string> texts;  ///< a paragraph or a line each; names of fields in backticks
  bool lines = false;              ///< lines: a formula, parameters
};

/// The page of one code.
struct Explanation {
  std::string code;                     ///< "available_power"
  CodeGroup group = CodeGroup::limits;  ///< what it is of
  std::string title;                    ///< its meaning in a line, without a full stop
  /// "What it means", "Why", "What to do", of an effect "To tell it apart" and "Parameters", then
  /// "Formula" and "Source".
  std::vector<ExplanationPart> parts;

  /// The part under that heading, or null.
  [[nodiscard]] const ExplanationPart* part(std::string_view heading) const;
};

/// All pages, by group and in the order of `codes_of`. Of effects, title, meaning, formula and
/// parameters are those of the catalogue. The texts are `data/explain/`.
[[nodiscard]] std::span<const Explanation> explanations();

/// The page of a code, which may have spaces for its underscores as texts write it; or null.
[[nodiscard]] const Explanation* find_explanation(std::string_view words);

/// The same; throws InputError with the closest code where there is none.
[[nodiscard]] const Explanation& explanation_of(const std::string& code);

/// The codes with their titles, group by group.
[[nodiscard]] std::string explanation_list_text(const TextStyle& style);
/// {`code`, `group`, `title`} a code.
[[nodiscard]] nlohmann::ordered_json explanation_list_json();
/// The same as Markdown, each code linked to its page in `explanations_markdown`.
[[nodiscard]] std::string explanation_list_markdown();

/// One page in lines of at most 96 columns.
[[nodiscard]] std::string explanation_text(const Explanation& page, const TextStyle& style);
/// {`code`, `group`, `title`, `parts` [{`heading`, `texts`}]}.
[[nodiscard]] nlohmann::ordered_json explanation_json(const Explanation& page);
/// As Markdown; `depth` is that of its heading.
[[nodiscard]] std::string explanation_markdown(const Explanation& page, int depth = 1);

/// All pages as one document: the content of docs/explain.md.
[[nodiscard]] std::string explanations_markdown();

}  // namespace tethercalc
