// What reference designs held against their records came to, in words and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "tethercalc/io/reference_record.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// "ok", "drifted", "unrecorded" and "error": what `status` of the answers says.
[[nodiscard]] std::span<const std::string_view> check_status_names();

/// One line a design, what drifted below it, and a count at the end.
[[nodiscard]] std::string check_text(std::span<const ReferenceCheck> checks, bool updated,
                                     const TextStyle& style);
/// Every recorded result of every design, for programs.
[[nodiscard]] nlohmann::ordered_json check_json(std::span<const ReferenceCheck> checks);

/// A header and one row a recorded result.
[[nodiscard]] std::string check_csv(std::span<const ReferenceCheck> checks);

/// A JUnit XML report, which CI systems read: a test case a design, a failure where it drifted or
/// has no record, an error where it could not be checked.
[[nodiscard]] std::string check_junit(std::span<const ReferenceCheck> checks, bool updated);

}  // namespace tethercalc
