// Figures as JSON, for drawers that are no part of the program.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// A list, one object a part of the figure, each with `kind` (as given), `part` (its index),
/// `type`, and `title`; the first also carries `heading` and `description` of the whole.
/// - "panel": the axes `x`, `y` and, where there is one, `top` ({`label`, `log`, `lo`, `hi`,
///   `numbers`, `ticks` [{`at`, `words`}]}), `beside`, `to_scale`, `remark`, `legend_heads`, `key`,
///   `scale` ({`label`, `lo`, `hi`} or null); `series`: curves, points and bands in the order in
///   which they are drawn, {`name`, `role` ("curve", "points", "band"), `x`, `y` (a band: `lower`
///   and `upper`), `style` {`colour` (name), `code` ("#0072B2"), `dash` (lengths), `width`,
///   `mark`}, `label`, `cells`, `sizes`, `values`}; `marks`: what else stands there, {`role`
///   ("span", "reference", "note", "cells")} with its members.
/// - "bars": `bars` [{`words`, `share`, `number`, `code`}]; "lines": `texts`.
///
/// Numbers that do not exist are null: gaps in a line.
[[nodiscard]] nlohmann::ordered_json figure_json(std::string_view kind, const Figure& figure);

}  // namespace tethercalc
