// Time of a drag fit with all its errors, for 3,400 samples: 340 s at 10 Hz.
//
// `bench/scipy_drag_fit.py` times SciPy's curve_fit on the same flight.
#include <benchmark/benchmark.h>

#include "../tests/support/flight_csv.hpp"
#include "tethercalc/identify/drag_fit.hpp"

namespace {

using namespace tethercalc;

constexpr DragFitConditions conditions{1.55, 1.225, standard_gravity};

/// Samples of the example flight from 60 s on.
Observations example_flight() {
  const FlightLog log = test::read_flight_csv(TETHERCALC_EXAMPLE_FLIGHT);
  const std::size_t first = range_in_seconds(log, 60, 1e9).first;
  return observe(log, {first, first + 3400}, 0.8 * unit::degree);
}

void fit_3400_samples(benchmark::State& state) {
  const Observations flight = example_flight();
  for (auto _ : state) benchmark::DoNotOptimize(fit_drag({&flight, 1}, conditions));
}
BENCHMARK(fit_3400_samples)->Unit(benchmark::kMicrosecond);

void observe_and_fit_3400_samples(benchmark::State& state) {
  const FlightLog log = test::read_flight_csv(TETHERCALC_EXAMPLE_FLIGHT);
  const std::size_t first = range_in_seconds(log, 60, 1e9).first;
  for (auto _ : state) {
    const Observations flight = observe(log, {first, first + 3400}, 0.8 * unit::degree);
    benchmark::DoNotOptimize(fit_drag({&flight, 1}, conditions));
  }
}
BENCHMARK(observe_and_fit_3400_samples)->Unit(benchmark::kMicrosecond);

}  // namespace
