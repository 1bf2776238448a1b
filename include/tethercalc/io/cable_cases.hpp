// Bare cables in a file, to hold solvers against each other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/study/cable_shape.hpp"

namespace tethercalc {

/// Cases of JSON text, {"cases": [{"id", "input"}]}. An input has `L_m`, `w_N_per_m`, `EA_N` (a
/// number or null), and either `x_m` (≥ 0) and `z_m`, or `drone_m` and `wind_m_s` (three numbers
/// each), `diameter_m`, `Cd` and `rho_kg_m3`. What else stands beside `id` and `input` is not read.
/// @throws InputError with all problems.
[[nodiscard]] std::vector<CableCase> parse_cable_cases(std::string_view text, std::string name);

}  // namespace tethercalc
