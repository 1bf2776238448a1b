// A motor on a test bench: what it needs for a thrust between two measured points.
#include <cstdio>
#include <tethercalc/model/motor_curve.hpp>
#include <tethercalc/model/units.hpp>

int main() {
  using namespace tethercalc;
  const MotorCurve motor({{.thrust = 400 * unit::gram_force, .power = 50},
                          {.thrust = 600 * unit::gram_force, .power = 90}});
  std::printf("%.6f W\n", motor.power(500 * unit::gram_force));
}
