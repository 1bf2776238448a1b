#include "report/gnuplot_script.hpp"

#include <array>
#include <iterator>

#include "model/constants.hpp"

namespace tethercalc::gnuplot {

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

std::string_view curve_colour(std::size_t index) {
  constexpr std::array colours{colour::blue,   colour::vermilion, colour::green, colour::orange,
                               colour::purple, colour::sky,       colour::black};
  return colours[index % colours.size()];
}

std::string prelude() {
  // gnuplot's own settings are restored first, so that a script may follow another one.
  return "reset\n"
         "set encoding utf8\n"
         "set termoption noenhanced\n"
         "if (!exists('characters')) characters = 0\n"
         "if (!exists('dot_scale')) dot_scale = 1\n"
         "if (!exists('dot_length')) dot_length = 1\n"
         "set border lw 0.6\n"
         "set tics nomirror scale 0.6\n"
         "set key noautotitle samplen 2.6 Left reverse\n"
         "set datafile missing 'NaN'\n";
}

void Plot::dots(const std::string& block, int x, int y, double width, std::string_view colour,
                const std::string& words, double size) {
  add(fmt::format("{} using {}:{}:({}*dot_length):(0) with vectors nohead lc rgb '{}' lw {}", block,
                  x, y, number(width), colour, size));
  // Elsewhere far outside of the frame: gnuplot warns of points that do not exist.
  add(fmt::format("{} using {}:(characters ? ${} : 1e30) with points pt {}", block, x, y,
                  ++letters_),
      words);
  if (!words.empty()) {
    legend_.push_back({LegendEntry::Sample::point, point(colour, 5, 0.35 * size), words});
  }
}

Layout Layout::column(bool second) const {
  constexpr double gap = 0.08;  // of the width
  const double width = (1 - left_ - right_ - gap) / 2;
  Layout out = *this;
  if (second) {
    out.left_ = left_ + width + gap;
    out.edge_ = out.left_;
  } else {
    out.right_ = right_ + width + gap;
    out.edge_ = left_;
  }
  return out;
}

std::string Layout::legend(double top, std::size_t columns,
                           std::span<const LegendEntry> entries) const {
  std::string out = fmt::format(
      "if (characters) {{\n  set key at screen {:.4f},{:.4f} left top horizontal maxcols {}\n"
      "}} else {{\n  unset key\n",
      left_, height(top - 0.5), columns);
  // Of the picture's width.
  constexpr double sample = 0.065;
  constexpr double cell = 0.115;
  constexpr double letter = 0.0175;  // 7.5 pt in one column
  const double start = 0.02;
  const double width = (1 - start) / double(columns);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const LegendEntry& entry = entries[i];
    const double x = start + width * double(i % columns);
    const double y = height(top + double(i / columns));
    switch (entry.sample) {
      case LegendEntry::Sample::none:
        break;
      case LegendEntry::Sample::line:
        out += fmt::format(
            "  set arrow {} from screen {:.4f},{:.4f} to screen {:.4f},{:.4f} nohead {}\n",
            1000 + i, x, y, x + sample, y, entry.style);
        break;
      case LegendEntry::Sample::point:
        out += fmt::format("  set label {} '' at screen {:.4f},{:.4f} point {}\n", 2000 + i,
                           x + sample / 2, y, entry.style);
        break;
      case LegendEntry::Sample::area:
        out += fmt::format(
            "  set object {} rectangle from screen {:.4f},{:.4f} to screen {:.4f},{:.4f} {}\n",
            1000 + i, x, y - 0.4 / lines_, x + sample, y + 0.4 / lines_, entry.style);
        break;
    }
    const double cells = cell * double(entry.cells.size());
    const double letters = (width - sample - 0.02 - cells) / letter;
    out += fmt::format("  set label {} {} at screen {:.4f},{:.4f} left\n", 1000 + i,
                       gnuplot_text(entry.words, std::size_t(letters)), x + sample + 0.015, y);
    for (std::size_t c = 0; c < entry.cells.size(); ++c) {
      const double right = 1 - right_ - cell * double(entry.cells.size() - 1 - c);
      out += fmt::format("  set label {} {} at screen {:.4f},{:.4f} right\n", 3000 + 10 * i + c,
                         gnuplot_text(entry.cells[c]), right, y);
    }
  }
  return out + "}\n";
}

Series outline(std::span<const double> x, std::span<const double> y, std::size_t bins) {
  Series out;
  if (x.size() < 2) return out;
  constexpr double gap = 5;  // mean steps
  const double mean_step = (x.back() - x.front()) / double(x.size() - 1);
  const double width = (x.back() - x.front()) / double(bins);
  for (std::size_t first = 0; first < x.size();) {
    std::size_t last = first;
    std::size_t least = first;
    std::size_t most = first;
    while (last + 1 < x.size() && x[last + 1] < x[first] + width &&
           x[last + 1] - x[last] <= gap * mean_step) {
      ++last;
      if (y[last] < y[least]) least = last;
      if (y[last] > y[most]) most = last;
    }
    std::vector<std::size_t> kept{first, std::min(least, most), std::max(least, most), last};
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) {
      out.x.push_back(x[i]);
      out.y.push_back(y[i]);
    }
    if (last + 1 < x.size() && x[last + 1] - x[last] > gap * mean_step) {
      out.x.push_back(x[last]);
      out.y.push_back(nan);
    }
    first = last + 1;
  }
  return out;
}

Range bulk(std::span<const double> values, double outlying) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  const auto skipped = std::size_t(outlying * double(sorted.size()));
  const Range most = with_margin({sorted[skipped], sorted[sorted.size() - 1 - skipped]}, 0.25);
  return with_margin({std::max(sorted.front(), most.lo), std::min(sorted.back(), most.hi)});
}

std::string set_tics(std::string_view axis, Range range, int most) {
  const double least = (range.hi - range.lo) / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  double step = 10 * power;
  for (const double digit : {5.0, 2.0, 1.0}) {
    if (digit * power >= least) step = digit * power;
  }
  return fmt::format("set {}tics {}\n", axis, number(step));
}

}  // namespace tethercalc::gnuplot
