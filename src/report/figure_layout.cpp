// Lines of text have a fixed height; frames share what is left of the width and grow with it. Texts
// are measured with the widths of DejaVu Sans, which few sans-serifs exceed.
#include "report/figure_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/characters.hpp"
#include "report/figure_ticks.hpp"

namespace tethercalc::plot {
namespace {

constexpr double pixels_per_mm = 96 / 25.4;
constexpr double column_mm = 85;    // a journal's
constexpr double line_height = 12;  // letters and the space between
constexpr double edge = 4;          // free at the figure's sides
constexpr double right_margin = 14;
constexpr double sample_width = 22;
constexpr double cell_width = 38;     // of a legend's further columns
constexpr double most_heading = 200;  // characters; what is longer is cut anyway

/// Advance widths of DejaVu Sans 2.37 in thousandths of the font size, from U+0020 to U+007E.
constexpr std::array letter_widths{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};

/// Over the font size.
double letter_width(std::uint32_t c) {
  if (c >= 0x20 && c < 0x7F) return letter_widths[c - 0x20] / 1000.0;
  constexpr std::array<double, 3> by_columns{0, 0.84, 1.3};  // boxes for missing letters are wide
  return by_columns[std::size_t(columns_of(c))];
}

/// `words` as they have room in `room` pixels.
std::string fitted(std::string_view words, double room, bool bold = false) {
  const std::string whole = printable(words, std::size_t(most_heading));
  if (text_width(whole, bold) <= room) return whole;
  std::string out;
  double width = text_width("…", bold);
  bool full = false;
  for_each_character(whole, [&](std::uint32_t, std::string_view bytes) {
    width += text_width(bytes, bold);
    full = full || width > room;
    if (!full) out += bytes;
  });
  return out + "…";
}

double horizontal_extent(std::string_view words) { return text_width(words); }
double vertical_extent(std::string_view words) { return words.empty() ? 0 : 0.75 * font_px; }

std::vector<Tick> horizontal_ticks(const Axis& axis, double width) {
  return ticks_of(axis, width, 6, Minus::typographic, horizontal_extent);
}

std::vector<Tick> vertical_ticks(const Axis& axis, double height) {
  return ticks_of(axis, height, 7, Minus::typographic, vertical_extent);
}

bool any_words(const std::vector<Tick>& ticks) {
  return std::ranges::any_of(ticks, [](const Tick& tick) { return !tick.words.empty(); });
}

/// Puts parts below each other.
class Typesetter {
 public:
  Typesetter(const Figure& figure, double width_mm)
      : figure_(figure), growth_(width_mm / column_mm) {
    layout_.width = width_mm * pixels_per_mm;
  }

  FigureLayout lay_out() {
    left_ = left_margin(nullptr);
    if (figure_.to_scale) {
      // The margin follows from the numbers, those from the widened ranges, and those from the
      // frames that the margin leaves.
      std::vector<Axes> widened = axes_to_scale();
      left_ = left_margin(&widened);
      axes_ = axes_to_scale();
    }
    const std::string& heading = figure_.heading.empty() ? figure_.title : figure_.heading;
    const double room = layout_.width - 2 * edge;
    text(fitted(heading, room, true), {edge, 11}, Anchor::left, true);
    y_ = 17;
    for (std::size_t i = 0; i < figure_.parts.size(); ++i) {
      std::visit([&](const auto& part) { add(part, i); }, figure_.parts[i]);
    }
    layout_.height = y_;
    return std::move(layout_);
  }

 private:
  struct Axes {
    const Panel* panel = nullptr;
    Axis x;
    Axis y;
  };

  void text(std::string words, Place at, Anchor anchor = Anchor::left, bool bold = false) {
    if (!words.empty()) layout_.texts.push_back({std::move(words), at, anchor, bold});
  }

  [[nodiscard]] std::vector<const Panel*> panels() const {
    std::vector<const Panel*> out;
    for (const auto& part : figure_.parts) {
      if (const auto* panel = std::get_if<Panel>(&part)) out.push_back(panel);
    }
    return out;
  }

  [[nodiscard]] double frame_height(const Panel& panel) const {
    return panel.lines * line_height * growth_;
  }

  /// One for all panels, so that they can be compared.
  [[nodiscard]] double left_margin(const std::vector<Axes>* widened) const {
    double widest = 0;
    const std::vector<const Panel*> all = panels();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Axis& axis = widened == nullptr ? all[i]->y : (*widened)[i].y;
      for (const Tick& tick : vertical_ticks(axis, frame_height(*all[i]))) {
        widest = std::max(widest, text_width(tick.words));
      }
    }
    return edge + widest + tick_length + 3;
  }

  [[nodiscard]] std::vector<Axes> axes_to_scale() const {
    std::vector<Axes> out;
    for (const Panel* panel : panels()) out.push_back({panel, panel->x, panel->y});
    std::vector<std::pair<Axis*, Axis*>> axes;
    std::vector<Box> frames;
    for (Axes& one : out) {
      axes.emplace_back(&one.x, &one.y);
      frames.push_back({left_, 0, layout_.width - right_margin, frame_height(*one.panel)});
    }
    widen_to_scale(axes, frames);
    return out;
  }

  [[nodiscard]] Axes axes_of(const Panel& panel) const {
    const auto own = std::ranges::find(axes_, &panel, &Axes::panel);
    return own != axes_.end() ? *own : Axes{&panel, panel.x, panel.y};
  }

  /// The left and right sides of the frame of part `i`.
  [[nodiscard]] Range sides(const Panel& panel, std::size_t i) const {
    const double right = layout_.width - right_margin;
    const double gap = 0.07 * layout_.width;
    const double half = (right - left_ - gap) / 2;
    if (panel.beside) return {left_ + half + gap, right};
    const Panel* next =
        i + 1 < figure_.parts.size() ? std::get_if<Panel>(&figure_.parts[i + 1]) : nullptr;
    return next != nullptr && next->beside ? Range{left_, left_ + half} : Range{left_, right};
  }

  void add(const Panel& panel, std::size_t i) {
    const Range across = sides(panel, i);
    const double left_bottom = panel.beside ? y_ : 0;
    if (panel.beside) y_ = row_top_;
    row_top_ = y_;
    const Axes axes = axes_of(panel);
    PlacedPanel placed;
    placed.panel = &panel;
    placed.x = axes.x;
    placed.y = axes.y;
    const std::vector<Tick> top_ticks =
        panel.top ? horizontal_ticks(*panel.top, across.hi - across.lo) : std::vector<Tick>{};
    head(panel, across, any_words(top_ticks));
    if (panel.beside) y_ = layout_.panels.back().frame.top;
    placed.frame = {across.lo, y_, across.hi, y_ + frame_height(panel)};
    for (const Tick& tick : top_ticks) {
      const Place at = placed.place(tick.at, axes.y.range.lo);
      placed.top_ticks.push_back({tick.at, at.x, printable(tick.words)});
    }
    for (const Tick& tick : vertical_ticks(axes.y, placed.frame.height())) {
      const Place at = placed.place(axes.x.range.lo, tick.at);
      placed.y_ticks.push_back({tick.at, at.y, panel.beside ? "" : printable(tick.words)});
    }
    y_ = placed.frame.bottom;
    const std::vector<Tick> ticks = horizontal_ticks(axes.x, placed.frame.width());
    for (const Tick& tick : ticks) {
      const Place at = placed.place(tick.at, axes.y.range.lo);
      placed.x_ticks.push_back({tick.at, at.x, printable(tick.words)});
    }
    if (any_words(ticks)) y_ += tick_length + line_height;
    if (!panel.x.label.empty()) {
      y_ += line_height;
      // In a row of two the label is often wider than its frame.
      const double room = layout_.width - 2 * edge;
      const std::string words = fitted(panel.x.label, panel.beside ? room / 2 : room);
      const double half = text_width(words) / 2;
      text(words,
           {std::clamp((across.lo + across.hi) / 2, edge + half, layout_.width - edge - half), y_},
           Anchor::middle);
      y_ += 4;
    }
    for (const Layer& layer : panel.layers) {
      std::visit([&](const auto& one) { beside_layer(placed, one); }, layer);
    }
    label_curves(placed);
    if (panel.scale) colour_scale(placed);
    legend(placed);
    y_ = std::max(y_ + 9, left_bottom);
    layout_.panels.push_back(std::move(placed));
  }

  /// What stands above the frame.
  void head(const Panel& panel, Range across, bool tick_words) {
    const double from = panel.beside ? across.lo : edge;
    const double row_room = layout_.width - edge - from;
    if (!panel.title.empty()) {
      text(fitted(panel.title, row_room, true), {from, y_ + 10}, Anchor::left, true);
      y_ += line_height + 1;
    }
    const std::string right = panel.top ? panel.top->label : panel.remark;
    const double right_width = right.empty() ? 0 : text_width(right) + 8;
    const bool apart = text_width(panel.y.label) + right_width > across.hi - from;
    if (!panel.y.label.empty() || panel.beside || !right.empty()) {
      text(fitted(panel.y.label, row_room), {from, y_ + 10});
      y_ += line_height;
      if (apart && !right.empty()) y_ += line_height;
      const double base = panel.beside ? layout_.panels.back().frame.top - 7 : y_ - 2;
      text(fitted(right, across.hi - from), {across.hi, base}, Anchor::right);
    }
    y_ += tick_words ? line_height + tick_length + 1 : 5;
  }

  void beside_layer(const PlacedPanel& placed, const Reference& line) {
    if (line.words.empty() || !line.vertical) return;
    const Place at = placed.place(line.at, placed.y.range.lo);
    const std::string words = printable(line.words);
    const bool right = at.x + 5 + text_width(words) < placed.frame.right;
    text(words, {at.x + (right ? 4 : -4), placed.frame.bottom - 6},
         right ? Anchor::left : Anchor::right);
  }
  void beside_layer(const PlacedPanel& placed, const Note& note) {
    const Place at = placed.place(note.x, note.y);
    text(fitted(note.words, placed.frame.width()), {at.x, at.y + middle_px}, Anchor::middle);
  }
  template <typename Other>
  void beside_layer(const PlacedPanel& /*placed*/, const Other& /*layer*/) {}

  /// Labels at the ends of curves, each at the nearest place where it covers nothing; none where
  /// that would be too far from its curve to tell whose it is.
  void label_curves(const PlacedPanel& placed) {
    std::vector<Place> taken;
    for (const Layer& layer : placed.panel->layers) {
      if (const auto* curve = std::get_if<Curve>(&layer)) {
        for (const auto& part : visible_parts(*curve, placed.x, placed.y)) {
          for (std::size_t i = 0; i < part.size(); ++i) {
            take_line(taken, on_paper(placed, part[i == 0 ? 0 : i - 1]), on_paper(placed, part[i]));
          }
        }
      } else if (const auto* points = std::get_if<Points>(&layer)) {
        for (std::size_t i = 0; i < points->x.size(); ++i) {
          taken.push_back(placed.place(points->x[i], points->y[i]));
        }
      }
    }
    std::vector<Box> labels;
    for (const Layer& layer : placed.panel->layers) {
      const auto* curve = std::get_if<Curve>(&layer);
      if (curve == nullptr || curve->label.empty()) continue;
      const auto parts = visible_parts(*curve, placed.x, placed.y);
      if (parts.empty()) continue;
      const std::string words = fitted(curve->label, placed.frame.width() / 2);
      const auto first = nearest_free(placed.frame, on_paper(placed, parts.front().front()),
                                      text_width(words), taken, labels);
      const auto last = nearest_free(placed.frame, on_paper(placed, parts.back().back()),
                                     text_width(words), taken, labels);
      const auto& nearest = first && (!last || first->distance < last->distance) ? first : last;
      if (!nearest) continue;
      labels.push_back(label_box(nearest->at, text_width(words)));
      text(words, {nearest->at.x, nearest->at.y + middle_px}, Anchor::middle);
    }
  }

  static Place on_paper(const PlacedPanel& placed, Place share) {
    return {placed.frame.left + share.x * placed.frame.width(),
            placed.frame.bottom - share.y * placed.frame.height()};
  }

  /// Points of the stretch, near enough to each other that no letter has room between them.
  static void take_line(std::vector<Place>& taken, Place from, Place to) {
    const double steps = std::ceil(std::hypot(to.x - from.x, to.y - from.y) / 3 + 1e-9);
    for (double k = 1; k <= std::max(1.0, steps); ++k) {
      const double share = steps > 0 ? k / steps : 1;
      taken.push_back({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share});
    }
  }

  static Box label_box(Place middle, double width) {
    return {middle.x - width / 2 - 1.5, middle.y - 0.5 * font_px, middle.x + width / 2 + 1.5,
            middle.y + 0.5 * font_px};
  }

  struct FreePlace {
    double distance = 0;
    Place at{};
  };

  /// The free middle of a label that is nearest to `end`, if one is near.
  static std::optional<FreePlace> nearest_free(const Box& frame, Place end, double width,
                                               const std::vector<Place>& taken,
                                               const std::vector<Box>& labels) {
    const auto is_free = [&](const Box& box) {
      if (box.left < frame.left + 1 || box.right > frame.right - 1) return false;
      if (box.top < frame.top + 1 || box.bottom > frame.bottom - 1) return false;
      const auto covers = [&box](Place p) {
        return p.x > box.left && p.x < box.right && p.y > box.top && p.y < box.bottom;
      };
      const auto meets = [&box](const Box& b) {
        return b.left < box.right && box.left < b.right && b.top < box.bottom && box.top < b.bottom;
      };
      return std::ranges::none_of(taken, covers) && std::ranges::none_of(labels, meets);
    };
    constexpr double farthest = 30;
    for (double distance = 2; distance < farthest; distance += 1.5) {
      for (const double angle : {0.0, -0.6, 0.6, -1.2, 1.2, -1.9, 1.9, -2.5, 2.5, 3.1}) {
        const Place at{end.x + (distance + width / 2) * std::cos(angle),
                       end.y + (distance + font_px / 2) * std::sin(angle)};
        if (is_free(label_box(at, width))) return FreePlace{distance, at};
      }
    }
    return std::nullopt;
  }

  void colour_scale(PlacedPanel& placed) {
    const ColourScale& scale = *placed.panel->scale;
    y_ += line_height;
    text(fitted(scale.label, layout_.width - 2 * edge), {edge, y_});
    placed.scale = {placed.frame.left, y_ + 4, placed.frame.right, y_ + 12};
    const Axis axis{.range = scale.range};
    for (const Tick& tick : horizontal_ticks(axis, placed.scale.width())) {
      const double x = placed.scale.left + along(axis, tick.at) * placed.scale.width();
      placed.scale_ticks.push_back({tick.at, x, tick.words});
    }
    y_ = placed.scale.bottom + tick_length + line_height;
  }

  void legend(PlacedPanel& placed) {
    const Panel& panel = *placed.panel;
    std::vector<const Layer*> entries;
    double widest = 0;
    for (const Layer& layer : panel.layers) {
      if (words_of(layer).empty()) continue;
      entries.push_back(&layer);
      widest = std::max(widest, text_width(printable(words_of(layer))));
    }
    if (entries.empty() && panel.key.empty()) return;
    y_ += 4;
    const double room = layout_.width - 2 * edge;
    const bool table = !panel.legend_heads.empty();
    const double entry_width = sample_width + 6 + widest + 10;
    const auto columns =
        table ? std::size_t{1} : std::clamp<std::size_t>(std::size_t(room / entry_width), 1, 4);
    const double width = room / double(columns);
    if (table) {
      y_ += line_height;
      cells(panel.legend_heads);
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (i % columns == 0) y_ += line_height;
      const double x = edge + width * double(i % columns);
      const std::vector<std::string> further = cells_of(*entries[i]);
      const double words_room = width - sample_width - 6 -
                                (further.empty() ? 0 : 4 + cell_width * double(further.size()));
      placed.samples.push_back(
          {entries[i], {x, y_ - line_height + 3.5, x + sample_width, y_ + 1.5}});
      text(fitted(words_of(*entries[i]), words_room), {x + sample_width + 6, y_});
      cells(further);
    }
    for (const std::string& line : panel.key) {
      y_ += line_height;
      text(fitted(line, room), {edge, y_});
    }
    y_ += 3;
  }

  /// Further columns of the legend, at the right margin.
  void cells(const std::vector<std::string>& texts) {
    for (std::size_t c = 0; c < texts.size(); ++c) {
      text(fitted(texts[c], 2 * cell_width),
           {layout_.width - edge - cell_width * double(texts.size() - 1 - c), y_}, Anchor::right);
    }
  }

  void add(const Bars& bars, std::size_t /*part*/) {
    const double right = layout_.width - edge;
    const double room = right - edge;
    y_ += 2;
    text(fitted(bars.title, room, true), {edge, y_ + 10}, Anchor::left, true);
    y_ += line_height + 3;
    for (const Bar& bar : bars.bars) {
      const double number = text_width(bar.number);
      text(fitted(bar.words, room - number - 8), {edge, y_ + 10});
      text(bar.number, {right, y_ + 10}, Anchor::right);
      y_ += line_height + 2;
      const double share = std::isfinite(bar.share) ? std::clamp(bar.share, 0.0, 1.0) : 0;
      layout_.bars.push_back({{edge, y_, edge + share * room, y_ + 5}, bar.colour});
      y_ += 8;
    }
    y_ += 8;
  }

  void add(const Lines& lines, std::size_t /*part*/) {
    const double room = layout_.width - 2 * edge;
    text(fitted(lines.title, room, true), {edge, y_ + 10}, Anchor::left, true);
    y_ += line_height + 2;
    for (const std::string& line : lines.texts) {
      text(fitted(line, room), {edge, y_ + 10});
      y_ += line_height + 1;
    }
    y_ += 6;
  }

  const Figure& figure_;
  double growth_;  ///< of frames, 1 in one column
  double left_ = 0;
  double y_ = 0;
  double row_top_ = 0;
  std::vector<Axes> axes_;  ///< those of figures to scale
  FigureLayout layout_;
};

}  // namespace

FigureLayout lay_out(const Figure& figure, double width_mm) {
  return Typesetter(figure, width_mm).lay_out();
}

Place PlacedPanel::place(double at_x, double at_y) const {
  return {frame.left + along(x, at_x) * frame.width(),
          frame.bottom - along(y, at_y) * frame.height()};
}

double text_width(std::string_view text, bool bold) {
  double width = 0;
  for_each_character(text, [&](std::uint32_t c, std::string_view) { width += letter_width(c); });
  constexpr double bolder = 1.13;  // of DejaVu Sans Bold, on average
  return width * font_px * (bold ? bolder : 1);
}

std::vector<std::vector<Place>> visible_parts(const Curve& curve, const Axis& x, const Axis& y) {
  std::vector<std::vector<Place>> parts;
  const auto share = [&](std::size_t i) {
    return Place{along(x, curve.x[i]), along(y, curve.y[i])};
  };
  const auto exists = [](Place p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  bool open = false;  // whether the last part ends at the point before
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    const Place a = share(i - 1);
    const Place b = share(i);
    double from = 0;
    double to = 1;
    // Liang and Barsky (1984): the stretch of a to b between two parallel edges.
    const auto cut = [&](double start, double change) {
      if (change == 0) {
        if (start < 0 || start > 1) to = -1;
        return;
      }
      const double at_lo = -start / change;
      const double at_hi = (1 - start) / change;
      from = std::max(from, std::min(at_lo, at_hi));
      to = std::min(to, std::max(at_lo, at_hi));
    };
    if (exists(a) && exists(b)) {
      cut(a.x, b.x - a.x);
      cut(a.y, b.y - a.y);
    }
    if (!exists(a) || !exists(b) || from > to) {
      open = false;
      continue;
    }
    const auto at = [&](double t) { return Place{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; };
    if (!open || from > 0) parts.push_back({at(from)});
    parts.back().push_back(at(to));
    open = to == 1;
  }
  return parts;
}

std::vector<Place> band_outline(const Band& band, const Axis& x, const Axis& y) {
  std::vector<Place> out;
  const auto add = [&](double at_x, double at_y) {
    const Place p{along(x, at_x), along(y, at_y)};
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    out.push_back({std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0)});
  };
  for (std::size_t i = 0; i < band.x.size(); ++i) add(band.x[i], band.lower[i]);
  for (std::size_t i = band.x.size(); i-- > 0;) add(band.x[i], band.upper[i]);
  return out;
}

std::optional<Range> visible_part(const Axis& axis, Range range) {
  const double lo = std::max(0.0, along(axis, std::max(range.lo, axis.range.lo)));
  const double hi = std::min(1.0, along(axis, std::min(range.hi, axis.range.hi)));
  if (!(lo < hi)) return std::nullopt;
  return Range{lo, hi};
}

const std::string& words_of(const Layer& layer) {
  static const std::string none;
  return std::visit(
      [](const auto& one) -> const std::string& {
        using T = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<T, Note> || std::is_same_v<T, Reference>) {
          return none;
        } else if constexpr (std::is_same_v<T, Cells>) {
          return one.words_of_grey;
        } else {
          return one.words;
        }
      },
      layer);
}

std::vector<std::string> cells_of(const Layer& layer) {
  const auto* curve = std::get_if<Curve>(&layer);
  return curve == nullptr ? std::vector<std::string>{} : curve->cells;
}

void widen_to_scale(std::vector<std::pair<Axis*, Axis*>> axes, const std::vector<Box>& frames) {
  double unit = 0;  // the greatest length of an axis a pixel
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& [x, y] = axes[i];
    unit = std::max({unit, (x->range.hi - x->range.lo) / frames[i].width(),
                     (y->range.hi - y->range.lo) / frames[i].height()});
  }
  const auto widen = [unit](Axis& axis, double length) {
    const double spare = unit * length - (axis.range.hi - axis.range.lo);
    axis.range = {axis.range.lo - spare / 2, axis.range.hi + spare / 2};
  };
  for (std::size_t i = 0; i < axes.size(); ++i) {
    widen(*axes[i].first, frames[i].width());
    widen(*axes[i].second, frames[i].height());
  }
}

}  // namespace tethercalc::plot
