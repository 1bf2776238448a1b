// Tables for people: what a number looks like, and how columns line up.
#include "tethercalc/report/text_table.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace tethercalc;

TEST_CASE("a number that rounds to zero has no sign, and one that does not exist is a dash") {
  CHECK(fixed(-0.0004, 3) == "0.000");
  CHECK(fixed(-0.0006, 3) == "-0.001");
  CHECK(fixed(-0.0, 0) == "0");
  CHECK(fixed(std::numeric_limits<double>::quiet_NaN(), 3) == "–");
  CHECK(significant(std::numeric_limits<double>::infinity(), 3) == "–");
}

TEST_CASE("significant digits never need an exponent and never cut off whole digits") {
  CHECK(significant(0.012341, 4) == "0.01234");
  CHECK(significant(405.38, 4) == "405.4");
  CHECK(significant(123456.7, 3) == "123457");
  CHECK(significant(0, 3) == "0");
}

TEST_CASE(
    "columns are as wide as their widest cell in characters, under titles of one line or two") {
  TextTable table({{"size", TextTable::Align::left}, {"tether\ng"}});
  table.add({"1 mm²", "523"});
  table.add({"AWG 17"});
  CHECK(table.text() ==
        "  size    tether\n"
        "               g\n"
        "  1 mm²      523\n"
        "  AWG 17\n");
}

TEST_CASE("wrapped lines keep their words, their indent and their width") {
  CHECK(wrapped("one two three four", 9, "  ") == "  one two\n  three\n  four\n");
  CHECK(wrapped("abcdefghijklmnop q", 6) == "abcdefghijklmnop\nq\n");
}

TEST_CASE("columns stand below each other where names are in wide scripts") {
  // Unicode's EastAsianWidth: each of these letters is as wide as two Latin ones.
  TextTable table({word_column("name"), {"g", TextTable::Align::right}});
  table.add({"\u7535\u673A\u4E00", "5"});
  table.add({"motor", "12"});
  CHECK(table.text() == "  name     g\n  \u7535\u673A\u4E00   5\n  motor   12\n");
}
