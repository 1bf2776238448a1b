// The results that a recorded reference design is held to.
#include <cstdio>
#include <tethercalc/io/design_reader.hpp>
#include <tethercalc/study/reference.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const ReferenceResults results = reference_results(read_design(argv[1]).design);
  if (!results.outcome.feasible) return 1;
  std::printf("%.4f mm2, headroom %.2f at best, least power %.1f W\n",
              results.outcome.area() / unit::square_millimetre, results.best_headroom.value,
              results.minimum_power.power);
}
