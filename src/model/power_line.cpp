#include "tethercalc/model/power_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
  // At exactly the most that the line delivers, rounding decides the sign.
  constexpr double rounding = 1e-12;
  if (!(discriminant >= -rounding)) return std::numeric_limits<double>::quiet_NaN();
  return 2 * load_power / (1 + std::sqrt(std::max(0.0, discriminant)));
}

}  // namespace tethercalc
