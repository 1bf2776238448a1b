// The codes in an answer, found by the keys and columns that hold them, and whether `explain` knows
// them.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tethercalc/report/explanation.hpp"

namespace tethercalc::test {

using Codes = std::set<std::string>;

/// Keys of JSON and columns of CSV whose texts are codes.
inline bool holds_code(const std::string& name) {
  static const std::set<std::string> names{"limited_by", "status",       "effect",
                                           "outcome",    "verdict",      "indistinguishable_from",
                                           "note_codes", "warning_codes"};
  return names.count(name.substr(name.rfind('.') + 1)) > 0;
}

/// Every code in an answer as JSON, wherever it stands.
inline void collect_codes(const nlohmann::json& value, Codes& codes) {
  if (!value.is_structured()) return;
  for (const auto& item : value.items()) {
    const nlohmann::json& held = item.value();
    if (value.is_object() && holds_code(item.key())) {
      for (const nlohmann::json& code : held.is_array() ? held : nlohmann::json::array({held})) {
        if (code.is_string()) codes.insert(code.get<std::string>());
      }
    }
    if (item.key() == "voltage_class" && held.is_object()) codes.insert(held["name"]);
    collect_codes(held, codes);
  }
}

/// The cells of a row of CSV, without their quotes.
inline std::vector<std::string> csv_cells(const std::string& row) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : row) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Every code in rows of CSV below their header, up to the first row with other columns.
inline void collect_csv_codes(std::istream& lines, Codes& codes) {
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = csv_cells(line);
  if (columns.size() < 2 || std::none_of(columns.begin(), columns.end(), holds_code)) return;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != columns.size()) return;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (holds_code(columns[i]) && !cells[i].empty()) codes.insert(cells[i]);
    }
  }
}

/// Every code in what a command printed: JSON, a line of JSON each, or CSV. Tables have none.
inline Codes printed_codes(const std::string& printed) {
  Codes codes;
  if (printed.empty()) return codes;
  std::istringstream lines(printed);
  if (printed.front() != '{' && printed.front() != '[') {
    collect_csv_codes(lines, codes);
    return codes;
  }
  const auto read = [](const std::string& text) {
    return nlohmann::json::parse(text, nullptr, false);
  };
  if (const nlohmann::json whole = read(printed); !whole.is_discarded()) {
    collect_codes(whole, codes);
    return codes;
  }
  for (std::string line; std::getline(lines, line);) {
    if (const nlohmann::json row = read(line); !row.is_discarded()) collect_codes(row, codes);
  }
  return codes;
}

/// Ends a test whose command printed a code that `explain` does not know.
inline void require_pages(const std::string& printed) {
  for (const std::string& code : printed_codes(printed)) {
    if (find_explanation(code) == nullptr) {
      throw std::logic_error("an answer has the code \"" + code + "\", which no page explains");
    }
  }
}

}  // namespace tethercalc::test
