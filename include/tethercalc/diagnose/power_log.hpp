// Electrical measurements along the supply chain of a tethered flight, over time.
#pragma once

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

}  // namespace tethercalc
