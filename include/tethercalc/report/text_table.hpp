// Tables of texts, aligned for a terminal.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tethercalc {

/// Whether text may carry terminal colours.
struct TextStyle {
  bool colour = false;  ///< false: every function below returns its text as it is

  [[nodiscard]] std::string bold(const std::string& text) const;     ///< bright
  [[nodiscard]] std::string good(const std::string& text) const;     ///< green
  [[nodiscard]] std::string bad(const std::string& text) const;      ///< red
  [[nodiscard]] std::string subdued(const std::string& text) const;  ///< grey
};

/// Rows of cells under a header. Columns are as wide as their widest cell; numbers belong on the
/// right, words on the left.
class TextTable {
 public:
  /// The side of the column that cells touch.
  enum class Align { left, right };
  /// A column's header and where its cells are pushed to. A title alone makes one of numbers.
  struct Column {
    std::string title;  ///< in one line or, broken by a newline, in two
    Align align;        ///< right for numbers

    /// For a title in quotes.
    Column(const char* words, Align side = Align::right) : title(words), align(side) {}
    /// For a title that was put together.
    Column(std::string words, Align side = Align::right) : title(std::move(words)), align(side) {}
  };

  /// A table without rows.
  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// Adds a row; missing cells at its end are empty. `emphasis` prints it bold where colours are
  /// allowed.
  void add(std::vector<std::string> cells, bool emphasis = false);

  /// The whole table, each line indented by two spaces and ended by a newline.
  [[nodiscard]] std::string text(const TextStyle& style = {}) const;

  /// One line of the table.
  struct Row {
    std::vector<std::string> cells;  ///< one a column
    bool emphasis = false;           ///< the one to look at
  };
  /// As given to the constructor.
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  /// In the order they were added.
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

/// A column of words, which stand on the left.
[[nodiscard]] TextTable::Column word_column(std::string title);

/// A table and what it shows.
struct TitledTable {
  std::string title;  ///< without a full stop
  TextTable table;    ///< its rows

  /// An empty line, the title, and the table.
  [[nodiscard]] std::string text(const TextStyle& style = {}) const;
};

/// `value` with `decimals` places; a dash where it does not exist (NaN or infinite).
[[nodiscard]] std::string fixed(double value, int decimals);

/// `value` with at least `digits` significant digits and never an exponent: 0.01234, 1.089, 405.4;
/// a dash where it does not exist.
[[nodiscard]] std::string significant(double value, int digits);

/// Breaks `text` at spaces into lines of at most `width` columns, each after `indent`.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t width = 96,
                                  const std::string& indent = "");

}  // namespace tethercalc
