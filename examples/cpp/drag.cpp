// Drag parameters learned from a flight log, with and without the linear term.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/drag.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const FlightLog log = read_flight_log(argv[1]).log;
  DragIdentificationOptions options;
  options.conditions.mass = 1.549;
  const DragStudy study = study_drag(argv[1], std::span(&log, 1), options);
  for (const FittedParameter& parameter : study.identified.fit.parameters) {
    std::printf("%s: %.4g [%.4g, %.4g]\n", parameter.name.c_str(), parameter.estimate.value,
                parameter.estimate.lower, parameter.estimate.upper);
  }
  std::printf("rmse %.3f m/s2", study.identified.fit.quality.rmse);
  if (study.without_linear) {
    std::printf(", without the linear term %.3f m/s2", study.without_linear->quality.rmse);
  }
  std::printf("\n");
}
