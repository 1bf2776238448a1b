// The columns of a log in CSV, of its flight and of its power: one format, each column described
// once.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/csv.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

// What attitude angles and a drone's velocity can be; see FlightLogReading::samples_implausible.
inline constexpr double steepest_pitch_deg = 90;
inline constexpr double furthest_roll_deg = 360;  // upside down, logged rolls run past 180°
inline constexpr double fastest_m_s = 500;
// A thousand turns: some tools export yaw without wraps.
inline constexpr double furthest_yaw_deg = 360'000;

/// What the reader of a half does with a column.
enum class ColumnUse {
  ignored,  ///< whatever its cells hold
  taken,    ///< where the file has it
  needed,   ///< or the file is refused, unless it has the columns that stand for it
};

/// One column.
struct LogCsvColumn {
  std::string_view name;     ///< as in the header, its unit in it
  std::string_view unit;     ///< in words
  std::string_view meaning;  ///< for people; Markdown
  ColumnUse flight = ColumnUse::ignored;
  ColumnUse power = ColumnUse::ignored;
  double minimum = std::numeric_limits<double>::lowest();  ///< what a value may be
  double maximum = std::numeric_limits<double>::max();     ///< likewise
};

/// All columns there are, in the order of the documentation.
[[nodiscard]] std::span<const LogCsvColumn> log_csv_columns();

/// A unit that --columns may name instead of a column's own.
struct LogCsvUnit {
  std::string_view own;    ///< as names of columns end: "deg"
  std::string_view other;  ///< likewise: "rad"
  double factor = 1;       ///< a number of the other times this,
  double offset = 0;       ///< and this more, is one of its own
};

/// All of them.
[[nodiscard]] std::span<const LogCsvUnit> log_csv_units();

/// The columns of a file, by name.
class LogTable {
 public:
  /// Reads what `use` (a member of LogCsvColumn) takes or needs; of the needed those in `optional`
  /// may be missing. `chosen` are NAME=HEADER each, as `column_choice` takes them apart: the column
  /// that holds what `name` would, its numbers in the unit at the end of the name. With them a
  /// column of another name that nothing is known of is passed over. Throws InputError with every
  /// problem of what was chosen, or of the file, as `read_csv_columns` does.
  LogTable(std::string_view text, std::string_view file, ColumnUse LogCsvColumn::*use,
           std::span<const std::string> chosen = {},
           std::span<const std::string_view> optional = {});

  /// The values of a column; empty where the file has none, or it is ignored.
  [[nodiscard]] std::vector<double>& operator[](std::string_view name);
  /// Whether the file has it.
  [[nodiscard]] bool has(std::string_view name) { return !(*this)[name].empty(); }

  /// Says which columns were passed over, where any were.
  void note_passed_over(std::vector<Warning>& notes) const;

 private:
  std::vector<std::vector<double>> columns_;
  std::vector<std::string> passed_over_;
};

/// Whether the content is a text that is no log of an autopilot's nor anything else that is known.
[[nodiscard]] bool looks_like_table(std::span<const std::byte> content);

/// Throws InputError where a wind measured on board is not told in one way alone.
void check_wind_columns(LogTable& table, std::string_view file);

/// Throws InputError, about `--columns`, where any are `chosen` of a log that is no CSV.
void check_no_columns(std::span<const std::string> chosen, std::string_view file);

/// Throws InputError where a core other than the first is asked of a log that is CSV.
void check_no_core(int core, std::string_view file);

}  // namespace tethercalc
