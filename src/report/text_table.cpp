#include "tethercalc/report/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/characters.hpp"

namespace tethercalc {
namespace {

std::string in_colour(bool colour, const char* code, const std::string& text) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

std::pair<std::string, std::string> title_lines(const std::string& title) {
  const std::size_t end = title.find('\n');
  if (end == std::string::npos) return {title, ""};
  return {title.substr(0, end), title.substr(end + 1)};
}

}  // namespace

std::string TextStyle::bold(const std::string& text) const { return in_colour(colour, "1", text); }
std::string TextStyle::good(const std::string& text) const { return in_colour(colour, "32", text); }
std::string TextStyle::bad(const std::string& text) const { return in_colour(colour, "31", text); }
std::string TextStyle::subdued(const std::string& text) const {
  return in_colour(colour, "90", text);
}

void TextTable::add(std::vector<std::string> cells, bool emphasis) {
  cells.resize(columns_.size());
  rows_.push_back({std::move(cells), emphasis});
}

std::string TextTable::text(const TextStyle& style) const {
  std::vector<int> widths;
  std::vector<std::string> upper_titles;
  std::vector<std::string> lower_titles;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto [upper, lower] = title_lines(columns_[c].title);
    upper_titles.push_back(upper);
    lower_titles.push_back(lower);
    int width = std::max(columns_of(upper), columns_of(lower));
    for (const Row& row : rows_) width = std::max(width, columns_of(row.cells[c]));
    widths.push_back(width);
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string out = "  ";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (c > 0) out += "  ";
      const std::string padding(std::size_t(widths[c] - columns_of(cells[c])), ' ');
      out += columns_[c].align == Align::right ? padding + cells[c] : cells[c] + padding;
    }
    out.erase(out.find_last_not_of(' ') + 1);
    return out;
  };
  std::string out = style.subdued(line(upper_titles)) + "\n";
  if (!line(lower_titles).empty()) out += style.subdued(line(lower_titles)) + "\n";
  for (const Row& row : rows_) {
    out += (row.emphasis ? style.bold(line(row.cells)) : line(row.cells)) + "\n";
  }
  return out;
}

TextTable::Column word_column(std::string title) {
  return {std::move(title), TextTable::Align::left};
}

std::string TitledTable::text(const TextStyle& style) const {
  return "\n" + style.bold(title) + "\n" + table.text(style);
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool negative_zero = text.front() == '-' && text.find_first_not_of("-0.") == text.npos;
  return negative_zero ? text.substr(1) : text;
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fixed(value, std::max(0, digits - magnitude));
}

std::string wrapped(const std::string& text, std::size_t width, const std::string& indent) {
  // Not a stream: it would bring the library's locales into the page's program.
  constexpr const char* blanks = " \t\n\v\f\r";
  std::string out;
  std::string line = indent;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = text.find_first_not_of(blanks, end);
    const bool first = line.size() == indent.size();
    if (!first && columns_of(line) + 1 + columns_of(word) > int(width)) {
      out += line + "\n";
      line = indent + word;
    } else {
      line += (first ? "" : " ") + word;
    }
  }
  return out + line + "\n";
}

}  // namespace tethercalc
