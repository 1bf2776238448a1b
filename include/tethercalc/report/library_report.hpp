// The library's contents as tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// What the library holds of `what`: "motors", "conductors", "insulation" or "sizes", an object an
/// entry with its numbers under keys that end in their units, null where nobody stated one; sources
/// last, where there are any. Throws InputError for anything else.
[[nodiscard]] nlohmann::ordered_json library_json(const std::string& what);

/// The same as a table. Numbers with the digits that distinguish them; sources below it, each once.
[[nodiscard]] std::string library_text(const nlohmann::ordered_json& entries,
                                       const TextStyle& style);
/// A header and a row an entry.
[[nodiscard]] std::string library_csv(const nlohmann::ordered_json& entries);

}  // namespace tethercalc
