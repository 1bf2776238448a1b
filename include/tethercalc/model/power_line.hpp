// Direct current over a resistive line to a load of constant power.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tethercalc {

/// Lowest voltage in V at the drone that the design allows: max(U_minDC, U/2) (paper eq. for U_min;
/// below U/2 a lower voltage delivers less power, see its appendix).
[[nodiscard]] inline double lowest_received_voltage(double supply_voltage,
                                                    double min_input_voltage) {
  return std::max(min_input_voltage, supply_voltage / 2);
}

/// Largest power in W that reaches the drone over a loop of `resistance` Ω (> 0) while it keeps the
/// lowest received voltage: U_min(U − U_min)/R (paper eq. (2); Chang 2021). 0 where the converter's
/// cut-off is at or above the supply.
[[nodiscard]] inline double available_power(double supply_voltage, double min_input_voltage,
                                            double resistance) {
  const double received = lowest_received_voltage(supply_voltage, min_input_voltage);
  return std::max(0.0, received * (supply_voltage - received) / resistance);
}

/// What the ground supply gives, W, so that `load_power` W arrive over `resistance` Ω (≥ 0):
/// P = U·I with the smaller root of I²R − U·I + P_load = 0, written as 2P/(1 + √(1 − 4RP/U²)) which
/// loses no digits for a small resistance. NaN where there is no real root (by more than 1e-12 of
/// the power): the power cannot be delivered.
[[nodiscard]] inline double supplied_power(double supply_voltage, double resistance,
                                           double load_power) {
  const double discriminant = 1 - 4 * resistance * load_power / (supply_voltage * supply_voltage);
  // A load at the very limit of the line, where optima may lie, is above it to rounding only.
  if (!(discriminant >= -1e-9)) return std::numeric_limits<double>::quiet_NaN();
  return 2 * load_power / (1 + std::sqrt(std::max(0.0, discriminant)));
}

}  // namespace tethercalc
