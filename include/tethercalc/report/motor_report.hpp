// A motor for people and spreadsheets: its points, and how good they are.
#pragma once

#include <optional>
#include <string>

#include "tethercalc/identify/thrust_expo.hpp"
#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// The motor's points with thrust per power and, where the propeller is known, the figure of merit;
/// where it comes from and what was done to its rows.
[[nodiscard]] std::string motor_text(const MotorEntry& motor, const TextStyle& style);

/// One row a point: thrust_g, power_W, efficiency_g_per_W, figure_of_merit.
[[nodiscard]] std::string motor_csv(const MotorEntry& motor);

/// MOT_THST_EXPO as a parameter file of ArduPilot's ground stations, with what belongs to it and
/// how it was found; `pulses` where throttles were pulses.
[[nodiscard]] std::string thrust_expo_file(const MotorEntry& motor, const ThrustExpo& curve,
                                           const SpinRange& range,
                                           const std::optional<PulseRange>& pulses);

}  // namespace tethercalc
