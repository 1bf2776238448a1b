// Designs as odd as a user could write them.
#pragma once

#include <algorithm>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc::test {

/// Holybro AIR2216 920KV with a 10" propeller, as its maker lists it: thrust in gram-force and
/// efficiency in gram-force per watt.
inline MotorCurve air2216() {
  const double grams[] = {210, 259, 309, 373,  447,  536,  628, 729,
                          814, 906, 993, 1087, 1191, 1289, 1332};
  const double grams_per_watt[] = {9.12, 8.67, 8.45, 8.15, 7.76, 7.39, 7.01, 6.73,
                                   6.44, 6.18, 5.88, 5.65, 5.43, 5.18, 5.13};
  std::vector<MotorPoint> points;
  for (int i = 0; i < 15; ++i) {
    points.push_back({grams[i] * unit::gram_force, grams[i] / grams_per_watt[i]});
  }
  return MotorCurve(points);
}

/// The paper's drone, tether and flight (its Table I and section V).
inline Design published_design() {
  Design d;
  d.drone.mass = 1.710;
  d.drone.motor_count = 4;
  d.drone.motor = air2216();
  d.drone.auxiliary_power = 15;
  d.drone.drag = {0.01451, 0.01361, 19.27, 0};
  d.tether.length = 30;
  d.tether.conductor.resistivity_20C = 0.0278e-6;
  d.tether.conductor.temperature_coefficient = 0;
  d.tether.conductor.density = 2700;
  d.tether.insulation.density = 1360;
  d.tether.insulation.thickness = 0.75e-3;
  d.supply.voltage = 75;
  d.supply.converter.efficiency = {{0, 0.9}};
  d.supply.converter.min_input_voltage = 20;
  d.flight.airspeed = 30 / 3.6;
  return d;
}

/// A motor curve whose pieces all follow P = c·T^1.4 but for `roughness`, the share by which its
/// steps are off: 0 is convex, 0.9 has kinks of every kind.
inline MotorCurve random_motor(Random& random, double roughness) {
  const int count = random.integer(2, 30);
  const double most = random.magnitude(3, 60);
  const double scale = random.uniform(4, 10);
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(random.uniform(0.2, 1));
  double sum = 0;
  for (const double step : steps) sum += step;
  std::vector<MotorPoint> points;
  MotorPoint last;
  for (const double step : steps) {
    MotorPoint next;
    next.thrust = last.thrust + most * step / sum;
    const double rise = scale * (std::pow(next.thrust, 1.4) - std::pow(last.thrust, 1.4));
    next.power = last.power + rise * random.uniform(1 - roughness, 1 + roughness);
    points.push_back(next);
    last = next;
  }
  return MotorCurve(points);
}

/// A converter curve of one to five points.
inline Converter random_converter(Random& random, double voltage) {
  Converter converter;
  converter.efficiency = {{0, random.uniform(0.6, 0.99)}};
  if (random.chance(0.4)) {
    double output = 0;
    for (int i = random.integer(1, 4); i > 0; --i) {
      const EfficiencyPoint last = converter.efficiency.back();
      output += random.magnitude(20, 500);
      // Rising faster than this, it would draw less power at a higher load.
      const double most = last.efficiency * (0.1 + 0.9 * output / std::max(last.output_power, 1.0));
      converter.efficiency.push_back(
          {output,
           std::min(most, std::clamp(last.efficiency + random.uniform(-0.15, 0.15), 0.5, 0.99))});
    }
  }
  if (random.chance(0.7)) converter.min_input_voltage = random.uniform(0, 0.8) * voltage;
  return converter;
}

/// Mostly near what can be built, and often near the edge of what can fly.
inline Design random_design(Random& random) {
  Design d;
  d.drone.motor = random_motor(random, random.chance(0.5) ? 0 : random.uniform(0, 0.9));
  d.drone.motor_count = random.integer(3, 8);
  // Without a tether the motors can lift between 1.2 and 6 times the drone.
  const double most_mass = d.drone.motor.max_thrust() * d.drone.motor_count / standard_gravity;
  d.drone.mass = most_mass / random.uniform(1.2, 6);
  d.drone.auxiliary_power = random.chance(0.8) ? random.uniform(0, 60) : 0;
  d.drone.drag = {random.uniform(0.005, 0.06), random.uniform(0.005, 0.06),
                  random.chance(0.7) ? random.uniform(0, 30) : 0,
                  random.chance(0.3) ? random.uniform(-0.5, 0.5) : 0};
  d.tether.length = random.magnitude(5, 300);
  d.tether.conductor = random.chance(0.5) ? Conductor{0.0278e-6, 0.00403, 2700}
                                          : Conductor{0.0178e-6, 0.00393, 8900};
  if (random.chance(0.3)) d.tether.conductor_temperature_C = random.uniform(-20, 90);
  if (random.chance(0.3)) d.tether.spooled_length = random.uniform(0, 100);
  if (random.chance(0.3)) d.tether.contact_resistance = random.magnitude(0.001, 1);
  d.tether.insulation = {random.uniform(900, 2300),
                         random.chance(0.9) ? random.uniform(0.1e-3, 1.2e-3) : 0};
  d.supply.voltage = random.magnitude(15, 800);
  d.supply.converter = random_converter(random, d.supply.voltage);
  d.drone.motor_power_factor = random.chance(0.3) ? random.uniform(0.7, 1.4) : 1;
  if (random.chance(0.3)) {
    d.drone.translational_lift = {random.uniform(0, 0.5), random.uniform(3, 10)};
  }
  d.flight.airspeed = random.chance(0.9) ? random.uniform(0, 20) : 0;
  if (random.chance(0.3)) d.flight.headwind = random.uniform(-8, 12);
  d.flight.air_density = random.uniform(0.9, 1.4);
  d.requirements.thrust_headroom = random.uniform(1, 2.5);
  if (random.chance(0.5)) d.requirements.headroom_at = Condition::forward;
  if (random.chance(0.5)) d.requirements.power_at = Condition::hover;
  d.requirements.max_pitch = random.uniform(10, 60) * unit::degree;
  d.requirements.buffer_battery = random.chance(0.2);
  return d;
}

}  // namespace tethercalc::test
