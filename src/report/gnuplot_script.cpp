#include "report/gnuplot_script.hpp"

#include <algorithm>
#include <cmath>

namespace tethercalc::gnuplot {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "NaN";
}

std::string data_block(std::string_view name, const Columns& columns) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      out += (c > 0 ? " " : "") + number(columns[c][row]);
    }
    out += "\n";
  }
  return out + "EOD\n";
}

std::string line(std::string_view colour, int dash, double width) {
  return fmt::format("lc rgb '{}' dt {} lw {}", colour, dash, width);
}

std::string point(std::string_view colour, int type, double size) {
  return fmt::format("lc rgb '{}' pt {} ps {}", colour, type, size);
}

std::string prelude() {
  // gnuplot's own settings are restored first, so that a script may follow another one.
  return "reset\n"
         "set encoding utf8\n"
         "set termoption noenhanced\n"
         "if (!exists('characters')) characters = 0\n"
         "set border lw 0.6\n"
         "set tics nomirror scale 0.6\n"
         "set key noautotitle samplen 2.5 spacing 1.0\n"
         "set datafile missing 'NaN'\n";
}

Range with_margin(double lo, double hi, double margin) {
  const double length = hi > lo ? hi - lo : std::max(1e-9, std::abs(hi));
  return {lo - margin * length, hi + margin * length};
}

Range extent(std::span<const double> values) {
  Range range{1, 0};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (range.lo > range.hi) {
      range = {value, value};
    } else {
      range = {std::min(range.lo, value), std::max(range.hi, value)};
    }
  }
  return range.lo > range.hi ? Range{} : range;
}

std::string set_range(std::string_view axis, Range range) {
  return fmt::format("set {}range [{}:{}]\n", axis, number(range.lo), number(range.hi));
}

}  // namespace tethercalc::gnuplot
