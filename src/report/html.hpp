// Pieces of HTML that is XML as well, so that whatever reads either can read it. Texts are plain
// texts of anybody; they are made fit for markup here and nowhere else.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tethercalc/report/figure.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc::html {

/// <name attributes>text</name>; `attributes` is markup, beginning with a space.
[[nodiscard]] std::string element(std::string_view name, std::string_view text,
                                  std::string_view attributes = "");

/// A paragraph a text.
[[nodiscard]] std::string paragraphs(std::span<const std::string> texts);

/// An unordered list.
[[nodiscard]] std::string list(std::span<const std::string> texts);

/// A table with its title, in a box that scrolls where it is too wide and that the keyboard
/// reaches; `id` is unique in the page. The first column heads its rows.
[[nodiscard]] std::string table(const TitledTable& table, std::string_view id);

/// Text in lines that stand as they are, in a box as above called `label`.
[[nodiscard]] std::string listing(std::string_view text, std::string_view label);

/// The figure as inline SVG, drawn by gnuplot; see `render`.
[[nodiscard]] std::string picture(const Figure& figure, const GnuplotRunner& gnuplot);

}  // namespace tethercalc::html
