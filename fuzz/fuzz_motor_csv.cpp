// Whatever bytes a test-bench CSV holds, it becomes a curve that rises, or problems.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/entry_readers.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tethercalc;
  const std::string text(reinterpret_cast<const char*>(data), size);
  Problems problems;
  const auto motor = motor_from_bench_csv(text, "bench.csv", problems);
  require(motor.has_value() == (problems.count() == 0));
  if (!motor) return 0;
  const auto vertices = motor->curve.vertices();
  require(vertices.size() >= 3);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    require(vertices[i].thrust > vertices[i - 1].thrust && std::isfinite(vertices[i].thrust));
    require(vertices[i].power > vertices[i - 1].power && std::isfinite(vertices[i].power));
  }
  return 0;
}
