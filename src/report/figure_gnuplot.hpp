// A figure as commands for gnuplot 5.4, with its data inline.
#pragma once

#include <string>
#include <string_view>

#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// The script that draws the figure as `format`, which is PNG, PDF or a script for others.
[[nodiscard]] std::string gnuplot_script(const Figure& figure, FigureFormat format,
                                         double width_mm);

/// `text` as an expression of gnuplot that is nothing but text, quotes included, for use where
/// enhanced text is off: between single quotes gnuplot substitutes neither commands in backquotes
/// nor macros. A single quote within becomes ."'". between two literals: doubled, as the manual
/// has it, gnuplot 5.4 takes it for the literal's end where it is the first or follows another.
/// Line breaks become spaces; control characters and what is no UTF-8 become U+FFFD.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

}  // namespace tethercalc
