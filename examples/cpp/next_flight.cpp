// The flight that would settle what the diagnosis of another one leaves open.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/next_flight.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  DiagnosisQuestion question{read_design(argv[1]).design};
  question.flight = {.flights = {{read_flight_log(argv[2]).log}}};
  const DiagnosisStudy logged = study_diagnosis(question);
  const NextFlight plan = study_next_flight({question, *logged.flight});
  std::printf("%zu manoeuvres, %.1f minutes\n", plan.manoeuvres.size(), plan.duration / 60);
  for (const Decision& decision : plan.decides) {
    std::printf("settles: %s\n", decision.effect.c_str());
  }
  for (const Undecided& left : plan.undecided) {
    std::printf("leaves open: %s, %s\n", left.effect.c_str(), left.because.c_str());
  }
}
