// The library's contents as tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// A table of texts and numbers.
struct LibraryListing {
  using Cell = std::variant<std::string, double>;  ///< a NaN is a number nobody stated
  /// What a column is called.
  struct Column {
    std::string key;    ///< in JSON and CSV, ending in the unit of numbers, as in specs
    std::string title;  ///< in tables, with the unit on a second line
  };
  std::vector<Column> columns;          ///< sources last, where there are any
  std::vector<std::vector<Cell>> rows;  ///< as long as columns
};

/// What the library holds of `what`: "motors", "conductors", "insulation" or "sizes". Throws
/// InputError for anything else.
[[nodiscard]] LibraryListing list_library(const std::string& what);

/// Numbers with the digits that distinguish them; sources below the table, each once.
[[nodiscard]] std::string listing_text(const LibraryListing& listing, const TextStyle& style);
/// An object an entry.
[[nodiscard]] nlohmann::ordered_json listing_json(const LibraryListing& listing);
/// A header and a row an entry.
[[nodiscard]] std::string listing_csv(const LibraryListing& listing);

}  // namespace tethercalc
