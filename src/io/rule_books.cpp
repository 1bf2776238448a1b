#include "tethercalc/io/rule_books.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "io/closest_name.hpp"
#include "io/embedded_files.hpp"
#include "io/json_document.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

constexpr std::string_view rules_folder = "rules/";
constexpr std::string_view rules_suffix = ".json";

RuleFigure figure_named(const std::string& name) {
  for (std::size_t i = 0; i < rule_figure_count; ++i) {
    const auto figure = static_cast<RuleFigure>(i);
    if (rule_figure_name(figure) == name) return figure;
  }
  throw std::logic_error("no figure of a rule is called " + name);
}

void set_comparison(const nlohmann::ordered_json& json, RuleClause& clause) {
  constexpr std::pair<const char*, RuleComparison> comparisons[] = {
      {"less_than", RuleComparison::less_than},
      {"at_most", RuleComparison::at_most},
      {"at_least", RuleComparison::at_least}};
  clause.comparison = RuleComparison::is_so;
  for (const auto& [key, comparison] : comparisons) {
    if (!json.contains(key)) continue;
    clause.comparison = comparison;
    clause.limit = json.at(key).get<double>();
  }
}

/// A clause of `book`, whose document and edition it has unless it names its own.
RuleClause clause_of(const nlohmann::ordered_json& json, const nlohmann::ordered_json& book) {
  const auto own_or = [&](const char* key) {
    return (json.contains(key) ? json : book).at(key).get<std::string>();
  };
  RuleClause clause;
  clause.id = json.at("id").get<std::string>();
  clause.document = own_or("document");
  clause.edition = own_or("edition");
  clause.clause = json.at("clause").get<std::string>();
  clause.is_quote = json.contains("quote");
  clause.text = json.at(clause.is_quote ? "quote" : "says").get<std::string>();
  clause.checked = json.value("checked", "");
  clause.figure = figure_named(json.at("figure").get<std::string>());
  clause.otherwise = json.value("otherwise", "");
  set_comparison(json, clause);
  return clause;
}

RuleBook book_of(const std::string& id) {
  const nlohmann::ordered_json json =
      json_of(embedded_file(std::string(rules_folder) + id + std::string(rules_suffix)));
  RuleBook book{id,
                json.at("title").get<std::string>(),
                json.at("scope").get<std::string>(),
                json.at("left_out").get<std::string>(),
                {}};
  for (const nlohmann::ordered_json& clause : json.at("clauses")) {
    book.clauses.push_back(clause_of(clause, json));
  }
  for (const nlohmann::ordered_json& other : json.value("with", nlohmann::ordered_json::array())) {
    const RuleBook taken_in = book_of(other.get<std::string>());
    book.clauses.insert(book.clauses.end(), taken_in.clauses.begin(), taken_in.clauses.end());
    book.scope += " " + taken_in.title + ": " + taken_in.scope;
    book.left_out += " " + taken_in.left_out;
  }
  return book;
}

}  // namespace

std::vector<std::string> rule_book_ids() {
  std::vector<std::string> ids;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.starts_with(rules_folder)) continue;
    ids.emplace_back(file.name.substr(
        rules_folder.size(), file.name.size() - rules_folder.size() - rules_suffix.size()));
  }
  return ids;
}

RuleBook rule_book(const std::string& id, const std::string& where) {
  const std::vector<std::string> ids = rule_book_ids();
  if (std::ranges::count(ids, id) > 0) return book_of(id);
  const std::string wrong =
      id.empty() ? "is needed" : fmt::format("\"{}\" is no book of rules", id);
  throw InputError(where, fmt::format("{}; allowed are {} and {}{}", wrong,
                                      fmt::join(ids.begin(), ids.end() - 1, ", "), ids.back(),
                                      id.empty() ? std::string() : did_you_mean(id, ids)));
}

}  // namespace tethercalc
