#include "io/csv.hpp"

#include <rapidcheck.h>

#include <catch2/catch.hpp>

#include "tethercalc/io/input_error.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

using Row = std::vector<std::string>;

std::vector<Row> rows_of(const std::string& text) {
  CsvRows reader(text, "a.csv");
  std::vector<Row> rows;
  for (Row row; reader.next(row);) rows.push_back(row);
  return rows;
}

/// RFC 4180, section 2: quoted wherever it may matter.
std::string quoted(const std::string& cell) {
  std::string out = "\"";
  for (const char c : cell) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

TEST_CASE("rows written by the rules of RFC 4180 come back as they were") {
  CHECK(rc::check("round trip", [] {
    const auto character = rc::gen::elementOf(std::string("ab,\"\r\n \xC3\xA4"));
    const auto cell = rc::gen::container<std::string>(character);
    const auto rows =
        *rc::gen::container<std::vector<Row>>(rc::gen::nonEmpty(rc::gen::container<Row>(cell)));
    const std::string end = *rc::gen::element<std::string>("\n", "\r\n");
    std::string text = *rc::gen::element<std::string>("", "\xEF\xBB\xBF");
    for (const Row& row : rows) {
      for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + quoted(row[i]);
      text += end;
    }
    RC_ASSERT(rows_of(text) == rows);
  }));
}

TEST_CASE("plain cells, empty ones, and a last line without an end are read") {
  CHECK(rows_of("a,b,\r\n,\n1,2,3") == std::vector<Row>{{"a", "b", ""}, {"", ""}, {"1", "2", "3"}});
  CHECK(rows_of("\n\na\n\nb\n\n") == std::vector<Row>{{"a"}, {"b"}});
  CHECK(rows_of("").empty());
}

TEST_CASE("rows know their lines, also behind cells with line breaks") {
  CsvRows reader("a\n\"x\ny\"\nb\n", "a.csv");
  Row row;
  REQUIRE(reader.next(row));
  CHECK(reader.where() == "a.csv:1");
  REQUIRE(reader.next(row));
  CHECK(reader.where() == "a.csv:2");
  REQUIRE(reader.next(row));
  CHECK(reader.where() == "a.csv:4");
}

TEST_CASE("a quote that is not closed, and text beside a quoted cell, are refused by line") {
  CHECK_THROWS_WITH(rows_of("a\n\"b\nc\n"), Contains("a.csv:2") && Contains("not closed"));
  CHECK_THROWS_WITH(rows_of("a\n\"b\"c\n"), Contains("a.csv:2") && Contains("after"));
}

TEST_CASE("any text ends in rows or in a message with its line") {
  CHECK(rc::check("no text is read beyond its end", [] {
    const std::string text = *rc::gen::container<std::string>(
        rc::gen::elementOf(std::string("a1,\"\r\n \0\xEF\xBB\xBF", 11)));
    try {
      for (const Row& row : rows_of(text)) RC_ASSERT(!row.empty());
    } catch (const InputError& error) {
      RC_ASSERT(error.problems().size() == 1U);
      RC_ASSERT(error.problems().front().where.starts_with("a.csv:"));
    }
  }));
}
