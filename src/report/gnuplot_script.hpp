// Pieces of gnuplot scripts that all figures are put together from.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// A number as gnuplot reads it: seven significant digits, `NaN` where it does not exist.
[[nodiscard]] std::string number(double value);

/// Columns of a data block.
using Columns = std::vector<std::span<const double>>;

/// A named block of inline data, `$name << EOD`, one row an element of the columns.
[[nodiscard]] std::string data_block(std::string_view name, const Columns& columns);

/// Style of a line: colour, dash type 1 (solid) to 5, and width in points.
[[nodiscard]] std::string line(std::string_view colour, int dash, double width = 1.2);

/// Style of points: gnuplot's point type and a size.
[[nodiscard]] std::string point(std::string_view colour, int type, double size = 0.6);

/// What every figure's script begins with: encoding, literal texts, thin frame and ticks.
[[nodiscard]] std::string prelude();

/// A range that leaves `margin` of its length free on both sides of [lo, hi]; where that is empty,
/// one around it.
struct Range {
  double lo = 0;
  double hi = 1;
};
[[nodiscard]] Range with_margin(double lo, double hi, double margin = 0.05);

/// The least and greatest finite value; {0, 1} where there is none.
[[nodiscard]] Range extent(std::span<const double> values);

/// "set xrange [lo:hi]" of `axis` ("x", "y", "x2" …), with its newline.
[[nodiscard]] std::string set_range(std::string_view axis, Range range);

}  // namespace tethercalc::gnuplot
