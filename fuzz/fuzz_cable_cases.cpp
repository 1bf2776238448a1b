// Whatever bytes a file of cables holds, it is refused with an InputError or every cable of it
// hangs to its drone, with finite forces that hold each other, or has a name for why not.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tethercalc/io/cable_cases.hpp"
#include "tethercalc/io/input_error.hpp"

namespace {

using namespace tethercalc;

void require(bool holds) {
  if (!holds) std::abort();
}

bool finite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void require_answer(const CableCase& c) {
  CableSolver solver;
  PaidOut paid_out;
  paid_out.length = c.length;
  if (solver.solve(c.cable, c.air, paid_out, c.drone) != CableOutcome::hangs) return;
  const HangingCable found = solver.result();
  require(finite(found.on_drone) && finite(found.on_station));
  const CableShape shape = solver.shape(10);
  const Vector3& end = shape.points.back().position;
  const double miss = std::hypot(end.x - c.drone.x, end.y - c.drone.y, end.z - c.drone.z);
  const double stretched = c.length + std::hypot(c.drone.x, c.drone.y, c.drone.z);
  require(miss <= 1e-3 * stretched);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const CableCase& c :
         parse_cable_cases({reinterpret_cast<const char*>(data), size}, "cases.json")) {
      require_answer(c);
    }
  } catch (const InputError& error) {
    require(!error.problems().empty());
  }
  return 0;
}
