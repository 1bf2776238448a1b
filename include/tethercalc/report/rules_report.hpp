// How a design stands to published rules, in words. It repeats clauses and compares figures; it
// never says what follows for a flight.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/rules.hpp"

namespace tethercalc {

/// How many pass, fail and are unknown, and for which conductor, in a sentence.
[[nodiscard]] std::string rules_headline(const RuleStudy& study);

/// A row a clause: verdict, clause, our figure, the limit, the margin.
[[nodiscard]] TitledTable rules_table(const RuleStudy& study);

/// A clause with document, number and edition, its words, and against which copy they were
/// compared; of an unknown why it is one. A paragraph each.
[[nodiscard]] std::vector<std::string> rules_clauses(const RuleStudy& study);

/// To whom the rules apply, what is left out, and what this page is not. A paragraph each.
[[nodiscard]] std::vector<std::string> rules_scope(const RuleStudy& study);

/// All of it.
[[nodiscard]] std::string rules_text(const std::string& name, const RuleStudy& study,
                                     const TextStyle& style);

/// {`name`, `rules` {`id`, `title`, `scope`, `left_out`}, `cross_section_mm2`, `counts` {`pass`,
/// `fail`, `unknown`}, `clauses` [{`id`, `document`, `clause`, `edition`, `text`, `is_quote`,
/// `checked_against`, `figure`, `unit`, `value` [least, greatest], `comparison`, `limit`,
/// `margin_percent`, `verdict`, `because`}]}; null where a number does not exist.
[[nodiscard]] nlohmann::ordered_json rules_json(const std::string& name, const RuleStudy& study);

/// A header and a row a clause.
[[nodiscard]] std::string rules_csv(const RuleStudy& study);

}  // namespace tethercalc
