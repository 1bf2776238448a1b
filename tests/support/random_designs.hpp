// Designs as odd as a user could write them.
#pragma once

#include <algorithm>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/model/design.hpp"
#include "tethercalc/model/drum_package.hpp"

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

/// The same that flies to stay where it is, on its cable as that hangs.
inline Design published_hanging_design() {
  Design d = published_design();
  d.tether.model = TetherModel::solved;
  d.flight.airspeed = 0;
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

/// A motor curve with steps of nearly no thrust, nearly no power, and plain ones, up to `most` N.
inline MotorCurve random_jagged_motor(Random& random, double most) {
  const int count = random.integer(2, 50);
  std::vector<double> thrusts;
  std::vector<double> powers;
  const double watts_per_newton = random.magnitude(2, 40);
  for (int i = 0; i < count; ++i) {
    thrusts.push_back(random.chance(0.2) ? 1e-3 : random.uniform(0.05, 1));
    powers.push_back(random.chance(0.2) ? 1e-6 : random.uniform(0.05, 1) * (1 + 2.0 * i / count));
  }
  double thrust_sum = 0;
  double power_sum = 0;
  for (int i = 0; i < count; ++i) {
    thrust_sum += thrusts[static_cast<std::size_t>(i)];
    power_sum += powers[static_cast<std::size_t>(i)];
  }
  std::vector<MotorPoint> points;
  MotorPoint last;
  for (std::size_t i = 0; i < thrusts.size(); ++i) {
    last.thrust += most * thrusts[i] / thrust_sum;
    last.power += most * watts_per_newton * powers[i] / power_sum;
    points.push_back(last);
  }
  return MotorCurve(points);
}

/// Anything that a spec may say: every field over about all of its range, zeros and extremes
/// included. Drone and motors match often enough for some half of them to fly.
inline Design random_extreme_design(Random& random) {
  const auto sometimes = [&](double probability, double lo, double hi, double otherwise) {
    return random.chance(probability) ? random.magnitude(lo, hi) : otherwise;
  };
  Design d;
  d.drone.mass = random.magnitude(0.01, 500);
  d.drone.motor_count = random.chance(0.2) ? 64 : random.integer(1, 8);
  d.flight.gravity = random.chance(0.8) ? standard_gravity : random.magnitude(0.1, 100);
  const double most = d.drone.mass * d.flight.gravity / d.drone.motor_count *
                      (random.chance(0.9) ? random.uniform(1.05, 8) : random.uniform(0.5, 40));
  if (random.chance(0.5)) {
    d.drone.motor = random_jagged_motor(random, most);
  } else {
    const MotorCurve motor = random_motor(random, random.chance(0.5) ? 0 : 0.9);
    std::vector<MotorPoint> points(motor.vertices().begin() + 1, motor.vertices().end());
    const double scale = most / motor.max_thrust();
    for (MotorPoint& point : points) point = {point.thrust * scale, point.power * scale};
    d.drone.motor = MotorCurve(points);
  }
  const double all_power = d.drone.motor.max_power() * d.drone.motor_count;
  d.drone.motor_power_factor = sometimes(0.3, 0.5, 2, 1);
  d.drone.auxiliary_power = random.chance(0.5) ? all_power * random.magnitude(1e-4, 0.3) : 0;
  const double size = std::pow(d.drone.mass, 2.0 / 3);
  d.drone.drag = {size * sometimes(0.7, 1e-4, 0.3, 0), size * sometimes(0.7, 1e-4, 0.3, 0),
                  sometimes(0.5, 0.1, 100, 0),
                  random.chance(0.2) ? random.uniform(-0.99, 0.99) : 0};
  if (random.chance(0.2)) {
    d.drone.translational_lift = {random.uniform(0, 0.95), random.magnitude(0.5, 50)};
  }
  if (random.chance(0.25)) {
    d.drone.reserve_battery = {random.magnitude(10, 400) * 3600, random.uniform(0.2, 1),
                               random.magnitude(1, 200) / 3600, random.magnitude(0.2, 10)};
  }
  d.tether.length = random.magnitude(0.5, 1000);
  d.tether.spooled_length = sometimes(0.3, 0.1, 1000, 0);
  d.tether.conductor = {random.chance(0.8) ? 0.0278e-6 : random.magnitude(1e-9, 1e-6),
                        random.chance(0.8) ? 0.004 : 0, random.chance(0.8) ? 2700.0 : 8900.0,
                        random.chance(0.8) ? random.magnitude(1e7, 5e8) : 0};
  d.tether.conductor_temperature_C = random.chance(0.3) ? random.uniform(-50, 150) : 20;
  d.tether.insulation = {random.magnitude(10, 3000), sometimes(0.8, 1e-5, 3e-3, 0),
                         random.chance(0.5) ? random.magnitude(0.05, 1) : 0};
  if (random.chance(0.5)) d.tether.insulation.rated_temperature_C = random.uniform(40, 250);
  if (random.chance(0.3)) {
    d.tether.insulation.breakdown_strength = random.magnitude(1e6, 1e8);
    d.tether.insulation.dielectric_safety_factor = random.uniform(0, 20);
  }
  d.tether.drag_coefficient = random.chance(0.7) ? 1 : random.uniform(0, 10);
  d.tether.projection_factor = random.chance(0.7) ? 0.75 : random.chance(0.5) ? 0 : 1;
  if (random.chance(0.4)) {
    d.tether.ambient_temperature_C = random.uniform(-60, 60);
    if (random.chance(0.5)) d.tether.sun = random.uniform(0, 1500);
    if (random.chance(0.7)) d.tether.drum.layers = random.integer(1, 4);
  } else if (random.chance(0.1)) {
    d.tether.heating = {random.magnitude(0.01, 30), 200, random.uniform(0, 2)};
  }
  if (random.chance(0.3)) {
    d.tether.strength_member = {StrengthMaterial::aramid, random.magnitude(1e-9, 1e-5)};
  }
  if (random.chance(0.2)) {
    d.tether.winch_pull = d.drone.mass * d.flight.gravity * random.magnitude(1e-3, 0.5);
  }
  // About the voltage at which a millimetre squared carries what the drone needs, or any at all.
  const double handy = std::sqrt(all_power * d.tether.length * 0.05);
  d.supply.voltage = random.chance(0.7) ? std::clamp(handy * random.magnitude(0.1, 10), 1.0, 1e4)
                                        : random.magnitude(1, 1e4);
  if (random.chance(0.4)) {
    d.tether.contact_resistance =
        d.supply.voltage * d.supply.voltage / all_power * random.magnitude(1e-4, 0.5);
  }
  Converter& converter = d.supply.converter;
  converter = random_converter(random, d.supply.voltage);
  for (EfficiencyPoint& point : converter.efficiency) point.output_power *= all_power / 1000;
  if (random.chance(0.3)) {
    converter.rated_output_power = all_power * random.magnitude(0.05, 2);
    converter.specific_mass = d.drone.mass / all_power * random.magnitude(1e-3, 0.5);
  }
  if (random.chance(0.1)) converter.max_input_voltage = d.supply.voltage * random.uniform(0.9, 5);
  if (random.chance(0.1)) {
    converter.fixed_ratio = random.uniform(0.05, 1);
    converter.min_output_voltage = d.supply.voltage * *converter.fixed_ratio * random.uniform(0, 1);
  }
  d.flight.airspeed = random.chance(0.8) ? random.magnitude(0.5, 100) : 0;
  d.flight.headwind = random.chance(0.3) ? random.uniform(-30, 30) : 0;
  d.flight.air_density = random.chance(0.8) ? random.uniform(0.9, 1.4) : random.magnitude(0.01, 10);
  d.requirements.thrust_headroom = random.chance(0.3) ? 1 : random.uniform(1, 4);
  if (random.chance(0.5)) d.requirements.headroom_at = Condition::forward;
  if (random.chance(0.5)) d.requirements.power_at = Condition::hover;
  d.requirements.max_pitch =
      (random.chance(0.8) ? random.uniform(20, 80) : random.magnitude(0.1, 89.9)) * unit::degree;
  d.requirements.buffer_battery = random.chance(0.2);
  if (random.chance(0.3)) d.requirements.strength_safety_factor = random.magnitude(1, 50);
  return d;
}

/// The same, and what it leaves out: cables as long and as short as a spec takes them, covers,
/// strands and vibration, described drums, benches and losses.
inline Design random_whole_range_design(Random& random) {
  Design d = random_extreme_design(random);
  Tether& tether = d.tether;
  if (random.chance(0.2)) tether.length = random.magnitude(0.1, 1e4);
  if (random.chance(0.3)) tether.stranding_factor = random.uniform(1, 2);
  if (random.chance(0.3)) tether.cover_mass = random.magnitude(1e-5, 1);
  if (random.chance(0.3)) tether.cover_width = random.magnitude(1e-5, 0.1);
  if (random.chance(0.2)) tether.vibration_amplitude = random.uniform(0, 2);
  if (random.chance(0.3)) tether.inclination = random.uniform(0, 90) * unit::degree;
  if (random.chance(0.2)) tether.drum.derating = random.uniform(0.01, 1);
  if (random.chance(0.3)) {
    tether.drum.core_diameter = random.magnitude(1e-3, 10);
    const double wall = insulation_wall(tether.insulation, d.supply.voltage);
    tether.drum.width = wound_side(tether, 0, wall) + random.magnitude(1e-5, 1);
    if (random.chance(0.5)) tether.drum.package_conductivity = random.magnitude(0.01, 10);
  }
  if (random.chance(0.3)) d.drone.motor_air_density = random.magnitude(0.1, 10);
  if (random.chance(0.2)) {
    const double all_power = d.drone.motor.max_power() * d.drone.motor_count;
    d.supply.converter.losses = {all_power * random.magnitude(1e-3, 0.5),
                                 random.magnitude(1e-3, 0.5) / all_power};
  }
  return d;
}

/// An extreme design on a solved tether as drones have them, in air as it is, with a wind that may
/// grow with height.
inline Design random_hanging_design(Random& random) {
  Design d = random_extreme_design(random);
  d.tether.model = TetherModel::solved;
  d.tether.length = random.magnitude(5, 150);
  d.tether.slack = random.magnitude(5e-3, 0.2);
  d.tether.insulation.thickness = random.uniform(1e-4, 1e-3);
  d.tether.insulation.density = random.uniform(900, 2200);
  d.tether.drag_coefficient = random.uniform(0.7, 1.3);
  d.tether.projection_factor = 0.75;
  d.tether.drag_by_reynolds_number = random.chance(0.3);
  d.tether.vibration_amplitude = random.chance(0.3) ? random.uniform(0, 1) : 0;
  d.flight.gravity = standard_gravity;
  d.flight.air_density = random.uniform(0.9, 1.3);
  d.flight.airspeed = random.uniform(0, 20);
  d.flight.headwind = random.uniform(0, 12);
  if (random.chance(0.5)) d.flight.horizontal_offset = d.tether.length * random.uniform(0, 0.5);
  if (random.chance(0.5)) {
    d.flight.wind_profile = random.chance(0.5) ? WindProfile::power_law : WindProfile::logarithmic;
    if (random.chance(0.5)) d.flight.wind_reference_height = 10;
  }
  return d;
}

}  // namespace tethercalc::test
