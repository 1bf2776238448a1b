// Direct current over a resistive line to a load of constant power.
#pragma once

namespace tethercalc {

/// Lowest voltage in V at the drone that the design allows: max(U_minDC, U/2) (paper eq. for U_min;
/// below U/2 a lower voltage delivers less power, see its appendix).
[[nodiscard]] double lowest_received_voltage(double supply_voltage, double min_input_voltage);

/// Largest power in W that reaches the drone over a loop of `resistance` Ω (> 0) while it keeps the
/// lowest received voltage: U_min(U − U_min)/R (paper eq. (2); Chang 2021). 0 where the converter's
/// cut-off is at or above the supply.
[[nodiscard]] double available_power(double supply_voltage, double min_input_voltage,
                                     double resistance);

/// What the ground supply gives, W, so that `load_power` W arrive over `resistance` Ω (≥ 0):
/// P = U·I with the smaller root of I²R − U·I + P_load = 0, written as 2P/(1 + √(1 − 4RP/U²)) which
/// loses no digits for a small resistance. NaN where there is no real root (by more than 1e-12 of
/// the power): the power cannot be delivered.
[[nodiscard]] double supplied_power(double supply_voltage, double resistance, double load_power);

}  // namespace tethercalc
