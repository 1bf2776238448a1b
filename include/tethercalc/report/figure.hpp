// A picture of a result as plain data: what stands on which axes, and in words. Drawers of several
// kinds make a file of it; see `render`.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tethercalc {

/// The pieces of a figure. All texts are plain: drawers make them fit, cut them with "…" where they
/// do not, and quote them for their formats. A number that does not exist (NaN) is a gap.
namespace plot {

/// The eight colours of Okabe and Ito (2008), told apart with every common kind of colour vision.
enum class Colour { ink, orange, sky, green, blue, vermilion, purple, grey };

/// So that lines differ where there are no colours.
enum class Dash { solid, dashed, dotted, dash_dotted, dash_dot_dotted };

/// What stands at a point. Specks (tiny dots) and crosses (tiny ×) are for hundreds of them.
enum class Mark { speck, cross, dot, circle, diamond, square, triangle, plus };

/// What an axis shows, `lo` < `hi`.
struct Range {
  double lo = 0;  ///< where it begins
  double hi = 1;  ///< where it ends
};

/// A place on an axis with its words, which may be empty.
struct Tick {
  double at = 0;        ///< on the axis
  std::string words{};  ///< beside it
};

/// An axis of a panel.
struct Axis {
  std::string label{};        ///< quantity and unit: "thrust per motor (g)"
  Range range{};              ///< above zero where logarithmic
  bool logarithmic = false;   ///< ticks are then at 1, 2 and 5 times the powers of ten
  std::vector<Tick> ticks{};  ///< empty: round numbers. Else these within the range, the important
                              ///< first: words that would touch earlier ones are left out
  bool numbers = true;        ///< false: ticks have no words, or there is nothing to count
};

/// A line through points in their order.
struct Curve {
  std::vector<double> x{};           ///< horizontal places
  std::vector<double> y{};           ///< as many vertical ones
  Colour colour = Colour::ink;       ///< of the line
  Dash dash = Dash::solid;           ///< of the line
  double width = 1;                  ///< times 0.75 pt
  std::string words{};               ///< in the legend; empty: not there
  std::vector<std::string> cells{};  ///< further columns of the legend, as `Panel::legend_heads`
  std::string label{};               ///< at that end of the line where there is more room
};

/// Points, each on its own.
struct Points {
  std::vector<double> x{};       ///< horizontal places
  std::vector<double> y{};       ///< as many vertical ones
  Mark mark = Mark::dot;         ///< at each of them
  Colour colour = Colour::ink;   ///< of all marks
  std::string words{};           ///< in the legend; empty: not there
  std::vector<double> sizes{};   ///< times the usual size, one a point; empty: 1
  std::vector<double> values{};  ///< by `Panel::scale` the colours, one a point; empty: `colour`
};

/// The area between two lines.
struct Band {
  std::vector<double> x{};       ///< horizontal places
  std::vector<double> lower{};   ///< as many vertical ones below
  std::vector<double> upper{};   ///< and above
  Colour colour = Colour::grey;  ///< shown pale
  std::string words{};           ///< in the legend; empty: not there
};

/// A stretch of the horizontal axis, over the panel's whole height.
struct Span {
  Range range{};                  ///< on the axis
  Colour colour = Colour::green;  ///< shown pale
  std::string words{};            ///< in the legend; empty: not there
};

/// A line across the panel at one number of an axis.
struct Reference {
  double at = 0;                 ///< on the axis
  bool vertical = false;         ///< at a number of the horizontal axis
  Colour colour = Colour::grey;  ///< of the line
  Dash dash = Dash::solid;       ///< of the line
  std::string words{};           ///< beside a vertical line, near its lower end; empty: nothing
};

/// Words around a point.
struct Note {
  double x = 0;         ///< horizontal place
  double y = 0;         ///< vertical place
  std::string words{};  ///< with their middle there
};

/// A rectangle of a heat map.
struct Cell {
  Range x{};                                                ///< from its left to its right side
  Range y{};                                                ///< from its lower to its upper side
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: grey
};

/// A heat map, coloured by `Panel::scale`.
struct Cells {
  std::vector<Cell> cells{};    ///< which do not overlap
  std::string words_of_grey{};  ///< what grey means, in the legend; empty: not there
};

/// What is drawn, later ones over earlier ones.
using Layer = std::variant<Curve, Points, Band, Span, Reference, Note, Cells>;

/// What the colours of a heat map mean: viridis of matplotlib (van der Walt and Smith 2015, public
/// domain) over the range, its lightness rising evenly.
struct ColourScale {
  std::string label{};  ///< quantity and unit
  Range range{};        ///< darkest to lightest
};

/// A frame with axes.
struct Panel {
  std::string title{};        ///< above it; may be empty
  Axis x{};                   ///< horizontal axis, along the lower edge
  Axis y{};                   ///< vertical axis, along the left edge
  std::optional<Axis> top{};  ///< ticks along the upper edge, at numbers of `x`
  std::string remark{};       ///< above the right end, where there is no `top`
  double lines = 14;          ///< height of its frame in lines of text, in one column
  bool beside = false;        ///< right of the panel before it, whose `y` it shares; not the first
  std::vector<Layer> layers{};              ///< what stands on the axes
  std::vector<std::string> legend_heads{};  ///< above further columns of the legend
  std::vector<std::string> key{};           ///< further lines of the legend, without a sample
  std::optional<ColourScale> scale{};       ///< of `Cells` and of `Points::values`
};

/// One of several shares.
struct Bar {
  std::string words{};          ///< what it is a share of
  double share = 0;             ///< 0 to 1; what is beyond is cut off
  std::string number{};         ///< the share in digits
  Colour colour = Colour::ink;  ///< of the bar
};

/// Horizontal bars, each below its words.
struct Bars {
  std::string title{};      ///< above them
  std::vector<Bar> bars{};  ///< from top to bottom
};

/// Lines of text.
struct Lines {
  std::string title{};               ///< above them
  std::vector<std::string> texts{};  ///< one a line
};

}  // namespace plot

/// A picture that has not been drawn yet. Every number comes from the result that it is made of.
struct Figure {
  std::string id{};           ///< letters and digits: "optimum"; begins the ids within its SVG
  std::string title{};        ///< one line
  std::string heading{};      ///< above the picture, shorter than the title; empty: the title
  std::string description{};  ///< what it shows with its main numbers, for those who cannot see it
  bool to_scale = false;      ///< one scale for all axes: ranges are widened around what they hold
  std::vector<std::variant<plot::Panel, plot::Bars, plot::Lines>> parts{};  ///< from top to bottom
};

/// What a figure is drawn as.
enum class FigureFormat {
  svg,     ///< UTF-8 text on a white panel, with title and description; neither scripts nor links
  png,     ///< at 300 dots per inch; needs gnuplot
  pdf,     ///< vectors, fonts embedded; needs gnuplot
  script,  ///< a gnuplot script with the data that draws the figure as a PDF on its own
  text,    ///< characters for a terminal
};

/// How large, and for what kind of terminal.
struct FigureSize {
  double width_mm = 85;  ///< 85, one column of a journal, to 400. Letters are 7.5 pt high at
                         ///< every width, so that a wider picture holds more, not larger ones
  int columns = 100;     ///< of `FigureFormat::text`, 40 to 400
  bool colour = false;   ///< of `FigureFormat::text`: with the colour codes of a terminal
};

/// Throws InputError about the option or place called `where` for a width that no figure has.
void check_figure_width(double width_mm, const std::string& where);

/// Runs gnuplot on a script and returns what it draws.
using GnuplotRunner = std::function<std::string(const std::string& script)>;

/// The drawn figure: the content of a file of that format. Only PNG and PDF are drawn by `gnuplot`,
/// whose errors are thrown on.
///
/// In the SVG every stroke and area takes its colour from the property `color` of an element whose
/// class is the colour's name ("ink", "blue" …; "paper" is the background), so that a page's style
/// may exchange them, for a dark screen such as.
[[nodiscard]] std::string render(const Figure& figure, FigureFormat format,
                                 const GnuplotRunner& gnuplot, const FigureSize& size = {});

/// The format that a file's suffix asks for: .svg, .png, .pdf, .gp (the script) or .txt. Throws
/// InputError with the allowed ones, about the option or place called `where`.
[[nodiscard]] FigureFormat figure_format(std::string_view file, const std::string& where);

}  // namespace tethercalc
