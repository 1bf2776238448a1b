// What a cable does in a design, and which demand it meets least.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/optimum.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const Design design = read_design(argv[1]).design;
  const double areas[] = {0.75e-6, 1e-6, 1.5e-6};
  for (const AreaPoints& cable : evaluate_areas(design, areas)) {
    std::printf("%.2f mm2: %.1f W in hover, headroom %.2f, %s\n", cable.area / 1e-6,
                cable.hover.total_power, cable.hover.headroom,
                cable.worst.met() ? "will do" : demand_name(cable.worst.demand).data());
  }
}
