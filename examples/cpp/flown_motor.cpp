// A motor's curve learned from a flight without tether: a hover of two minutes at 310 W.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/io/library.hpp>
#include <tethercalc/study/flown_motor.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const Design design = read_design(argv[1]).design;
  PowerLog flight{.free_flight = true};
  for (int second = 0; second < 120; ++second) {
    flight.time.push_back(second);
    flight.airspeed.push_back(0.3);
    flight.bus_power.push_back(second % 2 == 0 ? 308 : 312);
  }
  const FlownMotor motor = flown_motor(flight, design, 13, library_motors());
  std::printf("hover: %.2f N and %.1f W a motor, ± %.1f %%; elsewhere ± %.0f %%\n",
              motor.hover_thrust, motor.hover_power, 100 * motor.hover_interval, 100 * motor.band);
}
