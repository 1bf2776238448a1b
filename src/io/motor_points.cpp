#include "io/motor_points.hpp"

#include <fmt/format.h>

#include <vector>

#include "tethercalc/model/units.hpp"

namespace tethercalc {

std::string in_practical_units(const MotorPoint& point) {
  return fmt::format("{:.1f} g at {:.2f} W", point.thrust / unit::gram_force, point.power);
}

/// Fills `entry.curve`, pooling points that do not rise, and says so in `entry.warnings`.
bool set_curve(MotorEntry& entry, std::span<const BenchPoint> measured, const std::string& where,
               Problems& problems) {
  std::vector<MotorPoint> points;
  for (const BenchPoint& bench : measured) points.push_back(bench.point);
  const IsotonicMotorPoints isotonic = isotonic_motor_points(points);
  for (const PooledMotorPoints& pool : isotonic.pooled) {
    std::string members;
    for (const std::size_t i : pool.members) {
      if (!members.empty()) members += ", ";
      members += fmt::format("{} ({})", in_practical_units(points[i]), measured[i].where);
    }
    entry.warnings.push_back(
        {WarningKind::motor_points_pooled,
         fmt::format("{}: power must rise with thrust, so these points were pooled to {}: {}",
                     where, in_practical_units(pool.mean), members)});
  }
  if (isotonic.points.size() < 2) {
    problems.add(
        where,
        fmt::format("a motor curve needs at least 2 points of rising thrust and power, found {}",
                    isotonic.points.size()));
    return false;
  }
  entry.curve = MotorCurve(isotonic.points);
  return true;
}

}  // namespace tethercalc
