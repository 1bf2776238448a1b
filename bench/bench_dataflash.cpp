// How fast the EKF columns come out of a DataFlash log held in memory.
//
// The log is the file named by the environment variable TETHERCALC_BENCH_LOG, or else one made up
// here with the mix of messages that a copter writes. bench/pymavlink_parse.py times the same on
// the same file; write the made-up log for it with TETHERCALC_BENCH_SAVE=file. `copy` is what
// memory itself does with the log, as a yardstick in the same run.
#include <benchmark/benchmark.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "../tests/support/dataflash_writer.hpp"
#include "files/input_files.hpp"
#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"

using namespace tethercalc;

namespace {

// Bytes from operator new that are in use, and the most there were. The benchmarks have one thread.
std::size_t in_use = 0;
std::size_t most_in_use = 0;

}  // namespace

// Seen inline, GCC 12 takes free for another allocator's.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  in_use += malloc_usable_size(memory);
  most_in_use = std::max(most_in_use, in_use);
  return memory;
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
  in_use -= malloc_usable_size(memory);
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace {

/// Ten minutes at 10 Hz of two EKF cores and 50 Hz of IMU, beside attitude, motors and GPS.
std::vector<std::byte> made_up_log() {
  test::DataFlashWriter log;
  log.define(test::xkf1_type, "XKF1", "QBccCfffffffccce",
             "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH");
  log.define(10, "IMU", "QBffffffIIfBBHH",
             "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz");
  log.define(11, "ATT", "QccccCCCCB",
             "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw,AEKF");
  log.define(12, "RCOU", "QHHHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8");
  log.define(13, "GPS", "QBBIHBcLLeffffB",
             "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U");
  const auto integer = [](double value) { return static_cast<std::int64_t>(std::lround(value)); };
  for (int tick = 0; tick < 600 * 50; ++tick) {
    const auto time = static_cast<std::uint64_t>(10'000'000 + tick * 20'000);
    const double t = tick * 0.02;
    const std::int64_t wave = integer(1000 * std::sin(t));
    log.add(10, {time, std::int64_t{0}, 0.01 * std::sin(t), 0.0, 0.0, 0.1, 0.2, -9.8,
                 std::int64_t{0}, std::int64_t{0}, 35.0, std::int64_t{1}, std::int64_t{1},
                 std::int64_t{8000}, std::int64_t{4000}});
    if (tick % 5 != 0) continue;
    for (std::int64_t core = 0; core < 2; ++core) {
      log.add(test::xkf1_type, {time, core, wave, -wave, std::int64_t{18000}, 5 * std::sin(t),
                                5 * std::cos(t), 0.1, 0.0, t, t, -30.0, wave, wave, wave, wave});
    }
    log.add(11, {time, wave, wave, wave, wave, std::int64_t{18000}, std::int64_t{18000},
                 std::int64_t{1}, std::int64_t{1}, std::int64_t{3}});
    log.add(12,
            {time, std::int64_t{1500}, std::int64_t{1500}, std::int64_t{1500}, std::int64_t{1500},
             std::int64_t{0}, std::int64_t{0}, std::int64_t{0}, std::int64_t{0}});
    log.add(13, {time, std::int64_t{0}, std::int64_t{3}, integer(t * 1000), std::int64_t{2200},
                 std::int64_t{12}, std::int64_t{80}, std::int64_t{480'000'000},
                 std::int64_t{110'000'000}, std::int64_t{50'000}, 5.0, 90.0, 0.1, 0.0,
                 std::int64_t{1}});
  }
  return log.bytes();
}

std::vector<std::byte> load() {
  if (const char* const path = std::getenv("TETHERCALC_BENCH_LOG")) {
    const MappedFile file(path);
    return {file.bytes().begin(), file.bytes().end()};
  }
  std::vector<std::byte> log = made_up_log();
  if (const char* const path = std::getenv("TETHERCALC_BENCH_SAVE")) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));
  }
  return log;
}

const std::vector<std::byte>& log_in_memory() {
  static const std::vector<std::byte> log = load();
  return log;
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(log_in_memory().size()));
}

void ekf_columns(benchmark::State& state) {
  const auto& log = log_in_memory();
  const std::vector<std::string> fields = {"TimeUS", "Roll", "Pitch", "Yaw", "VN", "VE", "VD"};
  const std::size_t before = in_use;
  most_in_use = in_use;
  std::size_t values = 0;
  for (auto _ : state) {
    const auto columns = extract_columns(log, "XKF1", fields, DataFlashInstance{"C", 0});
    benchmark::DoNotOptimize(columns.data());
    values = columns.size() * columns.front().size();
  }
  count_bytes(state);
  state.counters["column_bytes"] = static_cast<double>(values * sizeof(double));
  state.counters["most_bytes_in_use"] = static_cast<double>(most_in_use - before);
}
BENCHMARK(ekf_columns);

void copy(benchmark::State& state) {
  const auto& log = log_in_memory();
  std::vector<std::byte> target(log.size());
  for (auto _ : state) {
    std::memcpy(target.data(), log.data(), log.size());
    benchmark::DoNotOptimize(target.data());
    benchmark::ClobberMemory();
  }
  count_bytes(state);
}
BENCHMARK(copy);

void flight_log(benchmark::State& state) {
  const auto& log = log_in_memory();
  for (auto _ : state) benchmark::DoNotOptimize(parse_flight_log(log, "log"));
  count_bytes(state);
}
BENCHMARK(flight_log);

void scan(benchmark::State& state) {
  const auto& log = log_in_memory();
  for (auto _ : state) benchmark::DoNotOptimize(scan_dataflash(log));
  count_bytes(state);
}
BENCHMARK(scan);

void summary(benchmark::State& state) {
  const auto& log = log_in_memory();
  for (auto _ : state) benchmark::DoNotOptimize(summarize_log(AutopilotLog(log, "log")));
  count_bytes(state);
}
BENCHMARK(summary);

}  // namespace
