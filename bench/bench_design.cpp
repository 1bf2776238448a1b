// Time of a whole design study: voltage, conductor, cross-section and nine motors at once.

#include <benchmark/benchmark.h>

#include <cmath>

#include "tethercalc/io/design_request.hpp"
#include "tethercalc/io/library.hpp"

namespace {

using namespace tethercalc;

void whole_design_study(benchmark::State& state) {
  const DesignFile file = parse_design(starting_spec(), "starting spec");
  const DesignRequest request{{"supply.voltage_V=40..400", "tether.cross_section_mm2=0.05..5",
                               "drone.motor=all", "tether.conductor=copper,aluminium"},
                              "total_power_W",
                              {"tether_mass_g<=600"},
                              "",
                              {},
                              1};
  for (auto _ : state) benchmark::DoNotOptimize(study_design(read_design_request(file, request)));
}
BENCHMARK(whole_design_study)->Unit(benchmark::kMillisecond);

}  // namespace
