// Designs a second in a sweep: drawn and optimised, with and without being written as text.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "tethercalc/files/threads.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/sweep_axes.hpp"
#include "tethercalc/report/sweep_report.hpp"

namespace {

using namespace tethercalc;

constexpr std::uint64_t designs = 1 << 17;

struct Prepared {
  DesignFile base;
  SweepSpace space;
};

/// A voltage, length and mass sweep about the starting spec, most of it feasible.
Prepared enumerated() {
  DesignFile base = parse_design(starting_spec(), "starting spec");
  const std::vector<std::string> varied{"supply.voltage_V=70:130:0.5", "tether.length_m=10:40:0.5",
                                        "drone.mass_g=1400:1800:20"};
  SweepSpace space(read_axes(varied, base, AxisUse::enumerated));
  return {std::move(base), std::move(space)};
}

Prepared drawn(SampleMethod method) {
  DesignFile base = parse_design(starting_spec(), "starting spec");
  const std::vector<std::string> varied{"supply.voltage_V=100~5", "tether.length_m=10..40",
                                        "drone.mass_g=1600~50"};
  SweepSpace space(read_axes(varied, base, AxisUse::sampled), SamplePlan{designs, method, 1});
  return {std::move(base), std::move(space)};
}

void sweep(benchmark::State& state, const Prepared& prepared, RowFormat format, bool written) {
  const SweepRows rows(prepared.space.axes(), format);
  const RowWriter write = [&](std::string& text, const SweepRow& row) { rows.append(text, row); };
  SweepJob job{&prepared.space,
               &prepared.base.design,
               write,
               {0, designs},
               written ? 0 : designs,
               several_threads(static_cast<unsigned>(state.range(0)))};
  std::size_t bytes = 0;
  for (auto _ : state) {
    compute_sweep(job, [&](const SweepChunk& chunk) {
      bytes += chunk.text.size();
      return true;
    });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(designs));
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

/// Rates by the clock on the wall; beside them, the processor time of all threads.
void both_times(benchmark::internal::Benchmark* timed) {
  timed->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
}

void optimised_designs(benchmark::State& state) {
  sweep(state, enumerated(), RowFormat::csv, false);
}
BENCHMARK(optimised_designs)->Arg(1)->Arg(2)->Apply(both_times);

void rows_as_csv(benchmark::State& state) { sweep(state, enumerated(), RowFormat::csv, true); }
BENCHMARK(rows_as_csv)->Arg(1)->Arg(2)->Apply(both_times);

void rows_as_json_lines(benchmark::State& state) {
  sweep(state, enumerated(), RowFormat::json_lines, true);
}
BENCHMARK(rows_as_json_lines)->Arg(2)->Apply(both_times);

void sobol_draws(benchmark::State& state) {
  sweep(state, drawn(SampleMethod::sobol), RowFormat::csv, false);
}
BENCHMARK(sobol_draws)->Arg(2)->Apply(both_times);

void latin_hypercube_draws(benchmark::State& state) {
  sweep(state, drawn(SampleMethod::latin_hypercube), RowFormat::csv, false);
}
BENCHMARK(latin_hypercube_draws)->Arg(2)->Apply(both_times);

}  // namespace
