// A figure as SVG 1.1, for itself or within a page.
#pragma once

#include <string>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

/// The element <svg> with its title and description; no XML declaration before it. All its ids
/// begin with the figure's.
[[nodiscard]] std::string svg_element(const Figure& figure, double width_mm = 85);

}  // namespace tethercalc::plot
