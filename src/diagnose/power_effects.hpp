// The effects that a power log can show.
#pragma once

#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"

namespace tethercalc {

/// Entries of the catalogue for power logs, from the ground to the air.
[[nodiscard]] std::vector<Effect> power_effects();

}  // namespace tethercalc
