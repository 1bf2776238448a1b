// A picture of a result: what it shows in words, and the gnuplot commands that draw it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace tethercalc {

/// A picture that has not been drawn yet: commands and data in one text, without any terminal.
///
/// Every text that came from a user (names of designs, motors, logs) is quoted by `gnuplot_text`,
/// and every number comes from the result that the figure is made of; one that does not exist is a
/// gap in its curve.
struct Figure {
  std::string id;           ///< letters and digits: "optimum"; begins the ids within its SVG
  std::string title;        ///< one line
  std::string description;  ///< what it shows with its main numbers, for those who cannot see it
  int lines = 24;           ///< height in lines of text at one column's width (85 mm); the picture
                            ///< keeps its proportions at other widths
  std::string script{};     ///< gnuplot commands with their data inline
};

/// What a figure is drawn as.
enum class FigureFormat {
  svg,     ///< UTF-8 text on a white panel, with title and description; neither scripts nor links
  png,     ///< at 300 dots per inch
  pdf,     ///< vectors, fonts embedded
  script,  ///< a gnuplot script that draws the figure as a PDF on its own
  text,    ///< characters for a terminal
};

/// How large, and for what kind of terminal.
struct FigureSize {
  double width_mm = 85;  ///< 85, one column of a journal, to 400. Letters are 7.5 pt high at
                         ///< every width, so that a wider picture holds more, not larger ones
  int columns = 100;     ///< of `FigureFormat::text`, 40 to 400
  bool colour = false;   ///< of `FigureFormat::text`: with the colour codes of a terminal
};

/// Runs gnuplot on a script and returns what it draws.
using GnuplotRunner = std::function<std::string(const std::string& script)>;

/// The drawn figure: the content of a file of that format. The script needs no gnuplot; everything
/// else is drawn by `gnuplot`, whose errors are thrown on.
[[nodiscard]] std::string render(const Figure& figure, FigureFormat format,
                                 const GnuplotRunner& gnuplot, const FigureSize& size = {});

/// The format that a file's suffix asks for: .svg, .png, .pdf, .gp (the script) or .txt. Throws
/// InputError with the allowed ones, about the option or place called `where`.
[[nodiscard]] FigureFormat figure_format(std::string_view file, const std::string& where);

/// `text` as an expression of gnuplot that is nothing but text, quotes included, for use where
/// enhanced text is off: between single quotes gnuplot substitutes neither commands in backquotes
/// nor macros. A single quote within becomes ."'". between two literals: doubled, as the manual
/// has it, gnuplot 5.4 takes it for the literal's end where it is the first or follows another.
/// Line breaks become spaces; control characters and what is no UTF-8 become U+FFFD; more than
/// `longest` characters are cut and end in "…".
[[nodiscard]] std::string gnuplot_text(std::string_view text, std::size_t longest = 60);

}  // namespace tethercalc
