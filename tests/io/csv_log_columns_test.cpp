// The page about logs in CSV tells the columns as the readers have them.
#include "io/csv_log_columns.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "tethercalc/diagnose/power_log.hpp"

using namespace tethercalc;

namespace {

std::string page() {
  std::ifstream file(std::string(TETHERCALC_SOURCE_DIR) + "/docs/csv.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string_view words(ColumnUse use) {
  if (use == ColumnUse::needed) return "needed";
  return use == ColumnUse::taken ? "taken" : "";
}

std::string row(const LogCsvColumn& column) {
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", column.name, column.unit, column.meaning,
                     words(column.flight), words(column.power));
}

}  // namespace

TEST_CASE("the documented columns of a log in CSV are those that are read, in their order") {
  const std::string text = page();
  std::string expected;
  for (const LogCsvColumn& column : log_csv_columns()) expected += row(column);
  INFO(expected);
  const std::string head = "|---|---|---|---|---|\n";
  const auto begin = text.find(head);
  REQUIRE(begin != std::string::npos);
  const auto end = text.find("\n\n", begin);
  CHECK(text.substr(begin + head.size(), end + 1 - begin - head.size()) == expected);
}

TEST_CASE("the documented units of --columns are those that are read") {
  const std::string text = page();
  for (const LogCsvUnit& unit : log_csv_units()) {
    const std::string own = fmt::format("`_{}`", unit.own);
    const std::string other = fmt::format("`_{}`", unit.other);
    INFO(own << " " << other);
    bool told = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const auto at = line.find(own);
      told = told || (line.starts_with("| `_") && at != std::string::npos &&
                      line.find(other, at) != std::string::npos);
    }
    CHECK(told);
  }
}

TEST_CASE("every channel of a power log has a column, and no name stands twice") {
  std::set<std::string_view> names;
  for (const LogCsvColumn& column : log_csv_columns()) CHECK(names.insert(column.name).second);
  for (const PowerChannel& channel : power_channels) CHECK(names.contains(channel.name));
}
