// What flight logs are held against.
#pragma once

#include "tethercalc/study/diagnosis.hpp"

namespace tethercalc {

/// The design as it flew: `logged` is a LoggedFlight or a LoggedPower.
template <typename Logged>
[[nodiscard]] Design as_flown(const Design& design, const Logged& logged) {
  Design flown = design;
  flown.drone.mass = logged.mass.value_or(design.drone.mass);
  flown.flight.air_density = logged.air_density.value_or(design.flight.air_density);
  return flown;
}

/// How the flight is looked at, hypotheses included. The question has a flight.
[[nodiscard]] FlightDiagnosisOptions flight_options(const DiagnosisQuestion& question);

}  // namespace tethercalc
