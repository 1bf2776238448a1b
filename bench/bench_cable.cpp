// Cables as they hang: the closed form in still air, and in wind from nothing, from the last
// solution and with derivatives.
#include <benchmark/benchmark.h>

#include "tethercalc/model/hanging_cable.hpp"

namespace {

using namespace tethercalc;

const Cable cable{.weight = 0.1765, .diameter = 0.005, .drag_coefficient = 1.1};
const PaidOut paid_out{.length = 40, .winch_tension = {}};

MovingAir oblique_wind() {
  MovingAir air;
  air.wind = {7, 7, 0};
  return air;
}

void catenary_in_closed_form(benchmark::State& state) {
  double z = 30;
  for (auto _ : state) {
    z = z < 30.5 ? z + 1e-4 : 30;
    benchmark::DoNotOptimize(catenary(20, z, 40, 0.1765));
  }
}
BENCHMARK(catenary_in_closed_form);

void cable_in_wind_from_nothing(benchmark::State& state) {
  const MovingAir air = oblique_wind();
  double z = 30;
  for (auto _ : state) {
    z = z < 30.5 ? z + 1e-4 : 30;
    CableSolver solver;
    benchmark::DoNotOptimize(solver.solve(cable, air, paid_out, {20, 0, z}));
  }
}
BENCHMARK(cable_in_wind_from_nothing);

void cable_in_wind_from_the_last(benchmark::State& state) {
  const MovingAir air = oblique_wind();
  CableSolver solver;
  double z = 30;
  for (auto _ : state) {
    z = z < 30.5 ? z + 1e-4 : 30;
    benchmark::DoNotOptimize(solver.solve(cable, air, paid_out, {20, 0, z}));
  }
}
BENCHMARK(cable_in_wind_from_the_last);

void derivatives_of_its_force(benchmark::State& state) {
  CableSolver solver;
  solver.solve(cable, oblique_wind(), paid_out, {20, 0, 30});
  for (auto _ : state) benchmark::DoNotOptimize(solver.derivatives());
}
BENCHMARK(derivatives_of_its_force);

}  // namespace
