// Panels are plots of their own with data, ranges and ticks; all other texts, the samples of the
// legend and bars stand in a last plot whose coordinates are pixels of the layout.
#include "report/figure_gnuplot.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "report/characters.hpp"
#include "report/figure_layout.hpp"
#include "report/figure_style.hpp"

namespace tethercalc {
namespace {

using plot::PlacedPanel;
using plot::PlacedTick;

constexpr double font_pt = 7.5;

/// The command that chooses and sizes the terminal.
std::string set_terminal(const plot::FigureLayout& layout, FigureFormat format) {
  if (format == FigureFormat::png) {
    constexpr double dots_a_pixel = 300.0 / 96;
    return fmt::format(
        "set terminal pngcairo noenhanced size {:.0f},{:.0f} font 'sans-serif,{}' fontscale {} "
        "linewidth {} pointscale {} dashlength 0.6 background '#ffffff'\n",
        dots_a_pixel * layout.width, dots_a_pixel * layout.height, font_pt, dots_a_pixel,
        dots_a_pixel, dots_a_pixel);
  }
  // The terminal makes 4/3 pt of a font's point.
  return fmt::format(
      "set terminal pdfcairo noenhanced size {:.3f}in,{:.3f}in font 'sans-serif,{}' "
      "fontscale 0.75 dashlength 0.6 background '#ffffff'\n",
      layout.width / 96, layout.height / 96, font_pt);
}

/// A number as gnuplot reads it.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "NaN";
}

/// A named block of rows; a row without a number parts lines, as gnuplot has it with empty ones.
std::string data_block(const std::string& name,
                       std::initializer_list<const std::vector<double>*> columns) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (std::size_t row = 0; row < (*columns.begin())->size(); ++row) {
    std::string line;
    bool whole = true;
    for (const std::vector<double>* column : columns) {
      whole = whole && std::isfinite((*column)[row]);
      line += (line.empty() ? "" : " ") + number((*column)[row]);
    }
    out += (whole ? line : "") + "\n";
  }
  return out + "EOD\n";
}

std::string line_style(plot::Colour colour, plot::Dash dash, double width) {
  return fmt::format("lc rgb '{}' dt {} lw {:g}", plot::colour_code(colour), int(dash) + 1, width);
}

std::string area_style(plot::Colour colour, double opacity) {
  return fmt::format("fc rgb '{}' fillstyle solid {} noborder", plot::colour_code(colour), opacity);
}

/// gnuplot's point type, and its size where ours is 1.
struct PointStyle {
  int type;
  double size;
};

PointStyle point_style(plot::Mark mark) {
  constexpr std::array<PointStyle, 8> styles{
      {{7, 0.13}, {2, 0.32}, {7, 0.6}, {6, 0.7}, {13, 1}, {5, 0.7}, {9, 1}, {1, 0.8}}};
  return styles.at(std::size_t(mark));
}

std::string point_words(plot::Mark mark, plot::Colour colour, double size) {
  const PointStyle style = point_style(mark);
  const double width = mark == plot::Mark::cross ? 0.5 : 1.2;
  return fmt::format("lc rgb '{}' pt {} ps {:g} lw {:g}", plot::colour_code(colour), style.type,
                     style.size * size, width);
}

/// The commands of one panel.
class PanelScript {
 public:
  PanelScript(const PlacedPanel& panel, std::size_t index, const plot::FigureLayout& layout)
      : panel_(panel), index_(index), layout_(layout) {}

  std::string text() {
    for (const plot::Layer& layer : panel_.panel->layers) {
      ++layer_;
      std::visit([this](const auto& one) { add(one); }, layer);
    }
    return data_ + frame() + objects_ + fmt::format("plot {}\n", parts_.empty() ? "NaN" : parts_);
  }

 private:
  [[nodiscard]] std::string name() const { return fmt::format("panel{}_{}", index_, layer_); }

  void part(const std::string& words) { parts_ += (parts_.empty() ? "" : ", \\\n  ") + words; }

  void add(const plot::Curve& curve) {
    // gnuplot warns of curves without a point within the frame.
    if (plot::visible_parts(curve, panel_.x, panel_.y).empty()) return;
    data_ += data_block(name(), {&curve.x, &curve.y});
    part(fmt::format("${} using 1:2 with lines {}", name(),
                     line_style(curve.colour, curve.dash, curve.width)));
  }

  void add(const plot::Points& points) {
    if (points.x.empty()) return;
    const PointStyle style = point_style(points.mark);
    if (!points.values.empty()) {
      data_ += data_block(name(), {&points.x, &points.y, &points.values});
      return part(fmt::format("${} using 1:2:3 with points pt {} ps {:g} lc palette", name(),
                              style.type, style.size));
    }
    if (!points.sizes.empty()) {
      data_ += data_block(name(), {&points.x, &points.y, &points.sizes});
      return part(fmt::format("${} using 1:2:({:g}*$3) with points pt {} ps variable lc rgb '{}'",
                              name(), style.size, style.type, plot::colour_code(points.colour)));
    }
    data_ += data_block(name(), {&points.x, &points.y});
    part(fmt::format("${} using 1:2 with points {}", name(),
                     point_words(points.mark, points.colour, 1)));
  }

  void add(const plot::Band& band) {
    data_ += data_block(name(), {&band.x, &band.lower, &band.upper});
    part(
        fmt::format("${} using 1:2:3 with filledcurves {}", name(), area_style(band.colour, 0.36)));
  }

  void add(const plot::Span& span) {
    const double lo = std::max(span.range.lo, panel_.x.range.lo);
    const double hi = std::min(span.range.hi, panel_.x.range.hi);
    if (!(lo < hi)) return;
    objects_ += fmt::format("set object rectangle from {},graph 0 to {},graph 1 behind {}\n",
                            number(lo), number(hi), area_style(span.colour, 0.18));
  }

  void add(const plot::Reference& line) {
    const plot::Range range = line.vertical ? panel_.x.range : panel_.y.range;
    if (!(line.at >= range.lo && line.at <= range.hi)) return;
    const std::string at = number(line.at);
    const std::string ends = line.vertical
                                 ? fmt::format("{0},graph 0 to {0},graph 1", at)
                                 : fmt::format("graph 0,first {0} to graph 1,first {0}", at);
    objects_ += fmt::format("set arrow from {} nohead back {}\n", ends,
                            line_style(line.colour, line.dash, 0.8));
  }

  void add(const plot::Note& /*words stand among the texts*/) {}

  void add(const plot::Cells& cells) {
    std::array<std::vector<double>, 5> columns;
    for (const plot::Cell& cell : cells.cells) {
      if (!std::isfinite(cell.value)) continue;
      const std::array row{cell.x.lo, cell.x.hi, cell.y.lo, cell.y.hi, cell.value};
      for (std::size_t c = 0; c < row.size(); ++c) columns[c].push_back(row[c]);
    }
    objects_ += fmt::format("set object rectangle from graph 0,0 to graph 1,1 behind {}\n",
                            area_style(plot::Colour::grey, 0.5));
    if (columns[0].empty()) return;
    data_ += data_block(name(), {&columns[0], &columns[1], &columns[2], &columns[3], &columns[4]});
    part(
        fmt::format("${} using (($1+$2)/2):(($3+$4)/2):1:2:3:4:5 with boxxyerror "
                    "fillstyle solid noborder lc palette",
                    name()));
  }

  [[nodiscard]] double across(double x) const { return x / layout_.width; }
  [[nodiscard]] double up(double y) const { return 1 - y / layout_.height; }

  static std::string ticks(std::string_view axis, const std::vector<PlacedTick>& ticks) {
    if (ticks.empty()) return fmt::format("unset {}tics\n", axis);
    std::string list;
    for (const PlacedTick& tick : ticks) {
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", gnuplot_text(tick.words),
                          number(tick.at));
    }
    return fmt::format("set {}tics ({}) out nomirror scale 0.6 offset {}\n", axis, list,
                       axis == "y"    ? "0.6,0"
                       : axis == "x2" ? "0,-0.4"
                                      : "0,0.4");
  }

  static std::string range(std::string_view axis, const plot::Axis& shown) {
    return fmt::format("set {0}range [{1}:{2}]\n{3} logscale {0}\n", axis, number(shown.range.lo),
                       number(shown.range.hi), shown.logarithmic ? "set" : "unset");
  }

  [[nodiscard]] std::string frame() const {
    const plot::Box& box = panel_.frame;
    const int sides = panel_.panel->scale ? 15 : panel_.top_ticks.empty() ? 3 : 7;
    std::string out = fmt::format(
        "unset object\nunset arrow\nset border {} lw 0.6\n"
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n",
        sides, across(box.left), across(box.right), up(box.top), up(box.bottom));
    out += range("x", panel_.x) + range("x2", panel_.x) + range("y", panel_.y);
    out += ticks("x", panel_.x_ticks) + ticks("x2", panel_.top_ticks) + ticks("y", panel_.y_ticks);
    return panel_.panel->scale ? out + colour_scale() : out + "unset colorbox\n";
  }

  [[nodiscard]] std::string colour_scale() const {
    const plot::Box& box = panel_.scale;
    constexpr int knots = 9;
    std::string palette;
    for (int i = 0; i <= knots; ++i) {
      palette += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, plot::viridis(double(i) / knots));
    }
    plot::Axis axis;
    axis.range = panel_.panel->scale->range;
    return fmt::format(
        "set palette defined ({}) maxcolors 64\n"
        "set colorbox horizontal user origin screen {:.4f},{:.4f} size screen {:.4f},{:.4f} "
        "border\n{}{}set tics front\n",
        palette, across(box.left), up(box.bottom), across(box.width()),
        box.height() / layout_.height, range("cb", axis), ticks("cb", panel_.scale_ticks));
  }

  const PlacedPanel& panel_;
  std::size_t index_;
  const plot::FigureLayout& layout_;
  std::size_t layer_ = 0;
  std::string data_;
  std::string objects_;
  std::string parts_;
};

std::string rectangle(const plot::Box& box, const std::string& style) {
  return fmt::format("set object rectangle from {:.1f},{:.1f} to {:.1f},{:.1f} {}\n", box.left,
                     box.bottom, box.right, box.top, style);
}

std::string sample(const plot::PlacedSample& sample) {
  const plot::Box& box = sample.box;
  const double middle = (box.top + box.bottom) / 2;
  if (const auto* curve = std::get_if<plot::Curve>(sample.layer)) {
    return fmt::format("set arrow from {:.1f},{:.1f} to {:.1f},{:.1f} nohead {}\n", box.left,
                       middle, box.right, middle,
                       line_style(curve->colour, curve->dash, curve->width));
  }
  if (const auto* points = std::get_if<plot::Points>(sample.layer)) {
    const bool tiny = points->mark == plot::Mark::speck || points->mark == plot::Mark::cross;
    return fmt::format("set label '' at {:.1f},{:.1f} point {}\n", (box.left + box.right) / 2,
                       middle, point_words(points->mark, points->colour, tiny ? 2 : 1));
  }
  if (const auto* band = std::get_if<plot::Band>(sample.layer)) {
    return rectangle(box, area_style(band->colour, 0.36));
  }
  if (const auto* span = std::get_if<plot::Span>(sample.layer)) {
    return rectangle(box, area_style(span->colour, 0.18));
  }
  return rectangle(box, area_style(plot::Colour::grey, 0.5));
}

std::string text_label(const plot::PlacedText& text) {
  constexpr std::array anchors{"left", "center", "right"};
  return fmt::format("set label {} at {:.1f},{:.1f} {}{}\n", gnuplot_text(text.words), text.at.x,
                     text.at.y - plot::middle_px, anchors.at(std::size_t(text.anchor)),
                     text.bold ? fmt::format(" font 'sans-serif:Bold,{}'", font_pt) : "");
}

/// Everything that stands on the paper beside the panels.
std::string paper(const plot::FigureLayout& layout) {
  std::string out = fmt::format(
      "# Texts, legend and bars, in pixels of 1/96 inch from the upper left corner.\n"
      "unset object\nunset arrow\nunset border\nunset tics\nunset colorbox\n"
      "set lmargin at screen 0\nset rmargin at screen 1\n"
      "set tmargin at screen 1\nset bmargin at screen 0\n"
      "unset logscale\nset xrange [0:{:.1f}]\nset yrange [{:.1f}:0]\n",
      layout.width, layout.height);
  for (const PlacedPanel& panel : layout.panels) {
    for (const plot::PlacedSample& one : panel.samples) out += sample(one);
  }
  for (const plot::PlacedBar& bar : layout.bars) {
    out += rectangle(bar.box, area_style(bar.colour, 1));
  }
  for (const plot::PlacedText& text : layout.texts) out += text_label(text);
  return out + "plot NaN\n";
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  const std::string safe = printable(text);
  std::string out;
  for (std::size_t begin = 0; begin <= safe.size();) {
    const std::size_t end = std::min(safe.find('\'', begin), safe.size());
    if (end > begin)
      out += fmt::format("{}'{}'", out.empty() ? "" : ".", safe.substr(begin, end - begin));
    if (end < safe.size()) out += fmt::format("{}\"'\"", out.empty() ? "" : ".");
    begin = end + 1;
  }
  return out.empty() ? "''" : out;
}

std::string gnuplot_script(const Figure& figure, FigureFormat format, double width_mm) {
  const plot::FigureLayout layout = plot::lay_out(figure, width_mm);
  std::string out;
  if (format == FigureFormat::script) {
    constexpr double dots_a_pixel = 300.0 / 96;
    out += fmt::format(
        "# {0}\n# Draw it with: gnuplot {1}.gp > {1}.pdf\n"
        "# For another format change the next line, such as to\n"
        "#   set terminal pngcairo size {2:.0f},{3:.0f} noenhanced font 'sans-serif,7.5' \\\n"
        "#     fontscale 3.125 linewidth 3.125 pointscale 3.125\n",
        printable(figure.title, 200), figure.id, dots_a_pixel * layout.width,
        dots_a_pixel * layout.height);
  }
  out += set_terminal(layout, format) +
         "set encoding utf8\nset termoption noenhanced\nunset key\nset multiplot\n";
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    out += PanelScript(layout.panels[i], i + 1, layout).text();
  }
  return out + paper(layout) + "unset multiplot\n";
}

}  // namespace tethercalc
