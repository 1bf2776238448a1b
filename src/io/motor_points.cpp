#include "io/motor_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tethercalc/model/units.hpp"
#include "tethercalc/study/motor.hpp"

namespace tethercalc {

std::string in_practical_units(const MotorPoint& point) {
  return fmt::format("{:.1f} g at {:.2f} W", point.thrust / unit::gram_force, point.power);
}

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

std::optional<std::string> impossible_merit(const MotorEntry& motor) {
  const std::vector<double> merits = figures_of_merit(motor);
  const auto best = std::max_element(merits.begin(), merits.end());
  if (best == merits.end() || *best <= 1) return std::nullopt;
  const MotorPoint& point = motor.curve.vertices()[std::size_t(best - merits.begin()) + 1];
  return fmt::format(
      "has a figure of merit of {:.2f} at {} with a propeller of {:g} inch, and above 1 is "
      "impossible: check the unit of thrust and power, and the propeller",
      *best, in_practical_units(point), *motor.propeller_in);
}

}  // namespace tethercalc
