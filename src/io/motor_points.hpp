// Measured points of a motor on their way to its curve.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "io/checked_values.hpp"
#include "tethercalc/model/motor_curve.hpp"

namespace tethercalc {

/// A measured point and what messages call its place.
struct BenchPoint {
  MotorPoint point;
  std::string where;
};

/// A point for people: "250.0 g at 25.00 W".
std::string in_practical_units(const MotorPoint& point);

/// Fills `entry.curve`, pooling points that do not rise, and says so in `entry.warnings`. False,
/// with the reason among the problems, where too few points rise.
bool set_curve(MotorEntry& entry, std::span<const BenchPoint> measured, const std::string& where,
               Problems& problems);

/// "has a figure of merit of 1.31 at …" of a motor with a point that does better than momentum
/// theory lets its propeller do; nothing where there is none, or no known propeller.
[[nodiscard]] std::optional<std::string> impossible_merit(const MotorEntry& motor);

}  // namespace tethercalc
