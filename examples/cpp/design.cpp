// Voltage and conductor of least power for a tether of 600 g at most, and what a metre more costs.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/design.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  DesignQuestion question;
  question.problem.base = read_design(argv[1]).design;
  question.problem.free = {
      {"supply.voltage_V", Uniform{40, 120},
       [](Design& design, double volts) { design.supply.voltage = volts; }},
      {"tether.conductor", NamedChoices{{"copper", "aluminium"}}, [](Design& design, double which) {
         design.tether.conductor = find_conductor(which == 0 ? "copper" : "aluminium").conductor;
       }}};
  question.problem.limits = {
      {"tether mass", PointQuantity{&OperatingPoint::tether_mass, unit::gram}, 600, 1}};
  const DesignStudy study = study_design(question);
  if (!study.answer.feasible) return 1;
  std::printf("%.1f V, %s, %.4f mm2: %.1f W\n", study.answer.values[0],
              study.answer.values[1] == 0 ? "copper" : "aluminium",
              study.answer.best.area / unit::square_millimetre, study.answer.minimum.value);
  for (const ShadowPrice& price : study.prices) {
    if (price.name == "tether.length_m") std::printf("one metre more: %+.2f W\n", price.price);
  }
}
