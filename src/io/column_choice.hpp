// The grammar of --columns: what a column of a table holds, where its name does not say it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tethercalc {

/// QUANTITY=HEADER taken apart, without blanks around both.
struct ColumnChoice {
  std::string quantity;  ///< with its unit: "thrust_N"
  std::string header;    ///< the column's name in the file; a minus before it turns the sign
};

/// Nothing where `text` has no "=", or nothing on a side of it.
[[nodiscard]] std::optional<ColumnChoice> column_choice(std::string_view text);

/// The column that a choice means.
struct ChosenColumn {
  std::size_t index = 0;  ///< in the header
  double sign = 1;        ///< of its numbers
};

/// The column of that name among `header`; without it, and where the name begins with a minus, the
/// one of the rest of the name, its numbers to be turned.
[[nodiscard]] std::optional<ChosenColumn> chosen_column(const ColumnChoice& choice,
                                                        std::span<const std::string> header);

}  // namespace tethercalc
