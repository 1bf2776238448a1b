// Which further flight would settle what a diagnosis leaves open.
#pragma once

#include <optional>

#include "tethercalc/diagnose/next_flight.hpp"
#include "tethercalc/study/diagnosis.hpp"

namespace tethercalc {

/// What is asked: the logs that were diagnosed and what they came to, and what the further flight
/// keeps to where that is known better than by the logs.
struct NextFlightQuestion {
  DiagnosisQuestion logged;        ///< with a flight
  Diagnosis diagnosis;             ///< of that flight
  std::optional<double> height{};  ///< m over home, > 0; climbs go higher
  std::optional<double> reach{};   ///< m from home over ground, > 0
};

/// The answer. Throws std::invalid_argument where no flight was logged.
[[nodiscard]] NextFlight study_next_flight(const NextFlightQuestion& question);

}  // namespace tethercalc
