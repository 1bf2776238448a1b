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
