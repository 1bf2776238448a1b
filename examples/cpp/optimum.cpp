// The published drone, built in memory and optimized: what a program that uses the library looks
// like. Numbers from Beffert and Zell (2025) and, for the motor, Holybro's AIR2216 data sheet.
#include <cstdio>
#include <tethercalc/solve/optimize.hpp>

using namespace tethercalc;

int main() {
  // Thrust in gram-force, efficiency in gram-force per watt.
  const double data_sheet[][2] = {{210, 9.12},  {259, 8.67},  {309, 8.45}, {373, 8.15},
                                  {447, 7.76},  {536, 7.39},  {628, 7.01}, {729, 6.73},
                                  {814, 6.44},  {906, 6.18},  {993, 5.88}, {1087, 5.65},
                                  {1191, 5.43}, {1289, 5.18}, {1332, 5.13}};
  std::vector<MotorPoint> points;
  for (const auto& [grams, grams_per_watt] : data_sheet) {
    points.push_back({.thrust = grams * unit::gram_force, .power = grams / grams_per_watt});
  }

  Design design;
  design.drone.mass = 1.710;
  design.drone.motor_count = 4;
  design.drone.motor = MotorCurve(points);
  design.drone.auxiliary_power = 15;
  design.drone.drag = {.front_area = 0.01451, .top_area = 0.01361, .linear_speed = 19.27};
  design.tether.length = 30;
  design.tether.conductor = {.resistivity_20C = 0.0278 * unit::ohm_square_millimetre_per_metre,
                             .density = 2700};
  design.tether.insulation = {.density = 1360, .thickness = 0.75 * unit::millimetre};
  design.supply = {.voltage = 75,
                   .converter = {.efficiency = {{.efficiency = 0.9}}, .min_input_voltage = 20}};
  design.flight.airspeed = 30 / 3.6;

  const Optimization optimum = optimize(design);
  std::printf("%.2f mm2, %.0f W hover, %.0f W forward\n", optimum.area / unit::square_millimetre,
              optimum.hover.total_power, optimum.forward.total_power);
}
