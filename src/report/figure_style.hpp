// What the colours and dashes of figures look like on paper.
#pragma once

#include <string>
#include <string_view>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

/// "#RRGGBB" of viridis at `share` of the scale, 0 to 1.
[[nodiscard]] std::string viridis(double share);
[[nodiscard]] std::string viridis(const ColourScale& scale, double value);

/// What a drawer calls the colour: "#0072B2", "blue".
[[nodiscard]] std::string_view colour_code(Colour colour);
[[nodiscard]] std::string_view colour_name(Colour colour);

/// Lengths of dashes and gaps in pixels, separated by spaces; empty for a solid line.
[[nodiscard]] std::string_view dash_lengths(Dash dash);

}  // namespace tethercalc::plot
