#include "io/csv_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {

CsvRows::CsvRows(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

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
  while (true) {
    if (rest_.starts_with('"')) {
      cells.push_back(quoted_cell());
      if (!rest_.empty() && rest_.find_first_of(",\r\n") != 0) {
        throw InputError(
            fmt::format("{}:{}", file_, line_),
            fmt::format("there is text after the quoted cell \"{}\"", cells.back().substr(0, 40)));
      }
    } else {
      const std::size_t end = std::min(rest_.find_first_of(",\n"), rest_.size());
      std::string_view cell = rest_.substr(0, end);
      if (cell.ends_with('\r') && !rest_.substr(end).starts_with(',')) cell.remove_suffix(1);
      cells.emplace_back(cell);
      rest_.remove_prefix(end);
    }
    if (rest_.starts_with(',')) {
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
