// The picture of a sweep, from the CSV file that it wrote.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// A field that a sweep varied.
struct SweepColumn {
  std::string path;                ///< dot path of the field, the column's name
  std::vector<double> values;      ///< one a row; of names, their index into `names`
  std::vector<std::string> names;  ///< in order of appearance; empty where the values are numbers

  /// The values that occur, rising, each once.
  [[nodiscard]] std::vector<double> distinct() const;
};

/// The rows of a sweep, as far as a picture needs them.
struct SweepTable {
  std::string file;                  ///< as messages call it
  std::vector<SweepColumn> varied;   ///< the columns before `status`
  std::string value_column;          ///< name of the column that is shown
  std::vector<double> value;         ///< one a row; NaN where it does not exist
  std::vector<std::string> columns;  ///< names of all columns
  std::size_t infeasible = 0;        ///< rows without the value
};

/// What a sweep wrote as CSV, `text` being the content of the file called `file`, with the numbers
/// of column `value`; empty, that is "forward.total_power_W".
///
/// A field that takes numbers in a spec must have them in every row; of others each text is a name
/// of its own. Throws InputError with every problem, at most 20, as "file:line": no header with
/// `status`, no such column (with the closest name), no rows, rows of another length, cells that
/// are no numbers.
[[nodiscard]] SweepTable parse_sweep_csv(std::string_view text, const std::string& file,
                                         const std::string& value = "");

/// Which fields stand along the axes; empty, they are chosen: the first numbers that vary.
struct SweepView {
  std::string x;        ///< dot path
  std::string y;        ///< dot path
  std::string title{};  ///< of the figure; empty: the file's name
};

/// The value over two fields as a heat map, over one as a curve, or over one with a curve for each
/// of at most seven names of the other. Rows that differ only in further fields are represented by
/// the least value among them. Cells without a value are grey. Names along an axis stand as numbers
/// there and in full below. A sample, whose points form no grid, is drawn as dots.
///
/// Throws InputError where nothing varies, `view` names no varied field (with the closest one), or
/// a heat map would have more than 40 000 cells.
[[nodiscard]] Figure sweep_figure(const SweepTable& table, const SweepView& view = {});

/// "V" of "supply.voltage_V": the unit of a field or result; empty where it has none.
[[nodiscard]] std::string unit_of(std::string_view name);

/// "supply voltage (V)" of "supply.voltage_V": the words of a field or result, its unit apart.
[[nodiscard]] std::string axis_label(std::string_view name);

}  // namespace tethercalc
