// The published rules that come with the program.
#include <catch2/catch.hpp>

#include <cctype>
#include <cmath>
#include <set>
#include <string>

#include "io/embedded_files.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/rule_books.hpp"

using namespace tethercalc;

namespace {

const RuleClause& clause_of(const RuleBook& book, const std::string& id) {
  for (const RuleClause& clause : book.clauses) {
    if (clause.id == id) return clause;
  }
  FAIL("no clause " << id);
  return book.clauses.front();
}

}  // namespace

TEST_CASE("every book reads, and each of its clauses has document, number, edition and words") {
  CHECK(rule_book_ids() == std::vector<std::string>{"electrical", "eu-c3", "uk", "us"});
  for (const std::string& id : rule_book_ids()) {
    const RuleBook book = rule_book(id);
    INFO(id);
    CHECK(!book.title.empty());
    CHECK(book.scope.size() > 40);
    CHECK(book.left_out.size() > 40);
    std::set<std::string> ids;
    for (const RuleClause& clause : book.clauses) {
      INFO(clause.id);
      CHECK(ids.insert(clause.id).second);
      CHECK(!clause.document.empty());
      CHECK(!clause.clause.empty());
      CHECK(!clause.edition.empty());
      CHECK(clause.text.size() > 20);
      // Own words are said to be a clause's only where a copy was at hand.
      CHECK((!clause.is_quote || !clause.checked.empty()));
      CHECK(std::isnan(clause.limit) == (clause.comparison == RuleComparison::is_so));
    }
  }
}

TEST_CASE("class C3 asks for less than 25 kg, 3 m and 50 m, and ten times the weight") {
  // Delegated Regulation (EU) 2019/945, Annex, Part 4, points (1) and (4).
  for (const char* id : {"eu-c3", "uk"}) {
    const RuleBook book = rule_book(id);
    CHECK(clause_of(book, "mass").limit == 25);
    CHECK(clause_of(book, "mass").comparison == RuleComparison::less_than);
    CHECK(clause_of(book, "dimension").limit == 3);
    CHECK(clause_of(book, "tether-length").limit == 50);
    CHECK(clause_of(book, "tether-length").comparison == RuleComparison::less_than);
    CHECK(clause_of(book, "tether-strength").limit == 10);
    CHECK(clause_of(book, "tether-strength").comparison == RuleComparison::at_least);
    CHECK(clause_of(book, "height").limit == 120);
  }
}

TEST_CASE("figures of the United States are feet, pounds and knots in SI") {
  const RuleBook book = rule_book("us");
  CHECK(clause_of(book, "mass").limit == Approx(55 * 0.45359237));
  CHECK(clause_of(book, "height").limit == Approx(400 * 0.3048));
  CHECK(clause_of(book, "actively-tethered-height").limit == Approx(150 * 0.3048));
  CHECK(clause_of(book, "speed").limit == Approx(87 * 1852 / 3600.0));
}

TEST_CASE("no book says of anything that it is safe") {
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.starts_with("rules/")) continue;
    std::string text(file.content);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (std::size_t at = text.find("safe"); at != std::string::npos;
         at = text.find("safe", at + 1)) {
      INFO(text.substr(at, 40));
      CHECK(text.substr(at).starts_with("safety organization"));  // who, not what
    }
  }
}

TEST_CASE("an unknown book is refused with the closest one") {
  CHECK_THROWS_WITH(rule_book("eu-c2"), Catch::Contains("did you mean \"eu-c3\""));
  CHECK_THROWS_AS(rule_book(""), InputError);
}
