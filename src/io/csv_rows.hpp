// The rows of a CSV file with quoted cells, one after the other.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tethercalc {

/// Walks through the text of a CSV file (RFC 4180): commas, cells in double quotes where they hold
/// commas, quotes (doubled) or line breaks; LF or CRLF, with or without a byte order mark. Empty
/// lines are passed over.
class CsvRows {
 public:
  /// `text` must outlive this object; `file` is what messages call it.
  CsvRows(std::string_view text, std::string file);

  /// Fills `cells` with those of the next row and returns true; false at the end. Throws InputError
  /// with "file:line" for a quote that is not closed and for text beside a quoted cell.
  [[nodiscard]] bool next(std::vector<std::string>& cells);

  /// Where the row that `next` gave begins, counted from 1, as "file:line".
  [[nodiscard]] std::string where() const;

 private:
  std::string quoted_cell();

  std::string_view rest_;
  std::string file_;
  std::size_t line_ = 1;      ///< of what is left
  std::size_t row_line_ = 1;  ///< of the last row
};

}  // namespace tethercalc
