#include "report/html.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "report/characters.hpp"

namespace tethercalc::html {
namespace {

/// Titles of columns may take two lines.
std::string title_text(const std::string& title) {
  std::string out = markup_text(title);
  const std::size_t line_end = out.find('\n');
  if (line_end != std::string::npos) out.replace(line_end, 1, "<br/>");
  return out;
}

std::string header_row(const TextTable& table) {
  std::string out = "<tr>";
  for (const TextTable::Column& column : table.columns()) {
    const char* side = column.align == TextTable::Align::right ? " class=\"n\"" : "";
    // A header without a word would be read out as one.
    out += column.title.empty()
               ? "<td></td>"
               : fmt::format("<th scope=\"col\"{}>{}</th>", side, title_text(column.title));
  }
  return out + "</tr>\n";
}

std::string body_row(const TextTable& table, const TextTable::Row& row) {
  constexpr std::size_t longest_word = 32;  // characters that stay in one line
  std::string out = row.emphasis ? "<tr class=\"main\">" : "<tr>";
  for (std::size_t c = 0; c < row.cells.size(); ++c) {
    const std::string& cell = row.cells[c];
    const bool number = table.columns()[c].align == TextTable::Align::right;
    const char* kind = number ? "n" : display_width(cell) <= longest_word ? "word" : "prose";
    out += c == 0 ? element("th", cell, fmt::format(" scope=\"row\" class=\"{}\"", kind))
                  : element("td", cell, fmt::format(" class=\"{}\"", kind));
  }
  return out + "</tr>\n";
}

}  // namespace

std::string element(std::string_view name, std::string_view text, std::string_view attributes) {
  return fmt::format("<{0}{1}>{2}</{0}>", name, attributes, markup_text(text));
}

std::string paragraphs(std::span<const std::string> texts) {
  std::string out;
  for (const std::string& text : texts) out += element("p", text) + "\n";
  return out;
}

std::string list(std::span<const std::string> texts) {
  std::string out = "<ul>\n";
  for (const std::string& text : texts) out += element("li", text) + "\n";
  return out + "</ul>\n";
}

std::string table(const TitledTable& table, std::string_view id) {
  std::string rows;
  for (const TextTable::Row& row : table.table.rows()) rows += body_row(table.table, row);
  return fmt::format(
      "<figure>\n{}\n<div class=\"scroll\" role=\"region\" aria-labelledby=\"{}\" tabindex=\"0\">\n"
      "<table aria-labelledby=\"{}\">\n<thead>\n{}</thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n"
      "</figure>\n",
      element("figcaption", table.title, fmt::format(" id=\"{}\"", id)), id, id,
      header_row(table.table), rows);
}

std::string listing(std::string_view text, std::string_view label) {
  return fmt::format("{}\n", element("pre", text,
                                     fmt::format(" class=\"scroll\" role=\"region\" "
                                                 "aria-label=\"{}\" tabindex=\"0\"",
                                                 markup_text(label))));
}

std::string picture(const Figure& figure, const GnuplotRunner& gnuplot) {
  std::string svg = render(figure, FigureFormat::svg, gnuplot);
  const std::size_t root = svg.find("<svg ");
  if (root == std::string::npos) throw std::runtime_error("gnuplot wrote no SVG");
  svg.erase(0, root);
  // Titles that gnuplot numbers its curves by would show up under the pointer.
  const std::string_view begin = "<title>";
  const std::string_view end = "</title>";
  for (std::size_t at = 0; (at = svg.find(begin, at)) != std::string::npos;) {
    svg.erase(at, svg.find(end, at) + end.size() - at);
  }
  return "<figure class=\"picture\">\n" + svg + "</figure>\n";
}

}  // namespace tethercalc::html
