// Every colour is a class and, for those who know no style, an attribute `color`, by which
// `currentColor` in strokes and fills becomes what a page or nobody made of the class.
#include "report/figure_svg.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "report/characters.hpp"
#include "report/figure_layout.hpp"
#include "report/figure_style.hpp"
#include "report/figure_ticks.hpp"

namespace tethercalc::plot {
namespace {

/// A coordinate with a tenth of a pixel.
std::string px(double value) {
  std::string out = fmt::format("{:.1f}", value);
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out == "-0" ? "0" : out;
}

std::string coloured(Colour colour) {
  return fmt::format("class=\"{}\" color=\"{}\"", colour_name(colour), colour_code(colour));
}

std::string stroke(Colour colour, Dash dash, double width) {
  std::string out = fmt::format("{} stroke=\"currentColor\" fill=\"none\" stroke-width=\"{:g}\"",
                                coloured(colour), width);
  if (dash != Dash::solid) out += fmt::format(" stroke-dasharray=\"{}\"", dash_lengths(dash));
  return out;
}

std::string fill(Colour colour, double opacity = 1) {
  std::string out = coloured(colour) + " fill=\"currentColor\"";
  if (opacity < 1) out += fmt::format(" fill-opacity=\"{:g}\"", opacity);
  return out;
}

constexpr double area_opacity = 0.18;

std::string rectangle(const Box& box, const std::string& style) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n", px(box.left),
                     px(box.top), px(box.width()), px(box.height()), style);
}

std::string straight_line(Place from, Place to, const std::string& style) {
  return fmt::format("<path d=\"M{},{}L{},{}\" {}/>\n", px(from.x), px(from.y), px(to.x), px(to.y),
                     style);
}

/// The shape of a mark as a path, `size` times the usual.
std::string mark_path(Mark mark, Place at, double size) {
  const std::string x = px(at.x);
  const std::string y = px(at.y);
  const auto polygon = [&](std::initializer_list<Place> corners) {
    std::string out;
    for (const Place& corner : corners) {
      out += fmt::format("{}{},{}", out.empty() ? "M" : "L", px(at.x + size * corner.x),
                         px(at.y + size * corner.y));
    }
    return out + "Z";
  };
  switch (mark) {
    case Mark::speck:
      return fmt::format("M{},{}h0", x, y);  // a dot, its ends being round
    case Mark::cross: {
      const double half = 1.2 * size;
      return fmt::format("M{},{}l{s},{s}m0,-{s}l-{s},{s}", px(at.x - half), px(at.y - half),
                         fmt::arg("s", px(2 * half)));
    }
    case Mark::dot:
    case Mark::circle: {
      const std::string r = px((mark == Mark::dot ? 2.6 : 3.2) * size);
      return fmt::format("M{},{}a{r},{r} 0 1 0 0.1,0Z", x, px(at.y - std::stod(r)),
                         fmt::arg("r", r));
    }
    case Mark::diamond:
      return polygon({{0, -5}, {4, 0}, {0, 5}, {-4, 0}});
    case Mark::square:
      return polygon({{-3, -3}, {3, -3}, {3, 3}, {-3, 3}});
    case Mark::triangle:
      return polygon({{0, -4.5}, {4, 3}, {-4, 3}});
    case Mark::plus:
      return fmt::format("M{},{}h{s}M{},{}v{s}", px(at.x - 3.5 * size), y, x, px(at.y - 3.5 * size),
                         fmt::arg("s", px(7 * size)));
  }
  return "";
}

std::string mark_style(Mark mark, Colour colour) {
  switch (mark) {
    case Mark::speck:
      return stroke(colour, Dash::solid, 1.6) + " stroke-linecap=\"round\"";
    case Mark::cross:
      return stroke(colour, Dash::solid, 0.9);
    case Mark::circle:
    case Mark::plus:
      return stroke(colour, Dash::solid, 1.3);
    default:
      return fill(colour);
  }
}

/// Draws what stands on the axes of a panel.
class PanelDrawer {
 public:
  explicit PanelDrawer(const PlacedPanel& panel) : panel_(panel) {}

  std::string operator()(const Curve& curve) const {
    std::string path;
    for (const auto& part : visible_parts(curve, panel_.x, panel_.y)) path += line_through(part);
    if (path.empty()) return "";
    return fmt::format("<path d=\"{}\" {} stroke-linejoin=\"round\"/>\n", path,
                       stroke(curve.colour, curve.dash, curve.width));
  }

  std::string operator()(const Points& points) const {
    std::string whole;
    std::string path;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      const double x = along(panel_.x, points.x[i]);
      const double y = along(panel_.y, points.y[i]);
      constexpr double slack = 1e-9;
      if (!(x >= -slack && x <= 1 + slack && y >= -slack && y <= 1 + slack)) continue;
      const double size = points.sizes.empty() ? 1 : points.sizes[i];
      const std::string mark = mark_path(points.mark, panel_.place(points.x[i], points.y[i]), size);
      if (points.values.empty()) {
        path += mark;
      } else if (std::isfinite(points.values[i]) && panel_.panel->scale) {
        whole += fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", mark,
                             viridis(*panel_.panel->scale, points.values[i]));
      }
    }
    if (path.empty()) return whole;
    // Marks on other curves stand out by a border of paper.
    const bool few = points.mark != Mark::speck && points.mark != Mark::cross;
    if (few && points.mark != Mark::plus && points.mark != Mark::circle) {
      whole += fmt::format(
          "<path d=\"{}\" class=\"paper\" color=\"#ffffff\" stroke=\"currentColor\" "
          "stroke-width=\"2.4\" fill=\"none\"/>\n",
          path);
    }
    return whole +
           fmt::format("<path d=\"{}\" {}/>\n", path, mark_style(points.mark, points.colour));
  }

  std::string operator()(const Band& band) const {
    const std::vector<Place> corners = band_outline(band, panel_.x, panel_.y);
    if (corners.size() < 3) return "";
    return fmt::format("<path d=\"{}Z\" {}/>\n", line_through(corners),
                       fill(band.colour, 2 * area_opacity));
  }

  std::string operator()(const Span& span) const {
    const auto part = visible_part(panel_.x, span.range);
    if (!part) return "";
    const Box& frame = panel_.frame;
    return rectangle({frame.left + part->lo * frame.width(), frame.top,
                      frame.left + part->hi * frame.width(), frame.bottom},
                     fill(span.colour, area_opacity));
  }

  std::string operator()(const Reference& line) const {
    const double share = along(line.vertical ? panel_.x : panel_.y, line.at);
    if (!(share >= 0 && share <= 1)) return "";
    const Box& frame = panel_.frame;
    const double x = frame.left + share * frame.width();
    const double y = frame.bottom - share * frame.height();
    const std::string style = stroke(line.colour, line.dash, 0.8);
    return line.vertical ? straight_line({x, frame.top}, {x, frame.bottom}, style)
                         : straight_line({frame.left, y}, {frame.right, y}, style);
  }

  std::string operator()(const Note& /*words stand among the texts*/) const { return ""; }

  std::string operator()(const Cells& cells) const {
    std::string out = rectangle(panel_.frame, fill(Colour::grey, 0.5));
    out += "<g shape-rendering=\"crispEdges\">\n";
    for (const Cell& cell : cells.cells) {
      if (!std::isfinite(cell.value) || !panel_.panel->scale) continue;
      const Place a = panel_.place(cell.x.lo, cell.y.hi);
      const Place b = panel_.place(cell.x.hi, cell.y.lo);
      out += rectangle({a.x, a.y, b.x, b.y},
                       fmt::format("fill=\"{}\"", viridis(*panel_.panel->scale, cell.value)));
    }
    return out + "</g>\n";
  }

 private:
  /// A line through points in shares of the frame.
  [[nodiscard]] std::string line_through(const std::vector<Place>& shares) const {
    std::string out;
    std::string last;
    for (const Place& share : shares) {
      const std::string at = px(panel_.frame.left + share.x * panel_.frame.width()) + "," +
                             px(panel_.frame.bottom - share.y * panel_.frame.height());
      if (at == last) continue;
      out += (out.empty() ? "M" : "L") + at;
      last = at;
    }
    return out;
  }

  const PlacedPanel& panel_;
};

/// Sides with ticks, thinly; all four around a heat map.
std::string frame(const PlacedPanel& panel) {
  const Box& box = panel.frame;
  std::string path =
      fmt::format("M{0},{1}V{2}H{3}", px(box.left), px(box.top), px(box.bottom), px(box.right));
  if (panel.panel->scale) {
    path += fmt::format("V{}H{}", px(box.top), px(box.left));
  } else if (!panel.top_ticks.empty()) {
    path += fmt::format("M{},{}H{}", px(box.left), px(box.top), px(box.right));
  }
  for (const PlacedTick& tick : panel.x_ticks) {
    path += fmt::format("M{},{}v{}", px(tick.place), px(box.bottom), tick_length);
  }
  for (const PlacedTick& tick : panel.y_ticks) {
    path += fmt::format("M{},{}h{}", px(box.left), px(tick.place), -tick_length);
  }
  for (const PlacedTick& tick : panel.top_ticks) {
    path += fmt::format("M{},{}v{}", px(tick.place), px(box.top), -tick_length);
  }
  return fmt::format("<path d=\"{}\" {}/>\n", path, stroke(Colour::ink, Dash::solid, 0.6));
}

std::string text_element(const PlacedText& text) {
  constexpr std::array anchors{"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
  return fmt::format("<text x=\"{}\" y=\"{}\"{}{}>{}</text>\n", px(text.at.x), px(text.at.y),
                     anchors.at(std::size_t(text.anchor)), text.bold ? " font-weight=\"bold\"" : "",
                     markup_text(text.words));
}

std::string tick_words(const PlacedPanel& panel) {
  std::string out;
  const auto add = [&out](const PlacedTick& tick, Place at, Anchor anchor) {
    if (!tick.words.empty()) out += text_element({tick.words, at, anchor});
  };
  const Box& box = panel.frame;
  for (const PlacedTick& tick : panel.x_ticks) {
    add(tick, {tick.place, box.bottom + tick_length + 10}, Anchor::middle);
  }
  for (const PlacedTick& tick : panel.y_ticks) {
    add(tick, {box.left - tick_length - 2, tick.place + middle_px}, Anchor::right);
  }
  for (const PlacedTick& tick : panel.top_ticks) {
    add(tick, {tick.place, box.top - tick_length - 2}, Anchor::middle);
  }
  for (const PlacedTick& tick : panel.scale_ticks) {
    add(tick, {tick.place, panel.scale.bottom + tick_length + 10}, Anchor::middle);
  }
  return out.empty() ? "" : fmt::format("<g {}>\n{}</g>\n", fill(Colour::ink), out);
}

std::string colour_scale(const PlacedPanel& panel) {
  constexpr int steps = 64;
  const Box& box = panel.scale;
  std::string out = "<g shape-rendering=\"crispEdges\">\n";
  for (int i = 0; i < steps; ++i) {
    const double left = box.left + box.width() * i / steps;
    // Each to the end, under the next ones: between neighbours paper would show through.
    out += rectangle({left, box.top, box.right, box.bottom},
                     fmt::format("fill=\"{}\"", viridis((i + 0.5) / steps)));
  }
  std::string path;
  for (const PlacedTick& tick : panel.scale_ticks) {
    path += fmt::format("M{},{}v{}", px(tick.place), px(box.bottom), tick_length);
  }
  return out +
         fmt::format("</g>\n<path d=\"{}\" {}/>\n", path, stroke(Colour::ink, Dash::solid, 0.6));
}

/// A layer as the legend shows it.
std::string sample(const PlacedSample& sample) {
  const Box& box = sample.box;
  const double middle = (box.top + box.bottom) / 2;
  return std::visit(
      [&](const auto& layer) -> std::string {
        using T = std::decay_t<decltype(layer)>;
        if constexpr (std::is_same_v<T, Curve>) {
          return straight_line({box.left, middle}, {box.right, middle},
                               stroke(layer.colour, layer.dash, layer.width));
        } else if constexpr (std::is_same_v<T, Points>) {
          std::string path;
          const bool many = layer.mark == Mark::speck || layer.mark == Mark::cross;
          for (const double share : many ? std::vector{0.15, 0.5, 0.85} : std::vector{0.5}) {
            path += mark_path(layer.mark, {box.left + share * box.width(), middle}, 1);
          }
          return fmt::format("<path d=\"{}\" {}/>\n", path, mark_style(layer.mark, layer.colour));
        } else if constexpr (std::is_same_v<T, Band>) {
          return rectangle(box, fill(layer.colour, 2 * area_opacity));
        } else if constexpr (std::is_same_v<T, Span>) {
          return rectangle(box, fill(layer.colour, area_opacity));
        } else if constexpr (std::is_same_v<T, Cells>) {
          return rectangle(box, fill(Colour::grey, 0.5));
        } else {
          return "";
        }
      },
      *sample.layer);
}

}  // namespace

std::string svg_element(const Figure& figure, double width_mm) {
  const FigureLayout layout = lay_out(figure, width_mm);
  constexpr std::size_t longest_description = 2000;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-labelledby=\"{0}-title "
      "{0}-desc\" width=\"{1:.0f}\" height=\"{2:.0f}\" viewBox=\"0 0 {1:.0f} {2:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"{3:g}\">\n<title id=\"{0}-title\">{4}</title>\n"
      "<desc id=\"{0}-desc\">{5}</desc>\n",
      figure.id, layout.width, layout.height, font_px, markup_text(printable(figure.title, 200)),
      markup_text(printable(figure.description, longest_description)));
  out +=
      "<rect class=\"paper\" color=\"#ffffff\" fill=\"currentColor\" width=\"100%\" "
      "height=\"100%\"/>\n";
  for (const PlacedPanel& panel : layout.panels) {
    const PanelDrawer draw(panel);
    for (const Layer& layer : panel.panel->layers) out += std::visit(draw, layer);
    out += frame(panel) + tick_words(panel);
    if (panel.panel->scale) out += colour_scale(panel);
    for (const PlacedSample& one : panel.samples) out += sample(one);
  }
  for (const PlacedBar& bar : layout.bars) out += rectangle(bar.box, fill(bar.colour));
  out += fmt::format("<g {}>\n", fill(Colour::ink));
  for (const PlacedText& text : layout.texts) out += text_element(text);
  return out + "</g>\n</svg>\n";
}

}  // namespace tethercalc::plot
