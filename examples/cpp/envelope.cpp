// How high, how heavy, how fast and in how much wind a cable of 1.5 mm² flies.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/envelope.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  Design design = read_design(argv[1]).design;
  design.tether.cross_section = 1.5 * unit::square_millimetre;
  constexpr const char* names[] = {"height m", "payload kg", "headwind m/s", "airspeed m/s"};
  for (const ReachResult& reach : study_envelope(design).greatest) {
    if (!reach.end) return 1;
    std::printf("greatest %s: %.2f\n", names[static_cast<int>(reach.reach)], reach.end->value);
  }
}
