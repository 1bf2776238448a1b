// Words and tables about how a cable hangs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/cable_shape.hpp"

namespace tethercalc {

/// "hangs", "too_short", …: how answers name a `CableOutcome`, in its order, and after those
/// "touches_ground".
[[nodiscard]] std::span<const std::string_view> cable_outcome_names();

/// The one of a cable, "touches_ground" where its shape is below the ground.
[[nodiscard]] std::string_view cable_outcome_name(const ShapeStudy& study);

/// Why a cable has no shape.
[[nodiscard]] std::string no_shape_sentence(const ShapeStudy& study, const ShapeRequest& request);

/// For people: loads, tensions, what the straight tether would say, the shape at eleven places,
/// and notes. `area` in m².
[[nodiscard]] std::string cable_shape_text(const DesignFile& file, double area,
                                           const ShapeRequest& request, const ShapeStudy& study,
                                           const TextStyle& style);

/// The same; `stations` are eleven [s_m, x_m, y_m, z_m, tension_N].
[[nodiscard]] nlohmann::ordered_json cable_shape_json(const DesignFile& file, double area,
                                                      const ShapeStudy& study);

/// Loads and tensions of each condition in which the cable hangs.
[[nodiscard]] TitledTable flown_cable_table(const std::vector<FlownShape>& shapes);

/// Whether it touches the ground, and when there is no shape.
[[nodiscard]] std::vector<std::string> flown_cable_sentences(const std::vector<FlownShape>& shapes);

/// A row a point: s_m, x_m, y_m, z_m, tension_N.
[[nodiscard]] std::string cable_shape_csv(const ShapeStudy& study);

/// {"cases": [{"id", "result"}]}, with the keys that collections of exact solutions use; `outcome`
/// alone where there is no shape. Extremes along a cable in wind are those of 4001 points.
[[nodiscard]] nlohmann::ordered_json cable_cases_json(std::span<const SolvedCase> cases);

}  // namespace tethercalc
