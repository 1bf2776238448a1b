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

/// Cables as they hang, `design` as the starting spec has it but for what `change` does.
template <typename Change>
Prepared varied_with(const char* axis, const Change& change) {
  DesignFile base = parse_design(starting_spec(), "starting spec");
  change(base.design);
  const std::vector<std::string> varied{axis};
  SweepSpace space(read_axes(varied, base, AxisUse::enumerated));
  return {std::move(base), std::move(space)};
}

void hangs_with_slack(Design& design) {
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.03;
}

void hangs_from_winch(Design& design) {
  design.tether.model = TetherModel::solved;
  design.tether.winch_pull = 4;
}

/// With a drone that carries the cable in every wind of the sweep.
void hangs_from_firm_winch(Design& design) {
  design.tether.model = TetherModel::solved;
  design.tether.winch_pull = 8;
  design.drone.mass = 1.2;
  design.supply.voltage = 110;
  design.requirements.thrust_headroom = 1.5;
}

void hangs_straight(Design&) {}

void sweep(benchmark::State& state, const Prepared& prepared, RowFormat format, bool written,
           std::uint64_t rows_wanted = designs) {
  const SweepRows rows(prepared.space.axes(), format);
  const RowWriter write = [&](std::string& text, const SweepRow& row) { rows.append(text, row); };
  SweepJob job{&prepared.space,
               &prepared.base.design,
               write,
               {0, rows_wanted},
               written ? 0 : rows_wanted,
               several_threads(static_cast<unsigned>(state.range(0)))};
  std::size_t bytes = 0;
  for (auto _ : state) {
    compute_sweep(job, [&](const SweepChunk& chunk) {
      bytes += chunk.text.size();
      return true;
    });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rows_wanted));
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

/// The same rows of straight tethers, of cables with slack and of such on a winch, on one thread.
void straight_tether_over(benchmark::State& state, const char* axis, std::uint64_t rows) {
  sweep(state, varied_with(axis, hangs_straight), RowFormat::csv, false, rows);
}
void slack_tether_over(benchmark::State& state, const char* axis, std::uint64_t rows) {
  sweep(state, varied_with(axis, hangs_with_slack), RowFormat::csv, false, rows);
}
void winched_tether_over(benchmark::State& state, const char* axis, std::uint64_t rows) {
  sweep(state, varied_with(axis, hangs_from_winch), RowFormat::csv, false, rows);
}

void firmly_winched_tether_over(benchmark::State& state, const char* axis, std::uint64_t rows) {
  sweep(state, varied_with(axis, hangs_from_firm_winch), RowFormat::csv, false, rows);
}

/// Rates by processor time, which other work on the machine does not change.
void processor_time(benchmark::internal::Benchmark* timed) {
  timed->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

constexpr const char* masses = "drone.mass_g=1400:1800:0.02";
constexpr const char* voltages = "supply.voltage_V=75:130:0.0025";
constexpr const char* lengths = "tether.length_m=10:35:0.00125";
constexpr const char* headwinds = "flight.headwind_m_s=0:6:0.0003";
constexpr const char* light_winds = "flight.headwind_m_s=0:2:0.0001";
constexpr const char* slacks = "tether.slack_percent=1:10:0.00045";
constexpr const char* places = "flight.horizontal_offset_m=5:12:0.00035";
BENCHMARK_CAPTURE(straight_tether_over, mass, masses, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(straight_tether_over, voltage, voltages, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(straight_tether_over, length, lengths, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(straight_tether_over, headwind, headwinds, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, mass, masses, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, voltage, voltages, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, length, lengths, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, headwind, headwinds, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(winched_tether_over, mass, masses, 5000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(winched_tether_over, headwind, light_winds, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(firmly_winched_tether_over, headwind, headwinds, 20000)
    ->Arg(1)
    ->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, slack, slacks, 20000)->Arg(1)->Apply(processor_time);
BENCHMARK_CAPTURE(slack_tether_over, aside, places, 20000)->Arg(1)->Apply(processor_time);

}  // namespace
