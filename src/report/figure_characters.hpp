// A figure of characters, for terminals.
#pragma once

#include <string>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

/// Lines of at most `columns` columns, in UTF-8, without blanks at their ends. Every series has a
/// character of its own: curves one each, single points the first letter of their words, heat maps
/// the digits 0 to 9. `colour` adds the colour codes of a terminal with 256 colours.
[[nodiscard]] std::string character_figure(const Figure& figure, int columns, bool colour);

}  // namespace tethercalc::plot
