#include "report/figure_characters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "report/characters.hpp"
#include "report/figure_layout.hpp"
#include "report/figure_style.hpp"
#include "report/figure_ticks.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc::plot {
namespace {

/// "Select graphic rendition" of ECMA-48, between ESC [ and m; empty: the terminal's own colour.
using Rendition = std::string;

Rendition rendition(Colour colour) {
  constexpr std::array<int, 8> of_256{0, 214, 74, 36, 32, 166, 175, 245};
  return colour == Colour::ink ? "" : fmt::format("38;5;{}", of_256.at(std::size_t(colour)));
}

/// A digit's, on the colour of a heat map: the nearest of the cube of 6 × 6 × 6.
Rendition rendition_on(const std::string& hex) {
  const auto level = [&](std::size_t at) {
    return int(std::lround(std::stoi(hex.substr(at, 2), nullptr, 16) / 51.0));
  };
  const int cube = 16 + 36 * level(1) + 6 * level(3) + level(5);
  return fmt::format("48;5;{};38;5;{}", cube, level(3) >= 3 ? 16 : 231);
}

/// A grid that characters are put into, blank at first.
class Canvas {
 public:
  Canvas(int columns, int rows)
      : columns_(columns), cells_(std::size_t(columns * rows), {" ", ""}) {}

  /// What is beyond the edges is left out.
  void put(int column, int row, std::string_view character, const Rendition& colour = "") {
    if (column < 0 || column >= columns_ || row < 0) return;
    const auto at = std::size_t(row * columns_ + column);
    if (at < cells_.size()) cells_[at] = {std::string(character), colour};
  }

  void write(int column, int row, std::string_view words) {
    for_each_character(words, [&](std::uint32_t c, std::string_view bytes) {
      const int wide = columns_of(c);
      if (wide == 0 || column + wide > columns_) return;
      put(column, row, bytes);
      if (wide == 2) put(column + 1, row, "");  // covered by the one before
      column += wide;
    });
  }

  /// A row without the blanks at its end.
  [[nodiscard]] std::string line(int row, bool colour) const {
    int last = columns_ - 1;
    while (last >= 0 && cell(row, last).first == " ") --last;
    std::string out;
    Rendition now;
    for (int c = 0; c <= last; ++c) {
      const auto& [character, own] = cell(row, c);
      if (colour && own != now) {
        if (!now.empty()) out += "\x1b[0m";
        if (!own.empty()) out += "\x1b[" + own + "m";
        now = own;
      }
      out += character;
    }
    return now.empty() ? out : out + "\x1b[0m";
  }

 private:
  using Painted = std::pair<std::string, Rendition>;
  [[nodiscard]] const Painted& cell(int row, int column) const {
    return cells_[std::size_t(row * columns_ + column)];
  }

  int columns_;
  std::vector<Painted> cells_;
};

double columns_wide(std::string_view words) { return columns_of(words); }
double rows_high(std::string_view words) { return words.empty() ? 0 : 1; }

std::vector<Tick> ticks_across(const Axis& axis, int columns) {
  return ticks_of(axis, columns - 1, 2, Minus::hyphen, columns_wide);
}

std::vector<Tick> ticks_up(const Axis& axis, int rows) {
  return ticks_of(axis, rows - 1, 0.9, Minus::hyphen, rows_high);
}

/// The characters by which the layers of a panel are told apart. A layer without words goes on like
/// the one with words that is drawn alike, in its panel or above.
class Glyphs {
 public:
  explicit Glyphs(const std::vector<Panel>& panels) {
    for (const Panel& panel : panels) {
      taken_.clear();
      for (const Layer& layer : panel.layers) {
        if (const auto* points = std::get_if<Points>(&layer)) add(*points);
      }
      for (const Layer& layer : panel.layers) {
        if (const auto* curve = std::get_if<Curve>(&layer)) add(*curve);
      }
    }
  }

  [[nodiscard]] char of(const Layer& layer) const {
    return std::visit(
        [&](const auto& one) -> char {
          using T = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<T, Curve> || std::is_same_v<T, Points>) return of(&one);
          if constexpr (std::is_same_v<T, Span>) return '=';
          if constexpr (std::is_same_v<T, Band>) return ':';
          return '.';
        },
        layer);
  }

  [[nodiscard]] char of(const void* one) const { return glyphs_.at(one); }

 private:
  [[nodiscard]] bool taken(char c) const { return taken_.find(c) != std::string::npos; }

  void give(const void* layer, char glyph) {
    glyphs_[layer] = glyph;
    taken_ += glyph;
  }

  /// Points of the same kind share one, a single one with words has a letter.
  void add(const Points& points) {
    constexpr std::array by_mark{'.', ',', '@', 'o', '#', '#', '^', '+'};
    char glyph = by_mark.at(std::size_t(points.mark));
    const std::pair alike{points.mark, points.colour};
    const bool single = points.x.size() == 1;
    if (single && !points.words.empty()) {
      const auto initial = static_cast<unsigned char>(points.words.front());
      if (std::isalpha(initial) != 0) glyph = char(std::toupper(initial));
      while (taken(glyph) && glyph < 'Z') ++glyph;
      points_[alike] = glyph;
    } else if (single && points_.contains(alike)) {
      glyph = points_.at(alike);
    }
    give(&points, glyph);
  }

  void add(const Curve& curve) {
    constexpr std::string_view series = "*x%~&$?abcdefghijklmnpqrstuvwyz";
    const std::pair alike{curve.colour, curve.dash};
    if (curve.words.empty() && curves_.contains(alike)) {
      return give(&curve, curves_.at(alike));
    }
    char glyph = series.back();
    if (curve.label.size() == 1) {
      glyph = curve.label.front();
    } else {
      const auto next = std::ranges::find_if(series, [this](char c) { return !taken(c); });
      if (next != series.end()) glyph = *next;
    }
    curves_[alike] = glyph;
    give(&curve, glyph);
  }

  std::map<const void*, char> glyphs_;
  std::map<std::pair<Mark, Colour>, char> points_;
  std::map<std::pair<Colour, Dash>, char> curves_;
  std::string taken_;  ///< in the panel
};

/// A whole number of characters near a share of `cells` of them.
int cell_at(double share, int cells) { return int(std::lround(share * (cells - 1))); }

/// Writes parts below each other.
class Printer {
 public:
  Printer(const Figure& figure, int columns, bool colour)
      : figure_(figure), columns_(columns), colour_(colour) {
    std::vector<std::pair<Axis*, Axis*>> axes;
    for (const auto& part : figure.parts) {
      if (const auto* panel = std::get_if<Panel>(&part)) panels_.push_back(*panel);
    }
    left_ = margin();
    if (!figure.to_scale) return;
    const std::vector<Panel> narrow = panels_;
    widen();
    left_ = margin();
    panels_ = narrow;
    widen();
  }

  std::string print() {
    const Glyphs glyphs(panels_);
    const std::string& heading = figure_.heading.empty() ? figure_.title : figure_.heading;
    const std::string words = cut_to_columns(printable(heading), columns_);
    line(std::string(std::size_t((columns_ - columns_of(words)) / 2), ' ') + words);
    std::size_t next_panel = 0;
    for (const auto& part : figure_.parts) {
      line("");
      if (const auto* bars = std::get_if<Bars>(&part)) {
        print(*bars);
      } else if (const auto* lines = std::get_if<Lines>(&part)) {
        print(*lines);
      } else {
        print(panels_[next_panel++], glyphs);
      }
    }
    return std::move(out_);
  }

 private:
  static int rows_of(const Panel& panel) { return std::max(6, int(std::lround(panel.lines))); }
  [[nodiscard]] int frame_columns() const { return columns_ - left_ - 3; }

  [[nodiscard]] int margin() const {
    int widest = 0;
    for (const Panel& panel : panels_) {
      for (const Tick& tick : ticks_up(panel.y, rows_of(panel))) {
        widest = std::max(widest, columns_of(tick.words));
      }
    }
    return widest + 2;
  }

  /// A character is about twice as high as wide.
  void widen() {
    std::vector<std::pair<Axis*, Axis*>> axes;
    std::vector<Box> frames;
    for (Panel& panel : panels_) {
      axes.emplace_back(&panel.x, &panel.y);
      frames.push_back({0, 0, double(frame_columns() - 1), 2.0 * (rows_of(panel) - 1)});
    }
    widen_to_scale(axes, frames);
  }

  void line(std::string text) {
    text.erase(text.find_last_not_of(' ') + 1);
    out_ += text + "\n";
  }

  [[nodiscard]] std::string painted(const std::string& text, Colour colour) const {
    const Rendition own = rendition(colour);
    return !colour_ || own.empty() ? text : fmt::format("\x1b[{}m{}\x1b[0m", own, text);
  }

  /// Words at both ends of a line.
  void ends(const std::string& left, const std::string& right) {
    const std::string last = cut_to_columns(printable(right), columns_ - 2);
    const int room = columns_ - columns_of(last) - 1;
    const std::string first = cut_to_columns(printable(left), last.empty() ? columns_ : room - 1);
    line(first + std::string(std::size_t(std::max(0, room - columns_of(first))), ' ') + last);
  }

  void print(const Panel& panel, const Glyphs& glyphs) {
    if (!panel.title.empty()) line(cut_to_columns(printable(panel.title), columns_));
    const std::string right = panel.top ? panel.top->label : panel.remark;
    if (!panel.beside) row_label_ = panel.y.label;
    const std::string& left = row_label_;
    if (columns_of(left) + columns_of(right) + 4 > columns_) {
      ends(left, "");
      ends("", right);
    } else if (!left.empty() || !right.empty()) {
      ends(left, right);
    }
    const int width = frame_columns();
    const int rows = rows_of(panel);
    if (panel.top) edge_above(panel, ticks_across(*panel.top, width));
    Canvas canvas(width, rows);
    for (const Layer& layer : panel.layers) {
      std::visit([&](const auto& one) { draw(canvas, panel, glyphs, one, width, rows); }, layer);
    }
    for (const Layer& layer : panel.layers) {
      if (const auto* curve = std::get_if<Curve>(&layer)) label(canvas, panel, *curve, width, rows);
    }
    std::vector<std::string> marks(std::size_t(rows), std::string(std::size_t(left_), ' ') + "|");
    for (const Tick& tick : ticks_up(panel.y, rows)) {
      const int row = rows - 1 - cell_at(along(panel.y, tick.at), rows);
      if (row < 0 || row >= rows) continue;
      const int blanks = left_ - 1 - columns_of(tick.words);
      marks[std::size_t(row)] =
          std::string(std::size_t(std::max(0, blanks)), ' ') + tick.words + " +";
    }
    for (int row = 0; row < rows; ++row) {
      line(marks[std::size_t(row)] + canvas.line(row, colour_));
    }
    edge_below(panel, glyphs, width);
    if (panel.scale) {
      line(cut_to_columns(
          fmt::format("{}: 0 begins at {}, 9 ends at {}", panel.scale->label,
                      significant(panel.scale->range.lo, 4), significant(panel.scale->range.hi, 4)),
          columns_));
    }
    legend(panel, glyphs);
  }

  /// The upper edge with ticks and, above it, their words.
  void edge_above(const Panel& panel, const std::vector<Tick>& ticks) {
    if (ticks.empty()) return;
    Canvas words(columns_, 1);
    std::string edge(std::size_t(frame_columns()), '-');
    for (const Tick& tick : ticks) {
      const int at = cell_at(along(panel.x, tick.at), frame_columns());
      edge[std::size_t(std::clamp(at, 0, frame_columns() - 1))] = '+';
      write_below(words, at, tick.words);
    }
    line(words.line(0, false));
    line(std::string(std::size_t(left_), ' ') + "+" + edge);
  }

  /// The words of a tick around column `at` of the frame.
  void write_below(Canvas& line, int at, const std::string& words) const {
    const int width = columns_of(words);
    line.write(std::clamp(left_ + 1 + at - (width - 1) / 2, 0, std::max(0, columns_ - width)), 0,
               words);
  }

  /// The lower edge, spans in it, its ticks with their words, and what the axis shows.
  void edge_below(const Panel& panel, const Glyphs& glyphs, int width) {
    Canvas edge(width, 1);
    for (int c = 0; c < width; ++c) edge.put(c, 0, "-");
    for (const Layer& layer : panel.layers) {
      const auto* span = std::get_if<Span>(&layer);
      const auto part = span == nullptr ? std::nullopt : visible_part(panel.x, span->range);
      if (!part) continue;
      const std::string glyph(1, glyphs.of(layer));
      for (int c = cell_at(part->lo, width); c <= cell_at(part->hi, width); ++c) {
        edge.put(c, 0, glyph, rendition(span->colour));
      }
    }
    // Shared axes keep their numbers here: panels scroll away from each other.
    Axis numbered = panel.x;
    numbered.numbers = true;
    Canvas words(columns_, 1);
    for (const Tick& tick : ticks_across(numbered, width)) {
      const int at = cell_at(along(panel.x, tick.at), width);
      edge.put(at, 0, "+");
      write_below(words, at, tick.words);
    }
    line(std::string(std::size_t(left_), ' ') + "+" + edge.line(0, colour_));
    line(words.line(0, false));
    const std::string label = cut_to_columns(printable(label_of(panel)), columns_ - left_ - 1);
    if (label.empty()) return;
    const int blanks = left_ + 1 + std::max(0, (width - columns_of(label)) / 2);
    line(std::string(std::size_t(blanks), ' ') + label);
  }

  /// That of the next panel that has one: those above it share its axis.
  [[nodiscard]] std::string label_of(const Panel& panel) const {
    for (std::size_t i = std::size_t(&panel - panels_.data()); i < panels_.size(); ++i) {
      if (!panels_[i].x.label.empty()) return panels_[i].x.label;
    }
    return "";
  }

  // Layers

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& glyphs, const Curve& curve,
                   int width, int rows) {
    const std::string glyph(1, glyphs.of(&curve));
    for (const auto& part : visible_parts(curve, panel.x, panel.y)) {
      for (std::size_t i = 0; i < part.size(); ++i) {
        const Place a = part[i == 0 ? 0 : i - 1];
        const Place b = part[i];
        const double steps =
            std::max({1.0, std::abs(b.x - a.x) * (width - 1), std::abs(b.y - a.y) * (rows - 1)});
        for (double k = 0; k <= std::ceil(steps); ++k) {
          const double t = k / std::ceil(steps);
          canvas.put(cell_at(a.x + t * (b.x - a.x), width),
                     rows - 1 - cell_at(a.y + t * (b.y - a.y), rows), glyph,
                     rendition(curve.colour));
        }
      }
    }
  }

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& glyphs, const Points& points,
                   int width, int rows) {
    std::string glyph(1, glyphs.of(&points));
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      const double x = along(panel.x, points.x[i]);
      const double y = along(panel.y, points.y[i]);
      if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) continue;
      Rendition colour = rendition(points.colour);
      if (!points.values.empty()) {
        if (!panel.scale || !std::isfinite(points.values[i])) continue;
        glyph = digit(*panel.scale, points.values[i]);
        colour = rendition_on(viridis(*panel.scale, points.values[i]));
      }
      canvas.put(cell_at(x, width), rows - 1 - cell_at(y, rows), glyph, colour);
    }
  }

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& /*glyphs*/, const Band& band,
                   int width, int rows) {
    for (std::size_t i = 0; i < band.x.size(); ++i) {
      const double x = along(panel.x, band.x[i]);
      const double lo = along(panel.y, band.lower[i]);
      const double hi = along(panel.y, band.upper[i]);
      if (!(x >= 0 && x <= 1 && lo <= 1 && hi >= 0)) continue;
      for (int r = cell_at(std::max(lo, 0.0), rows); r <= cell_at(std::min(hi, 1.0), rows); ++r) {
        canvas.put(cell_at(x, width), rows - 1 - r, ":", rendition(band.colour));
      }
    }
  }

  static void draw(Canvas& /*stands in the edge*/, const Panel& /*panel*/, const Glyphs& /*glyphs*/,
                   const Span& /*span*/, int /*width*/, int /*rows*/) {}

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& /*glyphs*/,
                   const Reference& reference, int width, int rows) {
    const double share = along(reference.vertical ? panel.x : panel.y, reference.at);
    if (!(share >= 0 && share <= 1)) return;
    const Rendition colour = rendition(reference.colour);
    if (!reference.vertical) {
      for (int c = 0; c < width; ++c) canvas.put(c, rows - 1 - cell_at(share, rows), "-", colour);
      return;
    }
    const int column = cell_at(share, width);
    for (int r = 0; r < rows; ++r) canvas.put(column, r, "|", colour);
    const std::string words = printable(reference.words);
    const bool right = column + 2 + columns_of(words) < width;
    canvas.write(right ? column + 2 : column - 1 - columns_of(words), rows - 1, words);
  }

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& /*glyphs*/, const Note& note,
                   int width, int rows) {
    const std::string words = cut_to_columns(printable(note.words), width);
    const int column = cell_at(along(panel.x, note.x), width) - columns_of(words) / 2;
    canvas.write(std::clamp(column, 0, width - columns_of(words)),
                 rows - 1 - cell_at(along(panel.y, note.y), rows), words);
  }

  static void draw(Canvas& canvas, const Panel& panel, const Glyphs& /*glyphs*/, const Cells& cells,
                   int width, int rows) {
    if (!panel.scale) return;
    const auto first = [](double share, int count) {  // whose middle is not before `share`
      return std::clamp(int(std::ceil(share * count - 0.5)), 0, count);
    };
    for (const Cell& cell : cells.cells) {
      const bool exists = std::isfinite(cell.value);
      const std::string glyph = exists ? digit(*panel.scale, cell.value) : ".";
      const Rendition colour =
          exists ? rendition_on(viridis(*panel.scale, cell.value)) : rendition(Colour::grey);
      const int last_column = first(along(panel.x, cell.x.hi), width);
      const int last_row = first(along(panel.y, cell.y.hi), rows);
      for (int r = first(along(panel.y, cell.y.lo), rows); r < last_row; ++r) {
        for (int c = first(along(panel.x, cell.x.lo), width); c < last_column; ++c) {
          canvas.put(c, rows - 1 - r, glyph, colour);
        }
      }
    }
  }

  static std::string digit(const ColourScale& scale, double value) {
    const auto [lo, hi] = scale.range;
    const double share = hi > lo ? (value - lo) / (hi - lo) : 0;
    return std::to_string(std::clamp(int(share * 10), 0, 9));
  }

  /// Labels longer than the character that draws the curve stand at its last point.
  static void label(Canvas& canvas, const Panel& panel, const Curve& curve, int width, int rows) {
    if (curve.label.size() < 2) return;
    const auto parts = visible_parts(curve, panel.x, panel.y);
    if (parts.empty()) return;
    const Place end = parts.back().back();
    std::string words = cut_to_columns(printable(curve.label), width);
    if (words.starts_with("\u2212")) words.replace(0, std::string_view("\u2212").size(), "-");
    canvas.write(
        std::clamp(cell_at(end.x, width) - columns_of(words) / 2, 0, width - columns_of(words)),
        rows - 1 - cell_at(end.y, rows), words);
  }

  void legend(const Panel& panel, const Glyphs& glyphs) {
    struct Entry {
      std::string sample;
      Colour colour;
      std::string words;
      std::vector<std::string> cells;
    };
    std::vector<Entry> entries;
    int widest = 0;
    for (const Layer& layer : panel.layers) {
      const std::string words = printable(words_of(layer));
      if (words.empty()) continue;
      const bool point = std::holds_alternative<Points>(layer);
      const char glyph = glyphs.of(layer);
      entries.push_back({point ? std::string("  ") + glyph + "  " : std::string(5, glyph),
                         colour_of(layer), words, cells_of(layer)});
      widest = std::max(widest, columns_of(words));
    }
    constexpr int sample = 7;  // and the blanks around it
    const bool table = !panel.legend_heads.empty();
    constexpr int cell = 8;
    const int further = cell * int(panel.legend_heads.size());
    const int in_row = table ? 1 : std::clamp((columns_ - 1) / (sample + widest + 2), 1, 3);
    const int width = (columns_ - 1) / in_row;
    const auto cells_text = [](const std::vector<std::string>& cells) {
      std::string out;
      for (const std::string& text : cells) {
        out += std::string(std::size_t(std::max(1, cell - columns_of(text))), ' ') + text;
      }
      return out;
    };
    const int room = std::min(width - sample - 1 - further, table ? widest : width);
    if (table) line(std::string(std::size_t(sample + room), ' ') + cells_text(panel.legend_heads));
    std::string row;
    int filled = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Entry& entry = entries[i];
      const std::string words = cut_to_columns(entry.words, room);
      row += " " + painted(entry.sample, entry.colour) + " " + words;
      const int length = sample + columns_of(words);
      filled = table ? room + sample : width;
      row += std::string(std::size_t(std::max(0, filled - length)), ' ');
      row += cells_text(entry.cells);
      if ((i + 1) % std::size_t(in_row) == 0 || i + 1 == entries.size()) {
        line(std::exchange(row, ""));
      }
    }
    for (const std::string& text : panel.key)
      line(" " + cut_to_columns(printable(text), columns_ - 1));
  }

  static Colour colour_of(const Layer& layer) {
    return std::visit(
        [](const auto& one) {
          using T = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<T, Note> || std::is_same_v<T, Cells>) {
            return Colour::grey;
          } else {
            return one.colour;
          }
        },
        layer);
  }

  void print(const Bars& bars) {
    line(cut_to_columns(printable(bars.title), columns_));
    for (const Bar& bar : bars.bars) {
      ends(bar.words, bar.number);
      const double share = std::isfinite(bar.share) ? std::clamp(bar.share, 0.0, 1.0) : 0;
      const auto length = std::size_t(std::lround(share * (columns_ - 1)));
      line(painted(std::string(length, '#'), bar.colour));
    }
  }

  void print(const Lines& lines) {
    line(cut_to_columns(printable(lines.title), columns_));
    for (const std::string& text : lines.texts) line(cut_to_columns(printable(text), columns_));
  }

  const Figure& figure_;
  int columns_;
  bool colour_;
  int left_ = 0;
  std::vector<Panel> panels_;  ///< with their final ranges
  std::string row_label_;      ///< of the vertical axis that panels beside share
  std::string out_;
};

}  // namespace

std::string character_figure(const Figure& figure, int columns, bool colour) {
  return Printer(figure, columns, colour).print();
}

}  // namespace tethercalc::plot
