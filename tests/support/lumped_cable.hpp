// A cable as masses on springs that are let swing until they rest: an independent check, which
// shares nothing with the solver but the law of drag.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace tethercalc::test {

/// A cable of point masses between (0, 0, 0) and `end`.
struct LumpedCable {
  double length = 1;       ///< m
  double weight = 1;       ///< N/m
  double stiffness = 1e3;  ///< N
  double drag_width = 0;   ///< ½·ρ·C·d, kg/m²
  /// That C is times, by the speed across in m/s.
  std::function<double(double speed)> coefficient = [](double) { return 1.0; };
  std::array<double, 3> end{};
  std::function<std::array<double, 3>(double height)> wind;  ///< m/s
  int pieces = 40;
};

/// Force in N on the drone at the end, once all is at rest.
inline std::array<double, 3> settled_force_on_end(const LumpedCable& cable) {
  using Vector = std::array<double, 3>;
  const int n = cable.pieces;
  const double piece = cable.length / n;
  const double mass = cable.weight / 9.80665 * piece;
  const double spring = cable.stiffness / piece;
  const double step = 0.5 * std::sqrt(mass / spring);
  // Between too little damping, which swings for long, and too much, which creeps.
  const double damping = 2.0 * std::sqrt(9.80665 / cable.length);
  std::vector<Vector> at(static_cast<std::size_t>(n) + 1);
  std::vector<Vector> speed(at.size(), Vector{});
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double share = static_cast<double>(i) / n;
    // Not straight: a cable longer than the distance bulges somewhere from the start.
    const double bulge = 0.3 * cable.length * share * (1 - share);
    at[i] = {share * cable.end[0] + bulge, share * cable.end[1] + 0.5 * bulge,
             share * cable.end[2]};
  }
  std::vector<Vector> force(at.size());
  Vector on_end{};
  const auto add_forces = [&] {
    for (Vector& f : force) f = {0, 0, -cable.weight * piece};
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      Vector way;
      for (std::size_t k = 0; k < 3; ++k) way[k] = at[i + 1][k] - at[i][k];
      const double distance = std::hypot(way[0], way[1], way[2]);
      const double tension = std::max(0.0, spring * (distance - piece));
      const Vector wind = cable.wind(0.5 * (at[i][2] + at[i + 1][2]));
      double along = 0;
      for (std::size_t k = 0; k < 3; ++k) along += wind[k] * way[k] / distance;
      Vector across;
      for (std::size_t k = 0; k < 3; ++k) across[k] = wind[k] - along * way[k] / distance;
      const double speed_across = std::hypot(across[0], across[1], across[2]);
      const double pressed =
          cable.drag_width * cable.coefficient(speed_across) * piece * speed_across;
      for (std::size_t k = 0; k < 3; ++k) {
        const double pull = tension * way[k] / distance;
        const double drag = 0.5 * pressed * across[k];
        force[i][k] += pull + drag;
        force[i + 1][k] += drag - pull;
      }
    }
    on_end = force.back();
    on_end[2] += 0.5 * cable.weight * piece;  // of the last mass only half belongs to the cable
  };
  const int steps = static_cast<int>(60 * std::sqrt(cable.length / 9.80665) / step);
  for (int s = 0; s < steps; ++s) {
    add_forces();
    for (std::size_t i = 1; i + 1 < at.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        speed[i][k] = (speed[i][k] + step * force[i][k] / mass) / (1 + step * damping);
        at[i][k] += step * speed[i][k];
      }
    }
  }
  return on_end;
}

}  // namespace tethercalc::test
