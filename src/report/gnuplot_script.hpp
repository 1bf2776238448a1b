// Pieces of gnuplot scripts that all figures are put together from.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::gnuplot {

/// The eight colours of Okabe and Ito (2008), told apart with every common kind of colour vision,
/// by what they stand for in all figures.
namespace colour {
inline constexpr std::string_view black = "#000000";
inline constexpr std::string_view orange = "#E69F00";
inline constexpr std::string_view sky = "#56B4E9";
inline constexpr std::string_view green = "#009E73";
inline constexpr std::string_view blue = "#0072B2";
inline constexpr std::string_view vermilion = "#D55E00";
inline constexpr std::string_view purple = "#CC79A7";
inline constexpr std::string_view grey = "#999999";
}  // namespace colour

/// Width of a picture of one column, and height of one of its lines: 7.5 pt and the space between.
inline constexpr double column_mm = 85;
inline constexpr double line_mm = 3.2;

/// A number as gnuplot reads it: seven significant digits, `NaN` where it does not exist.
[[nodiscard]] inline std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "NaN";
}

/// Columns of a data block.
using Columns = std::vector<std::span<const double>>;

/// A named block of inline data, `$name << EOD`, one row an element of the columns.
[[nodiscard]] std::string data_block(std::string_view name, const Columns& columns);

/// One number of each of `rows`.
template <typename Row>
[[nodiscard]] std::vector<double> column(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> out;
  for (const Row& row : rows) out.push_back(row.*member);
  return out;
}

/// A block with these numbers of each of `rows`.
template <typename Row>
[[nodiscard]] std::string data_block(std::string_view name, const std::vector<Row>& rows,
                                     std::initializer_list<double Row::*> members) {
  std::vector<std::vector<double>> columns;
  for (double Row::*const member : members) columns.push_back(column(rows, member));
  return data_block(name, Columns(columns.begin(), columns.end()));
}

/// Draws the line at zero, thinly.
inline constexpr const char* zero_line = "set xzeroaxis lt 1 lc rgb '#999999' lw 0.5\n";

/// Style of a line: colour, dash type 1 (solid) to 5, and width in points.
[[nodiscard]] inline std::string line(std::string_view colour, int dash, double width = 1.2) {
  return fmt::format("lc rgb '{}' dt {} lw {}", colour, dash, width);
}

/// Colour and dashes of the curve with that index: together they tell 35 apart.
[[nodiscard]] std::string_view curve_colour(std::size_t index);
[[nodiscard]] inline std::string curve_line(std::size_t index, double width) {
  return line(curve_colour(index), int(index % 5) + 1, width);
}

/// Style of points: gnuplot's point type and a size.
[[nodiscard]] inline std::string point(std::string_view colour, int type, double size = 0.6) {
  return fmt::format("lc rgb '{}' pt {} ps {}*dot_scale", colour, type, size);
}

/// Style of a shaded area.
[[nodiscard]] inline std::string area(std::string_view colour, double opacity = 0.15) {
  return fmt::format("fc rgb '{}' fillstyle solid {} noborder", colour, opacity);
}

/// What every figure's script begins with: encoding, literal texts, thin frame and ticks.
[[nodiscard]] std::string prelude();

/// An entry of a legend.
struct LegendEntry {
  enum class Sample { none, line, point, area };
  Sample sample = Sample::line;      ///< what stands before the words
  std::string style;                 ///< as from `line`, `point` or `area`
  std::string words;                 ///< plain text
  std::vector<std::string> cells{};  ///< further texts, in columns that end at the right margin
};

/// A `plot` command under construction, with its legend.
class Plot {
 public:
  /// `data` as in "$curves using 1:2"; without words it stays out of the legend.
  void curve(const std::string& data, const std::string& style, const std::string& words = "") {
    add(data + " with lines " + style, words);
    if (!words.empty()) legend_.push_back({LegendEntry::Sample::line, style, words});
  }
  void points(const std::string& data, const std::string& style, const std::string& words = "") {
    add(data + " with points " + style, words);
    if (!words.empty()) legend_.push_back({LegendEntry::Sample::point, style, words});
  }

  /// Many small dots, of columns `x` and `y` of a block, such as "$samples"; `width` is a dot's in
  /// the unit of x in one column. They are strokes, which take a fifth of the room of points in a
  /// file, and letters where characters are all there is.
  void dots(const std::string& block, int x, int y, double width, std::string_view colour,
            const std::string& words = "", double size = 1.3);

  /// One point, unless a coordinate does not exist.
  void mark(double x, double y, const std::string& style, const std::string& words = "") {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    points(fmt::format("'+' using ({}):({}) every ::0::0", number(x), number(y)), style, words);
  }

  /// Anything else; `part` without its title.
  void add(const std::string& part, const std::string& words = "") {
    parts_ += (parts_.empty() ? "" : ", \\\n  ") + part;
    if (!words.empty()) parts_ += " title " + gnuplot_text(words);
  }

  /// A legend entry of something that is not plotted here.
  void entry(LegendEntry entry) { legend_.push_back(std::move(entry)); }

  /// The command, with its newline.
  [[nodiscard]] std::string text(std::string_view command = "plot") const {
    return fmt::format("{} {}\n", command, parts_);
  }
  [[nodiscard]] std::span<const LegendEntry> legend() const { return legend_; }

 private:
  std::string parts_;
  std::vector<LegendEntry> legend_;
  int letters_ = 0;  ///< used by dots
};

/// Places plots and texts by lines of text, counted from the top of the picture, so that they keep
/// out of each other's way in every terminal. Labels and arrows of a plot have tags below 100;
/// those from 100 on are made here.
class Layout {
 public:
  /// `lines` is the height of the picture, `left` and `right` the margins as shares of its width.
  explicit Layout(int lines, double left = 0.125, double right = 0.03)
      : lines_(lines), left_(left), right_(right) {}

  /// Begins a plot with its frame from line `top` to line `bottom`; no label, arrow or shading of
  /// an earlier one remains.
  [[nodiscard]] std::string panel(double top, double bottom) const {
    return fmt::format(
        "unset label\nunset arrow\nunset object\nunset xlabel\nunset ylabel\n"
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
        left_, 1 - right_, height(top), height(bottom));
  }

  /// Height over width of the frame of a plot from line `top` to line `bottom`.
  [[nodiscard]] double shape_of_panel(double top, double bottom) const {
    return (bottom - top) * line_mm / ((1 - left_ - right_) * column_mm);
  }

  /// The layout of one of two columns of equal plots, `second` or not, that share a vertical axis:
  /// its numbers stand left of the first only.
  [[nodiscard]] Layout column(bool second) const;

  /// A line of text from the left edge of the picture on.
  [[nodiscard]] std::string title(double at, const std::string& words) const {
    return fmt::format("set label 104 {} at screen 0.01,{:.4f} left\n", gnuplot_text(words, 54),
                       height(at));
  }

  /// Texts along the edges of the plot: at the left end of line `at` what its vertical axis shows,
  /// which needs no rotated letters so, and at the right end what its upper axis shows.
  [[nodiscard]] std::string above(double at, const std::string& left,
                                  const std::string& right = "") const {
    return fmt::format(
        "set label 100 {} at screen {:.4f},{:.4f} left\nset label 101 {} at screen {:.4f},{:.4f} "
        "right\n",
        gnuplot_text(left), edge_, height(at), gnuplot_text(right), 1 - right_, height(at));
  }

  /// What the horizontal axis shows, in the middle of line `at`.
  [[nodiscard]] std::string below(double at, const std::string& words) const {
    return fmt::format("set label 102 {} at screen {:.4f},{:.4f} center\n", gnuplot_text(words),
                       (left_ + 1 - right_) / 2, height(at));
  }

  /// The legend from line `top` on, in `columns` columns, filled row by row. Where characters are
  /// all there is, gnuplot's own key takes its place, from the titles of the plot.
  [[nodiscard]] std::string legend(double top, std::size_t columns,
                                   std::span<const LegendEntry> entries) const;

  /// The same below it, where characters are all there is.
  [[nodiscard]] std::string note_for_characters(double at, const std::string& words) const {
    return fmt::format("if (characters) {{\n  set label 105 {} at screen 0.01,{:.4f} left\n}}\n",
                       gnuplot_text(words, 54), height(at));
  }

  /// The scale of colours from line `top` to line `bottom`, as wide as the plot, its numbers below.
  [[nodiscard]] std::string colour_box(double top, double bottom) const {
    return fmt::format(
        "set colorbox horizontal user origin screen {:.4f},{:.4f} size screen {:.4f},{:.4f} "
        "border\n",
        left_, height(bottom), 1 - left_ - right_, height(top) - height(bottom));
  }

  /// A line of text in the middle of the picture's first line.
  [[nodiscard]] std::string heading(const std::string& words) const {
    return fmt::format("set label 103 {} at screen 0.5,{:.4f} center\n", gnuplot_text(words, 48),
                       height(0.9));
  }

 private:
  [[nodiscard]] double height(double line) const { return 1 - line / lines_; }

  int lines_;
  double left_;
  double right_;
  double edge_ = 0.01;  ///< where texts above a plot begin
};

/// What an axis shows.
struct Range {
  double lo = 0;
  double hi = 1;
};

/// A range that leaves `margin` of its length free on both sides of `range`; where that is empty,
/// one around it.
[[nodiscard]] inline Range with_margin(Range range, double margin = 0.05) {
  const auto [lo, hi] = range;
  const double length = hi > lo ? hi - lo : std::max(1e-9, std::abs(hi));
  return {lo - margin * length, hi + margin * length};
}

/// From the lesser beginning to the greater end.
[[nodiscard]] inline Range joint(Range a, Range b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// A series thinned for drawing: of every one of `bins` equal stretches of `x` the first, least,
/// greatest and last point, in their order, so that the drawn line covers what the whole one would.
/// Gaps of more than five times the mean step become a gap in the line. `x` rises.
struct Series {
  std::vector<double> x;
  std::vector<double> y;
};
[[nodiscard]] Series outline(std::span<const double> x, std::span<const double> y,
                             std::size_t bins = 300);

/// Every how manieth of `samples` is drawn so that there are at most `most`.
[[nodiscard]] inline std::size_t thinning(std::size_t samples, std::size_t most) {
  return samples <= most ? 1 : (samples + most - 1) / most;
}

/// The least and greatest finite value; {0, 1} where there is none.
[[nodiscard]] inline Range extent(std::span<const double> values) {
  Range range{1, 0};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range = range.lo > range.hi ? Range{value, value} : joint(range, {value, value});
  }
  return range.lo > range.hi ? Range{} : range;
}

/// The extent of `values` with a margin, but for the rare ones (`outlying` of them at either end)
/// that would flatten all the others: it reaches to those only as far as a quarter of the length
/// of the rest.
[[nodiscard]] Range bulk(std::span<const double> values, double outlying = 0.003);

/// "set xtics step" with a round step that makes at most `most` of them on [lo, hi].
[[nodiscard]] std::string set_tics(std::string_view axis, Range range, int most);

/// "set xrange [lo:hi]" of `axis` ("x", "y", "x2" …), with its newline.
[[nodiscard]] inline std::string set_range(std::string_view axis, Range range) {
  return fmt::format("set {}range [{}:{}]\n", axis, number(range.lo), number(range.hi));
}

}  // namespace tethercalc::gnuplot

namespace tethercalc {
namespace gp = gnuplot;
namespace colour = gnuplot::colour;
}  // namespace tethercalc
