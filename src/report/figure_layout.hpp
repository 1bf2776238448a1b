// Where everything of a figure stands on paper, in pixels of 1/96 inch from the upper left corner.
// The drawers on paper share it, and so show the same picture.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

inline constexpr double font_px = 10;                ///< 7.5 pt
inline constexpr double middle_px = 0.36 * font_px;  ///< of letters, above their base line
inline constexpr double tick_length = 3.5;           ///< outwards

/// A place on paper.
struct Place {
  double x = 0;
  double y = 0;
};

/// A rectangle on paper.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
};

enum class Anchor { left, middle, right };

/// Words on their base line; printable, and cut to the room they have.
struct PlacedText {
  std::string words;
  Place at;
  Anchor anchor = Anchor::left;
  bool bold = false;
};

/// A tick with its place along the axis, and words for which there is room.
struct PlacedTick {
  double at = 0;     ///< on the axis
  double place = 0;  ///< on paper: x of a horizontal axis, y of a vertical one
  std::string words;
};

/// The sample of a layer in the legend.
struct PlacedSample {
  const Layer* layer = nullptr;
  Box box;
};

/// A panel whose axes have their final ranges.
struct PlacedPanel {
  const Panel* panel = nullptr;
  Axis x;
  Axis y;
  Box frame;
  std::vector<PlacedTick> x_ticks;
  std::vector<PlacedTick> y_ticks;
  std::vector<PlacedTick> top_ticks;
  std::vector<PlacedSample> samples;
  Box scale;                            ///< of colours, where the panel has them
  std::vector<PlacedTick> scale_ticks;  ///< along it

  [[nodiscard]] Place place(double at_x, double at_y) const;
};

/// A bar and its place.
struct PlacedBar {
  Box box;
  Colour colour = Colour::ink;
};

/// A whole figure. The words of ticks stand with them, all others here.
struct FigureLayout {
  double width = 0;
  double height = 0;
  std::vector<PlacedText> texts;
  std::vector<PlacedPanel> panels;
  std::vector<PlacedBar> bars;
};

/// `figure` must outlive the layout.
[[nodiscard]] FigureLayout lay_out(const Figure& figure, double width_mm);

/// How wide `text` is at most in a usual sans-serif of `font_px`; bold letters are wider.
[[nodiscard]] double text_width(std::string_view text, bool bold = false);

/// A line made of the parts of a curve within the panel, in shares of the frame from its lower left
/// corner: NaN and what lies outside part it.
[[nodiscard]] std::vector<std::vector<Place>> visible_parts(const Curve& curve, const Axis& x,
                                                            const Axis& y);

/// The corners of a band within the panel, in shares of the frame.
[[nodiscard]] std::vector<Place> band_outline(const Band& band, const Axis& x, const Axis& y);

/// The part of `range` within the axis, in shares of it; nothing where there is none.
[[nodiscard]] std::optional<Range> visible_part(const Axis& axis, Range range);

/// What stands in the legend for the layer; empty where it is not there.
[[nodiscard]] const std::string& words_of(const Layer& layer);

/// Further columns of the legend.
[[nodiscard]] std::vector<std::string> cells_of(const Layer& layer);

/// Ranges widened around their middle so that one unit is equally long on all axes of all panels,
/// whose frames are as large as `frames`.
void widen_to_scale(std::vector<std::pair<Axis*, Axis*>> axes, const std::vector<Box>& frames);

}  // namespace tethercalc::plot
