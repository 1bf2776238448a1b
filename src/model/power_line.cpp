#include "tethercalc/model/power_line.hpp"

#include <algorithm>
#include <cmath>

#include "model/constants.hpp"

namespace tethercalc {

double lowest_received_voltage(double supply_voltage, double min_input_voltage) {
  return std::max(min_input_voltage, supply_voltage / 2);
}

double available_power(double supply_voltage, double min_input_voltage, double resistance) {
  const double received = lowest_received_voltage(supply_voltage, min_input_voltage);
  return std::max(0.0, received * (supply_voltage - received) / resistance);
}

double supplied_power(double supply_voltage, double resistance, double load_power) {
  const double discriminant = 1 - 4 * resistance * load_power / (supply_voltage * supply_voltage);
  // A load at the very limit of the line, where optima may lie, is above it to rounding only.
  if (!(discriminant >= -1e-9)) return nan;
  return 2 * load_power / (1 + std::sqrt(std::max(0.0, discriminant)));
}

}  // namespace tethercalc
