// The paper's equations written down once more, as plainly as they stand there: angles by
// trigonometry, roots by bisection, curves by walking along them. Slow, and sharing no code with
// the library beyond the data that describes a design.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "tethercalc/model/design.hpp"

namespace tethercalc::test::plain {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Root of a function that changes sign from minus to plus once in [lo, hi].
template <typename Function>
double bisect(Function f, double lo, double hi) {
  for (int step = 0; step < 200 && hi > lo; ++step) {
    const double middle = lo + (hi - lo) / 2;
    if (middle == lo || middle == hi) break;
    (f(middle) > 0 ? hi : lo) = middle;
  }
  return lo + (hi - lo) / 2;
}

inline double motor_power(const MotorCurve& motor, double thrust) {
  const auto v = motor.vertices();
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (thrust <= v[i].thrust) {
      const double share = (thrust - v[i - 1].thrust) / (v[i].thrust - v[i - 1].thrust);
      return v[i - 1].power + share * (v[i].power - v[i - 1].power);
    }
  }
  return infinity;
}

inline double motor_thrust(const MotorCurve& motor, double power) {
  const auto v = motor.vertices();
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (power <= v[i].power) {
      const double share = (power - v[i - 1].power) / (v[i].power - v[i - 1].power);
      return v[i - 1].thrust + share * (v[i].thrust - v[i - 1].thrust);
    }
  }
  return v.back().thrust;
}

inline double efficiency(const Converter& converter, double output) {
  const auto& p = converter.efficiency;
  if (output <= p.front().output_power) return p.front().efficiency;
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (output <= p[i].output_power) {
      const double share =
          (output - p[i - 1].output_power) / (p[i].output_power - p[i - 1].output_power);
      return p[i - 1].efficiency + share * (p[i].efficiency - p[i - 1].efficiency);
    }
  }
  return p.back().efficiency;
}

/// Output for an input, by bisection: the input rises with the output, and η ≤ 1.
inline double converter_output(const Converter& converter, double input) {
  if (input <= 0) return 0;
  return bisect([&](double output) { return output / efficiency(converter, output) - input; }, 0,
                input * (1 + 1e-12));
}

struct Point {
  double resistance, tether_mass, pitch, available_power, available_thrust, necessary_thrust;
  double headroom, drone_power, total_power;
  bool tilts_too_far;
};

inline Point evaluate(const Design& d, double area, Condition condition) {
  Point p{};
  const Tether& t = d.tether;
  const double radius = std::sqrt(area / pi);
  const double wall = t.insulation.thickness;
  const double rho = t.conductor.resistivity_20C *
                     (1 + t.conductor.temperature_coefficient * (t.conductor_temperature_C - 20));
  p.resistance = 2 * (t.length + t.spooled_length) * rho / area + t.contact_resistance;
  const double insulation_area = pi * ((radius + wall) * (radius + wall) - radius * radius);
  p.tether_mass =
      2 * t.length * (t.conductor.density * area + t.insulation.density * insulation_area);
  const double weight = (d.drone.mass + p.tether_mass) * d.flight.gravity;

  const double v = d.flight.headwind + (condition == Condition::forward ? d.flight.airspeed : 0);
  const AirframeDrag& drag = d.drone.drag;
  const double leaning = v < 0 ? 1 - drag.fore_aft_asymmetry : 1 + drag.fore_aft_asymmetry;
  const auto airframe = [&](double theta) {
    return 0.5 * d.flight.air_density *
           (drag.front_area * std::cos(theta) + drag.top_area * std::sin(theta)) *
           (v * v + drag.linear_speed * std::abs(v)) * leaning;
  };
  const double tether_drag = 0.5 * d.flight.air_density * t.drag_coefficient *
                             (1 + 2.1 * t.vibration_amplitude) * t.projection_factor * 4 *
                             t.length * (radius + wall) * v * v;
  const double theta = bisect(
      [&](double x) { return weight * std::sin(x) - (airframe(x) + tether_drag) * std::cos(x); }, 0,
      pi / 2);
  p.tilts_too_far = theta > d.requirements.max_pitch;
  p.pitch = v < 0 ? -theta : theta;

  const double n = d.drone.motor_count;
  // Glauert's induced velocity of a disc that leans by θ: ν√((μ cosθ)² + (μ sinθ + ν)²) = 1.
  const double mu = std::abs(v) / d.drone.translational_lift.hover_induced_speed;
  const double through = mu * std::sin(theta);
  const double induced = bisect(
      [&](double nu) { return nu * std::hypot(mu * std::cos(theta), through + nu) - 1; }, 0, 1);
  const double f = d.drone.motor_power_factor *
                   (1 - d.drone.translational_lift.induced_share * (1 - induced - through));
  const double u = d.supply.voltage;
  const double u_min = std::max(d.supply.converter.min_input_voltage, u / 2);
  p.available_power = u_min * (u - u_min) / p.resistance;
  const double output =
      converter_output(d.supply.converter, p.available_power - d.drone.auxiliary_power);
  p.available_thrust = motor_thrust(d.drone.motor, output / (n * f));
  p.necessary_thrust = weight / (n * std::cos(theta));
  p.headroom = p.available_thrust / p.necessary_thrust;

  const double motors_input = n * f * motor_power(d.drone.motor, p.necessary_thrust);
  p.drone_power =
      motors_input / efficiency(d.supply.converter, motors_input) + d.drone.auxiliary_power;
  // U·I = P + I²R: the smaller root by the textbook's formula.
  const double discriminant = u * u - 4 * p.resistance * p.drone_power;
  p.total_power = p.drone_power < infinity && discriminant >= 0
                      ? u * (u - std::sqrt(discriminant)) / (2 * p.resistance)
                      : infinity;
  return p;
}

}  // namespace tethercalc::test::plain
