// The best motor of the library for a drone, each motor with its own best tether.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/optimum.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  for (const MotorOptimum& motor : compare_motors(read_design(argv[1]).design, library_motors())) {
    if (!motor.result.feasible) break;
    std::printf("%s: %.4f mm2, %.1f W forward\n", motor.motor.id.c_str(),
                motor.result.area / unit::square_millimetre, motor.result.forward.total_power);
  }
}
