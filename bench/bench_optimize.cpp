// Time of one whole optimum: feasible set, minimum power, hover and forward flight.

#include <benchmark/benchmark.h>

#include <cmath>

#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace {

using namespace tethercalc;

/// A curve through P = c·T^1.4, cut into `points` pieces.
MotorCurve smooth_motor(int points) {
  std::vector<MotorPoint> curve;
  for (int i = 1; i <= points; ++i) {
    const double thrust = 13.0 * i / points;
    curve.push_back({thrust, 7.2 * std::pow(thrust, 1.4)});
  }
  return MotorCurve(curve);
}

/// Holybro AIR2216 920KV with a 10" propeller, thrust in gram-force against power in W.
MotorCurve data_sheet_motor() {
  const double grams[] = {210, 259, 309, 373,  447,  536,  628, 729,
                          814, 906, 993, 1087, 1191, 1289, 1332};
  const double grams_per_watt[] = {9.12, 8.67, 8.45, 8.15, 7.76, 7.39, 7.01, 6.73,
                                   6.44, 6.18, 5.88, 5.65, 5.43, 5.18, 5.13};
  std::vector<MotorPoint> curve;
  for (int i = 0; i < 15; ++i) {
    curve.push_back({grams[i] * unit::gram_force, grams[i] / grams_per_watt[i]});
  }
  return MotorCurve(curve);
}

/// The published drone.
Design published_design(MotorCurve motor) {
  Design d;
  d.drone.mass = 1.710;
  d.drone.motor_count = 4;
  d.drone.motor = std::move(motor);
  d.drone.auxiliary_power = 15;
  d.drone.drag = {0.01451, 0.01361, 19.27, 0};
  d.tether.length = 30;
  d.tether.conductor.resistivity_20C = 0.0278e-6;
  d.tether.conductor.temperature_coefficient = 0.00403;
  d.tether.conductor.density = 2700;
  d.tether.insulation.density = 1360;
  d.tether.insulation.thickness = 0.75e-3;
  d.supply.voltage = 75;
  d.supply.converter.efficiency = {{0, 0.9}};
  d.supply.converter.min_input_voltage = 20;
  d.flight.airspeed = 30 / 3.6;
  return d;
}

void optimize_varied(benchmark::State& state, Design design) {
  // Vary the design a little every time, so that no branch predictor learns it by heart.
  int i = 0;
  for (auto _ : state) {
    design.drone.mass = 1.5 + 0.001 * (i++ % 400);
    benchmark::DoNotOptimize(optimize(design));
  }
}

void whole_optimum(benchmark::State& state) {
  optimize_varied(state, published_design(data_sheet_motor()));
}
BENCHMARK(whole_optimum);

void whole_optimum_by_curve_points(benchmark::State& state) {
  optimize_varied(state, published_design(smooth_motor(static_cast<int>(state.range(0)))));
}
BENCHMARK(whole_optimum_by_curve_points)->RangeMultiplier(8)->Range(8, 1 << 15);

// --- Demands, each alone and all together, as sweeps ask for the optimum ---

void none(Design&) {}

void heat(Design& d) {  // in the air and on the drum
  d.tether.ambient_temperature_C = 35;
  d.tether.insulation.rated_temperature_C = 90;
  d.tether.spooled_length = 20;
  d.tether.drum.layers = 1;
  d.tether.sun = 1000;
}
void reserve_battery(Design& d) {
  d.drone.reserve_battery.specific_energy = 150 * 3600;
  d.drone.reserve_battery.discharge_rate = 30 / 3600.0;
}
void efficiency_curve(Design& d) {
  d.supply.converter.efficiency = {{50, 0.8}, {150, 0.9}, {400, 0.93}, {800, 0.92}};
}
void strength(Design& d) {
  d.tether.conductor.tensile_strength = 150e6;
  d.requirements.strength_safety_factor = 3;
}
void converter_rating(Design& d) {
  d.supply.converter.rated_output_power = 900;
  d.supply.converter.specific_mass = 0.1e-3;
}
void wall_by_voltage(Design& d) {
  d.tether.insulation.breakdown_strength = 20e6;
  d.tether.insulation.dielectric_safety_factor = 10;
}
void tilt_and_winch(Design& d) {
  d.requirements.max_pitch = 30 * unit::degree;
  d.tether.winch_pull = 1;
}
void everything(Design& d) {
  for (const auto demand : {heat, reserve_battery, efficiency_curve, strength, converter_rating,
                            wall_by_voltage, tilt_and_winch}) {
    demand(d);
  }
}
void too_much(Design& d) { d.requirements.thrust_headroom = 3; }  // for any cross-section
void everything_and_too_much(Design& d) {
  everything(d);
  too_much(d);
}

void optimum_with(benchmark::State& state, void (*demand)(Design&)) {
  Design design = published_design(data_sheet_motor());
  design.requirements.thrust_headroom = 1.5;
  demand(design);
  // Over voltage, length and mass, as in a sweep.
  int i = 0;
  for (auto _ : state) {
    design.supply.voltage = 70 + i % 11 * 6;
    design.tether.length = 10 + i / 11 % 11 * 3;
    design.drone.mass = 1.5 + i / 121 % 3 * 0.1;
    ++i;
    benchmark::DoNotOptimize(optimum_alone(design));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(optimum_with, none, none);
BENCHMARK_CAPTURE(optimum_with, heat, heat);
BENCHMARK_CAPTURE(optimum_with, reserve_battery, reserve_battery);
BENCHMARK_CAPTURE(optimum_with, efficiency_curve, efficiency_curve);
BENCHMARK_CAPTURE(optimum_with, strength, strength);
BENCHMARK_CAPTURE(optimum_with, converter_rating, converter_rating);
BENCHMARK_CAPTURE(optimum_with, wall_by_voltage, wall_by_voltage);
BENCHMARK_CAPTURE(optimum_with, tilt_and_winch, tilt_and_winch);
BENCHMARK_CAPTURE(optimum_with, everything, everything);
BENCHMARK_CAPTURE(optimum_with, too_much, too_much);
BENCHMARK_CAPTURE(optimum_with, everything_and_too_much, everything_and_too_much);

void feasible_set(benchmark::State& state) {
  const Design design = published_design(data_sheet_motor());
  const SteadyFlight flight(design, Condition::hover);
  for (auto _ : state) benchmark::DoNotOptimize(headroom_areas(flight, 2));
}
BENCHMARK(feasible_set);

void least_power(benchmark::State& state) {
  const Design design = published_design(data_sheet_motor());
  const SteadyFlight flight(design, Condition::forward);
  for (auto _ : state) benchmark::DoNotOptimize(minimum_power(flight));
}
BENCHMARK(least_power);

void one_operating_point(benchmark::State& state) {
  const Design design = published_design(data_sheet_motor());
  const SteadyFlight flight(design, Condition::forward);
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(flight, 1.0886e-6));
}
BENCHMARK(one_operating_point);

}  // namespace
