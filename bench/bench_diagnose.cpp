// Time of one diagnosis of a flight of 5,500 samples, the search over the whole catalogue included.
#include <benchmark/benchmark.h>

#include "hidden_effects/simulated_flight.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"

namespace {

using namespace tethercalc;

void diagnose(benchmark::State& state, const truth::HiddenFlight& hidden,
              const std::vector<std::string>& base) {
  const FlightLog log = truth::fly(hidden);
  Design design;
  design.drone.mass = hidden.mass;
  design.flight.air_density = hidden.air_density;
  FlightDiagnosisOptions options;
  options.base = base;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose_flight(design, log, options));
}

truth::HiddenFlight flight() {
  truth::HiddenFlight hidden;
  hidden.duration = 550;
  return hidden;
}

void nothing_hidden(benchmark::State& state) { diagnose(state, flight(), {"linear_drag", "wind"}); }

void three_effects_and_empty_base(benchmark::State& state) {
  truth::HiddenFlight hidden = flight();
  hidden.propwash = 0.5;
  diagnose(state, hidden, {});
}

BENCHMARK(nothing_hidden)->Unit(benchmark::kMillisecond);
BENCHMARK(three_effects_and_empty_base)->Unit(benchmark::kMillisecond);

}  // namespace
