#include "report/figure_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tethercalc::plot {
namespace {

struct ColourEntry {
  std::string_view name;
  std::string_view code;
};
constexpr std::array<ColourEntry, 8> colours{{{"ink", "#000000"},
                                              {"orange", "#E69F00"},
                                              {"sky", "#56B4E9"},
                                              {"green", "#009E73"},
                                              {"blue", "#0072B2"},
                                              {"vermilion", "#D55E00"},
                                              {"purple", "#CC79A7"},
                                              {"grey", "#999999"}}};

}  // namespace

std::string viridis(double share) {
  constexpr std::array<std::array<int, 3>, 10> knots{{{0x44, 0x01, 0x54},
                                                      {0x48, 0x28, 0x78},
                                                      {0x3e, 0x4a, 0x89},
                                                      {0x31, 0x68, 0x8e},
                                                      {0x26, 0x82, 0x8e},
                                                      {0x1f, 0x9e, 0x89},
                                                      {0x35, 0xb7, 0x79},
                                                      {0x6e, 0xce, 0x58},
                                                      {0xb5, 0xde, 0x2b},
                                                      {0xfd, 0xe7, 0x25}}};
  const double at = std::clamp(share, 0.0, 1.0) * double(knots.size() - 1);
  const auto first = std::min(std::size_t(at), knots.size() - 2);
  const double rest = at - double(first);
  std::array<int, 3> mixed{};
  for (std::size_t c = 0; c < 3; ++c) {
    mixed[c] = int(std::lround(knots[first][c] + rest * (knots[first + 1][c] - knots[first][c])));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

std::string viridis(const ColourScale& scale, double value) {
  const auto [lo, hi] = scale.range;
  return viridis(hi > lo ? (value - lo) / (hi - lo) : 0.5);
}

std::string_view colour_code(Colour colour) { return colours.at(std::size_t(colour)).code; }
std::string_view colour_name(Colour colour) { return colours.at(std::size_t(colour)).name; }

std::string_view dash_lengths(Dash dash) {
  constexpr std::array<std::string_view, 5> lengths{"", "5 2.5", "1.2 2.2", "7 2.2 1.4 2.2",
                                                    "7 2.2 1.4 2.2 1.4 2.2"};
  return lengths.at(std::size_t(dash));
}

}  // namespace tethercalc::plot
