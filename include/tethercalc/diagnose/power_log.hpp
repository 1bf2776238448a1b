// Electrical measurements along the supply chain of a tethered flight, over time.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace tethercalc {

/// Time series, one element a sample; every vector is as long as `time`, or empty where the
/// channel was not measured (only those marked optional may be). Time strictly increases.
///
/// *Supply* is the ground end of the tether, *drone* the converter's input, *bus* the converter's
/// output, which feeds the motors. The deployed length of the tether is the height.
struct PowerLog {
  std::vector<double> time;                   ///< s
  std::vector<double> height;                 ///< m above the ground station
  std::vector<double> airspeed;               ///< m/s
  std::vector<double> ambient_temperature_C;  ///< °C, optional
  std::vector<double> supply_voltage;         ///< V
  std::vector<double> supply_current;         ///< A
  std::vector<double> drone_voltage;          ///< V, optional
  std::vector<double> bus_voltage;            ///< V, optional
  std::vector<double> bus_current;            ///< A, optional
};

/// A channel as files and messages name it.
struct PowerChannel {
  std::string_view name;                  ///< of its CSV column
  std::vector<double> PowerLog::*values;  ///< where a log has it
  bool optional = false;                  ///< may be empty
  bool may_rest = true;                   ///< a steady reading is possible in flight
};

/// The channels of a power log, described once: all but the time.
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
