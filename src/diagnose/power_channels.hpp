// The channels of a power log, described once.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "tethercalc/diagnose/power_log.hpp"

namespace tethercalc {

struct PowerChannel {
  std::string_view name;  ///< of its CSV column
  std::vector<double> PowerLog::*values;
  bool optional = false;
  bool may_rest = true;  ///< a steady reading is possible in flight
};

/// All but the time.
inline constexpr std::array<PowerChannel, 8> power_channels{{
    {"height_m", &PowerLog::height},
    {"airspeed_m_s", &PowerLog::airspeed},
    {"ambient_temperature_C", &PowerLog::ambient_temperature_C, true},
    {"supply_voltage_V", &PowerLog::supply_voltage},
    {"supply_current_A", &PowerLog::supply_current, false, false},
    {"drone_voltage_V", &PowerLog::drone_voltage, true, false},
    {"bus_voltage_V", &PowerLog::bus_voltage, true},
    {"bus_current_A", &PowerLog::bus_current, true, false},
}};

}  // namespace tethercalc
