// How fast the columns of a flight come out of a ULog held in memory.
//
// The log is the file named by the environment variable TETHERCALC_BENCH_ULOG, or else one made up
// here with the mix of messages that a copter writes. `copy` is what memory itself does with the
// log, as a yardstick in the same run.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "../tests/support/ulog_writer.hpp"
#include "files/input_files.hpp"
#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/io/log_readers.hpp"

using namespace tethercalc;

namespace {

/// Ten minutes of attitude at 50 Hz, velocity at 10 Hz, and sensors and motors at 100 Hz.
std::vector<std::byte> made_up_log() {
  test::ULogWriter log;
  test::define_flight_topics(log);
  log.format(
      "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;"
      "int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;"
      "uint32_t accelerometer_integral_dt;");
  log.format("actuator_outputs:uint64_t timestamp;uint32_t noutputs;float[16] output;");
  log.subscribe(3, "sensor_combined");
  log.subscribe(4, "actuator_outputs");
  for (std::uint64_t tick = 0; tick < 600 * 100; ++tick) {
    const std::uint64_t time = 10'000'000 + tick * 10'000;
    const double t = 0.01 * static_cast<double>(tick);
    test::ULogContent sensors;
    sensors.put(time);
    for (int i = 0; i < 9; ++i) sensors.put(static_cast<float>(std::sin(t + i)));
    log.data(3, sensors);
    test::ULogContent outputs;
    outputs.put(time).put(std::uint32_t{4});
    for (int i = 0; i < 16; ++i) outputs.put(i < 4 ? 1500.0F : 0.0F);
    log.data(4, outputs);
    if (tick % 2 == 0) test::add_attitude(log, time, 1, 0.01 * std::sin(t), 0.1, 0);
    if (tick % 10 == 0) test::add_local_position(log, time, 5 * std::sin(t), 5 * std::cos(t), 0);
  }
  return log.bytes();
}

const std::vector<std::byte>& log_in_memory() {
  static const std::vector<std::byte> log = [] {
    if (const char* const path = std::getenv("TETHERCALC_BENCH_ULOG")) {
      const MappedFile file(path);
      return std::vector<std::byte>(file.bytes().begin(), file.bytes().end());
    }
    return made_up_log();
  }();
  return log;
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(log_in_memory().size()));
}

void velocity_columns(benchmark::State& state) {
  const AutopilotLog log(log_in_memory(), "log");
  const std::vector<std::string> fields = {"vx", "vy", "vz"};
  for (auto _ : state) {
    benchmark::DoNotOptimize(log.series("vehicle_local_position", fields, 0));
  }
  count_bytes(state);
}
BENCHMARK(velocity_columns);

void open(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(AutopilotLog(log_in_memory(), "log").contents().messages);
  count_bytes(state);
}
BENCHMARK(open);

void flight_log(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(parse_flight_log(log_in_memory(), "log"));
  count_bytes(state);
}
BENCHMARK(flight_log);

void copy(benchmark::State& state) {
  std::vector<std::byte> target(log_in_memory().size());
  for (auto _ : state) {
    std::memcpy(target.data(), log_in_memory().data(), target.size());
    benchmark::DoNotOptimize(target.data());
    benchmark::ClobberMemory();
  }
  count_bytes(state);
}
BENCHMARK(copy);

}  // namespace
