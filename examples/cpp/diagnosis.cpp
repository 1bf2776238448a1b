// What a design gets wrong of a measured flight, and how its optimum moves once that is repaired.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/diagnosis.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  DiagnosisQuestion question{read_design(argv[1]).design};
  question.flight = {.flights = {{read_flight_log(argv[2]).log}}};
  const DiagnosisStudy study = study_diagnosis(question);
  for (const Finding& finding : study.flight->findings) {
    std::printf("found: %s, %.1f %% of the error\n", finding.title.c_str(), finding.gain_percent);
  }
  const BeforeAfter power = study.flight->design_impact->total_power_W;
  if (power.before && power.after) {
    std::printf("power at the optimum: %.1f W before, %.1f W after\n", *power.before, *power.after);
  }
}
