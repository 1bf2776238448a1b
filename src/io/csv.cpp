#include "io/csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/decimal_number.hpp"

namespace tethercalc {
namespace {

// More would scroll the first, which is usually the cause, off the screen.
constexpr std::size_t most_cell_problems = 20;
// A table of another make has as many unknown columns.
constexpr std::size_t most_header_problems = 100;

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.substr(text.starts_with(mark) ? mark.size() : 0);
}

class CellProblems : public Problems {
 public:
  explicit CellProblems(std::string_view file, std::size_t most = most_cell_problems)
      : Problems(most, std::string(file)), file_(file) {}

  void add(std::size_t line, std::string message) {
    Problems::add(fmt::format("{}:{}", file_, line), std::move(message));
  }

 private:
  std::string_view file_;
};

std::string_view without_blanks(std::string_view cell) {
  const auto first = cell.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(" \t") - first + 1);
}

/// The cells of one line, blanks around each removed.
std::vector<std::string_view> split_csv_line(std::string_view line) {
  std::vector<std::string_view> cells = split(line, ',');
  for (std::string_view& cell : cells) cell = without_blanks(cell);
  return cells;
}

/// Takes the next line, without its end, off the front of `text`.
std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// What a message can show of a cell: short, and without bytes that would disturb a terminal.
std::string shown_cell(std::string_view cell) {
  constexpr std::size_t longest = 40;
  std::string text(cell.substr(0, longest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return cell.size() > longest ? text + "…" : text;
}

std::vector<std::string> names_of(std::span<const CsvColumn> wanted) {
  std::vector<std::string> names;
  for (const CsvColumn& column : wanted) names.emplace_back(column.name);
  return names;
}

std::string_view name_in_file(const CsvColumn& column) {
  return column.header.empty() ? column.name : std::string_view(column.header);
}

/// The column as messages call it.
std::string shown_name(const CsvColumn& column) {
  return column.header.empty() ? std::string(column.name)
                               : fmt::format("{} ({})", column.name, shown_cell(column.header));
}

bool has_other_separators(std::string_view header) {
  return header.find(',') == std::string_view::npos &&
         header.find_first_of(";\t") != std::string_view::npos;
}

/// For each cell of a row, which wanted column it fills, if any.
using CellMeaning = std::vector<std::optional<std::size_t>>;

/// Throws where anything is wrong with the header: every further message would only confuse.
CellMeaning read_header(std::string_view line, std::string_view file,
                        std::span<const CsvColumn> wanted, OtherCsvColumns others,
                        std::string_view hint) {
  CellProblems problems(file, most_header_problems);
  const std::vector<std::string> known = names_of(wanted);
  CellMeaning meaning;
  std::vector<bool> found(wanted.size(), false);
  bool all_known = true;
  for (const std::string_view name : split_csv_line(line)) {
    const auto match = std::ranges::find_if(wanted, [&](const CsvColumn& column) {
      return !column.absent && name_in_file(column) == name;
    });
    if (match == wanted.end()) {
      meaning.emplace_back();
      if (others == OtherCsvColumns::ignored) continue;
      problems.add(
          1, fmt::format("unknown column \"{}\"{}", shown_cell(name), did_you_mean(name, known)));
      all_known = false;
      continue;
    }
    const auto index = static_cast<std::size_t>(match - wanted.begin());
    if (found[index]) problems.add(1, fmt::format("column \"{}\" appears twice", name));
    found[index] = true;
    meaning.emplace_back(index);
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i].required && !found[i]) {
      problems.add(1, fmt::format("column \"{}\" is missing from the header", wanted[i].name));
    }
  }
  if (!all_known) {
    problems.add(1, fmt::format("known columns are {}{}", fmt::join(known, ","), hint));
  }
  problems.throw_if_any();
  return meaning;
}

std::string allowed_values(const CsvColumn& column) {
  if (column.minimum == CsvColumn{}.minimum) return fmt::format("at most {}", column.maximum);
  if (column.maximum == CsvColumn{}.maximum) return fmt::format("at least {}", column.minimum);
  return fmt::format("{} to {}", column.minimum, column.maximum);
}

/// Puts the number in `cell` below those `above` it; a cell that may not stand there is a problem.
void take_cell(std::string_view cell, const CsvColumn& column, std::size_t line,
               std::vector<double>& above, CellProblems& problems) {
  const auto reject = [&](const std::string& expected) {
    const std::string found = cell.empty() ? "empty" : "\"" + shown_cell(cell) + "\"";
    problems.add(line, fmt::format("{} is {}, expected {}", shown_name(column), found, expected));
  };
  double value = 0;
  const auto [end, error] = read_number(cell.data(), cell.data() + cell.size(), value);
  if (end != cell.data() + cell.size() || error == std::errc::invalid_argument) {
    return reject("a number such as -1.25");
  }
  if (error == std::errc::result_out_of_range || !std::isfinite(value)) {
    return reject("a finite number");
  }
  value = column.factor * value + column.offset;
  if (value < column.minimum || value > column.maximum) return reject(allowed_values(column));
  if (column.increasing && !above.empty() && value <= above.back()) {
    return problems.add(line, fmt::format("{} is {}, expected more than the {} before it",
                                          shown_name(column), value, above.back()));
  }
  above.push_back(value);
}

}  // namespace

std::vector<std::vector<double>> read_csv_columns(std::string_view text, std::string_view file_name,
                                                  std::span<const CsvColumn> wanted,
                                                  OtherCsvColumns others, std::string_view hint) {
  CellProblems problems(file_name);
  text = without_byte_order_mark(text);
  if (text.empty()) {
    problems.add(1, fmt::format("the file is empty, expected the header {}",
                                fmt::join(names_of(wanted), ",")));
    problems.throw_if_any();
  }
  const std::string_view header = take_line(text);
  if (has_other_separators(header)) {
    problems.add(1,
                 "semicolons or tabs separate the cells; expected commas, and points in numbers");
    problems.throw_if_any();
  }
  const CellMeaning meaning = read_header(header, file_name, wanted, others, hint);

  std::vector<std::vector<double>> columns(wanted.size());
  std::size_t line_number = 1;
  text = text.substr(0, text.find_last_not_of("\r\n") + 1);  // blank lines may end a file
  if (text.empty()) problems.add(line_number, "there are no rows below the header");
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    ++line_number;
    const auto cells = split_csv_line(line);
    if (cells.size() != meaning.size()) {
      problems.add(line_number, fmt::format("{} cells in the row, expected {} as in the header",
                                            line.empty() ? 0 : cells.size(), meaning.size()));
      continue;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!meaning[i] || wanted[*meaning[i]].ignored) continue;
      take_cell(cells[i], wanted[*meaning[i]], line_number, columns[*meaning[i]], problems);
    }
  }
  problems.throw_if_any();
  return columns;
}

std::vector<std::string> csv_header(std::string_view text) {
  text = without_byte_order_mark(text);
  std::vector<std::string> names;
  for (const std::string_view name : split_csv_line(take_line(text))) names.emplace_back(name);
  return names;
}

CsvRows::CsvRows(std::string_view text, std::string file, char separator)
    : rest_(without_byte_order_mark(text)), file_(std::move(file)), separator_(separator) {}

std::string CsvRows::where() const { return fmt::format("{}:{}", file_, row_line_); }

std::string CsvRows::quoted_cell() {
  std::string cell;
  const std::size_t begin_line = line_;
  rest_.remove_prefix(1);
  while (true) {
    const std::size_t quote = rest_.find('"');
    if (quote == std::string_view::npos) {
      throw InputError(fmt::format("{}:{}", file_, begin_line), "a quote is opened and not closed");
    }
    line_ += std::size_t(std::count(rest_.begin(), rest_.begin() + std::ptrdiff_t(quote), '\n'));
    cell += rest_.substr(0, quote);
    rest_.remove_prefix(quote + 1);
    if (!rest_.starts_with('"')) return cell;
    cell += '"';
    rest_.remove_prefix(1);
  }
}

bool CsvRows::next(std::vector<std::string>& cells) {
  cells.clear();
  while (rest_.starts_with('\n') || rest_.starts_with("\r\n")) {
    rest_.remove_prefix(rest_.find('\n') + 1);
    ++line_;
  }
  if (rest_.empty()) return false;
  row_line_ = line_;
  const std::string ends{separator_, '\n'};
  while (true) {
    if (rest_.starts_with('"')) {
      cells.push_back(quoted_cell());
      if (!rest_.empty() && rest_.find_first_of(ends + "\r") != 0) {
        throw InputError(
            fmt::format("{}:{}", file_, line_),
            fmt::format("there is text after the quoted cell \"{}\"", cells.back().substr(0, 40)));
      }
    } else {
      const std::size_t end = std::min(rest_.find_first_of(ends), rest_.size());
      std::string_view cell = rest_.substr(0, end);
      if (cell.ends_with('\r') && !rest_.substr(end).starts_with(separator_)) cell.remove_suffix(1);
      cells.emplace_back(cell);
      rest_.remove_prefix(end);
    }
    if (rest_.starts_with(separator_)) {
      rest_.remove_prefix(1);
      continue;
    }
    if (rest_.starts_with('\r')) rest_.remove_prefix(1);
    if (rest_.starts_with('\n')) {
      rest_.remove_prefix(1);
      ++line_;
    }
    return true;
  }
}

}  // namespace tethercalc
