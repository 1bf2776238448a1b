// What tests of figures need: gnuplot itself, the pieces of a figure, and what stands in an SVG.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::test {

/// Whether gnuplot is installed; where it is not, a line that reports the test as skipped.
inline bool gnuplot_is_there() {
  const bool there = std::system("command -v gnuplot >/dev/null 2>&1") == 0;
  if (!there) std::printf("SKIPPED: gnuplot is not installed\n");
  return there;
}

/// The panels of a figure, from top to bottom.
inline std::vector<plot::Panel> panels_of(const Figure& figure) {
  std::vector<plot::Panel> out;
  for (const auto& part : figure.parts) {
    if (const auto* panel = std::get_if<plot::Panel>(&part)) out.push_back(*panel);
  }
  return out;
}

/// The layers of one kind, in their order.
template <typename Layer>
std::vector<Layer> layers_of(const plot::Panel& panel) {
  std::vector<Layer> out;
  for (const plot::Layer& layer : panel.layers) {
    if (const auto* one = std::get_if<Layer>(&layer)) out.push_back(*one);
  }
  return out;
}

/// The layer of that kind with these words in the legend; fails the test where there is none.
template <typename Layer>
Layer named(const plot::Panel& panel, const std::string& words) {
  for (const Layer& one : layers_of<Layer>(panel)) {
    if (one.words == words) return one;
  }
  FAIL("nothing in the legend is called " << words);
  return {};
}

/// A text of a picture and the room it takes, in pixels.
struct TextBox {
  std::string text;
  double left = 0, right = 0, top = 0, bottom = 0;
};

/// Advance widths of DejaVu Sans in thousandths of the font size, from U+0020 to U+007E.
inline constexpr std::array advance_widths{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};

/// Width of a text over the font size. Other characters than ASCII count as wide ones, those of
/// East Asian scripts and emoji as high as wide.
inline double text_width(const std::string& text) {
  double width = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0) == 0x80) continue;
    const bool square = (byte >= 0xE3 && byte <= 0xED) || byte >= 0xF0;
    width += byte >= 0x20 && byte < 0x7F ? advance_widths[byte - 0x20] : square ? 1000 : 840;
  }
  return width / 1000;
}

inline std::string without_entities(std::string text) {
  for (const auto& [entity, character] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}) {
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at) {
      text.replace(at, std::string(entity).size(), character);
    }
  }
  return text;
}

/// All texts that an SVG shows.
inline std::vector<TextBox> text_boxes(const std::string& svg) {
  static const std::regex element(
      R"re(<text x="([-\d.]+)" y="([-\d.]+)"( text-anchor="(\w+)")?( font-weight="bold")?>([^<]*)</text>)re");
  constexpr double size = 10;
  std::vector<TextBox> boxes;
  for (std::sregex_iterator it(svg.begin(), svg.end(), element), end; it != end; ++it) {
    const std::smatch& m = *it;
    const std::string text = without_entities(m[6]);
    const double x = std::stod(m[1]);
    const double y = std::stod(m[2]);
    constexpr double bolder = 1.1;  // DejaVu Sans Bold
    const double width = size * text_width(text) * (m[5].matched ? bolder : 1);
    const std::string anchor = m[4];
    const double left = anchor.empty() ? x : anchor == "end" ? x - width : x - width / 2;
    // Capitals and figures rise by 0.73 of the size, the longest tails hang by 0.24.
    boxes.push_back({text, left, left + width, y - 0.73 * size, y + 0.24 * size});
  }
  return boxes;
}

/// The texts alone, in their order.
inline std::vector<std::string> texts_of(const std::string& svg) {
  std::vector<std::string> out;
  for (const TextBox& box : text_boxes(svg)) out.push_back(box.text);
  return out;
}

/// Whether `svg` shows a text that is `words`.
inline bool shows(const std::string& svg, const std::string& words) {
  const std::vector<std::string> texts = texts_of(svg);
  return std::find(texts.begin(), texts.end(), words) != texts.end();
}

/// "a | b" for every two texts that cover each other.
inline std::vector<std::string> overlaps(const std::vector<TextBox>& boxes) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = i + 1; k < boxes.size(); ++k) {
      const TextBox& a = boxes[i];
      const TextBox& b = boxes[k];
      if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) {
        out.push_back(a.text + " | " + b.text);
      }
    }
  }
  return out;
}

/// What a good figure has.
inline const std::vector<std::string> no_problems;

/// What is wrong with the places of the texts in an SVG of one column's width: those that cover
/// each other or reach beyond the edges.
inline std::vector<std::string> layout_problems(const std::string& svg) {
  const std::vector<TextBox> boxes = text_boxes(svg);
  std::vector<std::string> out = overlaps(boxes);
  constexpr double width = 85 / 25.4 * 96;
  for (const TextBox& box : boxes) {
    if (box.left < -1 || box.right > width + 1 || box.top < 0)
      out.push_back("outside: " + box.text);
  }
  if (boxes.empty()) out.emplace_back("no text");
  return out;
}

}  // namespace tethercalc::test
