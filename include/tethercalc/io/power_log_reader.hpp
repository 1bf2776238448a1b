// Power logs from CSV.
#pragma once

#include <string_view>

#include "tethercalc/diagnose/power_log.hpp"

namespace tethercalc {

/// Reads a CSV text, called `name` in messages, with the columns `time_s, height_m, airspeed_m_s,
/// supply_voltage_V, supply_current_A` and, optionally, `ambient_temperature_C, drone_voltage_V,
/// bus_voltage_V, bus_current_A`, in any order, named exactly so.
///
/// Throws InputError with every problem of the file and its line:
/// missing, unknown or repeated columns; rows of the wrong length; cells that are empty or not a
/// finite number; temperatures below absolute zero; time that does not increase.
[[nodiscard]] PowerLog parse_power_log(std::string_view text, std::string_view name);

}  // namespace tethercalc
