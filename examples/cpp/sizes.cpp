// The optimum of a spec, and the sizes next to it that can be bought.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/optimum.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const OptimumStudy study = study_optimum(read_design(argv[1]).design, wire_sizes());
  if (!study.result.feasible) return 1;
  std::printf("optimum: %.4f mm2\n", study.result.area / unit::square_millimetre);
  for (const SizePoints& size : study.sizes) {
    std::printf("%s: %.1f W forward, %s\n", size.name.c_str(), size.points.forward.total_power,
                size.points.worst.met() ? "will do" : "will not do");
  }
}
