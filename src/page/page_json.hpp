// Tables and figures as the page takes them.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "tethercalc/report/figure.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc::page {

/// {`title`, `columns` [{`title`, `align`}], `rows` [{`cells`, `emphasis`}]}.
[[nodiscard]] nlohmann::ordered_json table_json(const TitledTable& table);

/// Puts the parts of `figure` behind those in `figures`, see figure_json.
void add_figure(nlohmann::ordered_json& figures, std::string_view kind, const Figure& figure);

}  // namespace tethercalc::page
