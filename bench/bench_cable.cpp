// Cables as they hang: the closed form in still air, and in wind from nothing, from the last
// solution and with derivatives. Where the environment variable TETHERCALC_BENCH_CABLES names a
// file of cases (docs/tether.md), each of these is timed, too; the counter is the median over them,
// and one that does not hang ends with an error.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "files/input_files.hpp"
#include "tethercalc/io/cable_cases.hpp"
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

std::vector<CableCase> cases() {
  const char* const file = std::getenv("TETHERCALC_BENCH_CABLES");
  return file == nullptr ? std::vector<CableCase>()
                         : parse_cable_cases(read_text_file(file).text, file);
}

/// µs a solution of this case; the drone moves by 0.1 mm each time.
double microseconds(const CableCase& asked, bool from_the_last, benchmark::State& state) {
  constexpr int repetitions = 200;
  CableSolver solver;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < repetitions; ++i) {
    if (!from_the_last) solver = CableSolver();
    Vector3 drone = asked.drone;
    drone.z -= 1e-4 * (i % 10);
    const PaidOut known{.length = asked.length, .winch_tension = {}};
    if (solver.solve(asked.cable, asked.air, known, drone) != CableOutcome::hangs) {
      state.SkipWithError((asked.id + " does not hang").c_str());
    }
  }
  const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
  return taken.count() / repetitions;
}

void median_of_cases(benchmark::State& state, bool from_the_last) {
  const std::vector<CableCase> asked = cases();
  if (asked.empty()) return state.SkipWithError("TETHERCALC_BENCH_CABLES names no file of cases");
  std::vector<double> each;
  for (auto _ : state) {
    each.clear();
    for (const CableCase& one : asked) each.push_back(microseconds(one, from_the_last, state));
  }
  if (each.empty()) return;
  std::nth_element(each.begin(), each.begin() + static_cast<long>(each.size() / 2), each.end());
  state.counters["median_us"] = each[each.size() / 2];
}
BENCHMARK_CAPTURE(median_of_cases, from_nothing, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(median_of_cases, from_the_last, true)->Unit(benchmark::kMillisecond);

}  // namespace
