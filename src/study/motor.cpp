#include "tethercalc/study/motor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace tethercalc {

double ideal_hover_power(double thrust, double diameter, double air_density) {
  const double disc = std::numbers::pi / 4 * diameter * diameter;
  return thrust * std::sqrt(thrust / (2 * air_density * disc));
}

std::vector<double> figures_of_merit(const MotorEntry& motor) {
  std::vector<double> out;
  if (!motor.propeller_in) return out;
  const double diameter = *motor.propeller_in * metres_per_inch;
  const double density = motor.curve.measured_in().value_or(standard_air_density);
  for (const MotorPoint& point : motor.curve.vertices().subspan(1)) {
    out.push_back(ideal_hover_power(point.thrust, diameter, density) / point.power);
  }
  return out;
}

FigureOfMeritSpread figure_of_merit_spread(std::span<const MotorEntry> motors) {
  std::vector<double> all;
  for (const MotorEntry& motor : motors) {
    const std::vector<double> own = figures_of_merit(motor);
    all.insert(all.end(), own.begin(), own.end());
  }
  if (all.empty()) throw std::invalid_argument("no motor has a known propeller");
  std::ranges::sort(all);
  FigureOfMeritSpread out{all.front(), all[all.size() / 2], all.back(), all.size(), 0};
  std::vector<double> deviations;  // power goes with the inverse
  for (const double merit : all) deviations.push_back(std::abs(out.median / merit - 1));
  std::ranges::sort(deviations);
  constexpr double share = 0.95;
  const auto last = static_cast<std::size_t>(std::ceil(share * double(deviations.size()))) - 1;
  out.power_band = deviations[last];
  return out;
}

MotorCurve momentum_curve(double factor, double max_thrust) {
  // Chords of T^1.5 between thrusts of ratio r lie at most 3/32·(ln r)² above it.
  constexpr int steps = 30;
  constexpr double least = 0.05;
  std::vector<MotorPoint> points;
  for (int i = steps; i >= 0; --i) {
    const double thrust = max_thrust * std::pow(least, double(i) / steps);
    points.push_back({thrust, factor * thrust * std::sqrt(thrust)});
  }
  return MotorCurve(std::move(points));
}

MotorCurve generic_motor_curve(const GenericMotorRequest& request) {
  const bool in_range = request.diameter > 0 && request.max_thrust > 0 && request.air_density > 0 &&
                        request.figure_of_merit > 0 && request.figure_of_merit < 1;
  if (!in_range) throw std::invalid_argument("no such motor");
  MotorCurve curve = momentum_curve(
      ideal_hover_power(1, request.diameter, request.air_density) / request.figure_of_merit,
      request.max_thrust);
  curve.set_measured_in(request.air_density);
  return curve;
}

std::vector<MotorEntry> alike_motors(std::span<const MotorEntry> motors, const MotorEntry& own) {
  constexpr std::size_t others = 8;
  std::vector<std::pair<double, std::size_t>> nearest;  // how far, and which
  for (std::size_t i = 0; i < motors.size(); ++i) {
    if (motors[i].id == own.id) continue;
    const double ratio = motors[i].curve.max_thrust() / own.curve.max_thrust();
    nearest.emplace_back(std::abs(std::log(ratio)), i);
  }
  std::ranges::sort(nearest);
  nearest.resize(std::min(nearest.size(), others));
  std::vector<MotorEntry> out;
  bool own_is_among = false;
  for (std::size_t i = 0; i < motors.size(); ++i) {
    const bool is_own = motors[i].id == own.id;
    const auto is_this = [i](const auto& near) { return near.second == i; };
    if (is_own || std::ranges::any_of(nearest, is_this)) out.push_back(motors[i]);
    own_is_among = own_is_among || is_own;
  }
  if (!own_is_among) out.push_back(own);
  return out;
}

}  // namespace tethercalc
