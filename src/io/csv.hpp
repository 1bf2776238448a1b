// CSV texts: numeric columns by the names in the first line, or rows of quoted cells.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {

/// A column that a reader understands.
struct CsvColumn {
  std::string_view name;  ///< exactly as in the header
  bool required = true;
  /// What a value may be; outside it, or where it is no finite number at all, is a problem.
  double minimum = std::numeric_limits<double>::lowest();
  double maximum = std::numeric_limits<double>::max();
  bool increasing = false;  ///< each value must be greater than the one in the row above
  bool ignored = false;     ///< known, but not read: its cells may hold any text
  std::string header = {};  ///< what the file calls it; empty: `name`
  bool absent = false;      ///< the file has it not: what is called so there is something else
  double factor = 1;        ///< a value is this times the cell's number
  double offset = 0;        ///< and this more
};

enum class OtherCsvColumns {
  rejected,  ///< a header name that is none of the wanted ones is a problem: it may be a misspelt
             ///< one
  ignored    ///< for files with more in them than one reader wants; their cells may hold any text
};

/// Reads the wanted columns, in any order in the file, from the whole text of a CSV file: commas,
/// decimal points, one header line, LF or CRLF, with or without a byte order mark. Cells are not
/// quoted; blanks around a cell are ignored.
///
/// Returns one vector per wanted column, in the order wanted, all as long as the file has rows;
/// an optional column that the file lacks, or one that is ignored, is an empty vector. Where a
/// column is unknown the message about those that are known ends with `hint`.
///
/// Throws InputError where semicolons or tabs stand for the commas; else with every problem of the
/// file, each as "file:line": missing, unknown (with the closest wanted name) and repeated columns;
/// rows of the wrong length; cells that are empty, not a number, not finite or out of range; no
/// rows. Beyond 20 problems only their number is told.
std::vector<std::vector<double>> read_csv_columns(std::string_view text, std::string_view file_name,
                                                  std::span<const CsvColumn> wanted,
                                                  OtherCsvColumns others,
                                                  std::string_view hint = {});

/// The names in the first line, as `read_csv_columns` understands it.
[[nodiscard]] std::vector<std::string> csv_header(std::string_view text);

/// Walks through the text of a CSV file (RFC 4180): commas or another separator, cells in double
/// quotes where they hold separators, quotes (doubled) or line breaks; LF or CRLF, with or without
/// a byte order mark. Empty lines are passed over.
class CsvRows {
 public:
  /// `text` must outlive this object; `file` is what messages call it.
  CsvRows(std::string_view text, std::string file, char separator = ',');

  /// Fills `cells` with those of the next row and returns true; false at the end. Throws InputError
  /// with "file:line" for a quote that is not closed and for text beside a quoted cell.
  [[nodiscard]] bool next(std::vector<std::string>& cells);

  /// Where the row that `next` gave begins, counted from 1, as "file:line".
  [[nodiscard]] std::string where() const;
  /// That line alone.
  [[nodiscard]] std::size_t line() const { return row_line_; }

 private:
  std::string quoted_cell();

  std::string_view rest_;
  std::string file_;
  char separator_;
  std::size_t line_ = 1;      ///< of what is left
  std::size_t row_line_ = 1;  ///< of the last row
};

}  // namespace tethercalc
