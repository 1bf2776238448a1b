// The optimum over voltages and lengths, without files or texts in between.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/sweep.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const Design base = read_design(argv[1]).design;
  const SweepSpace space({{"supply.voltage_V", DecimalRange{.first = 75, .step = 25, .count = 3},
                           [](Design& design, double volts) { design.supply.voltage = volts; }},
                          {"tether.length_m", std::vector<double>{30, 60},
                           [](Design& design, double metres) { design.tether.length = metres; }}});
  for (SweepCursor row(space, base); const double index : {0., 1., 2., 3., 4., 5.}) {
    row.move_to(static_cast<std::uint64_t>(index));
    const SweepOutcome outcome = sweep_outcome(row.design());
    std::printf("%3.0f V %2.0f m: ", row.values()[0], row.values()[1]);
    if (outcome.feasible) {
      std::printf("%.4f mm2, %.1f W\n", outcome.area() / unit::square_millimetre,
                  judged_power(outcome, row.design()));
    } else {
      std::printf("no cross-section will do\n");
    }
  }
}
