// What flight logs are held against.
#pragma once

#include "tethercalc/study/diagnosis.hpp"

namespace tethercalc {

/// The design as it flew.
[[nodiscard]] Design as_flown(const Design& design, const LoggedFlight& flight);

/// How the flight is looked at, hypotheses included. The question has a flight.
[[nodiscard]] FlightDiagnosisOptions flight_options(const DiagnosisQuestion& question);

}  // namespace tethercalc
