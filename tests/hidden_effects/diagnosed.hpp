// Diagnoses of simulated flights by the design that flew them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hidden_effects/simulated_flight.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"

namespace tethercalc::truth {

/// What the drag fit knows of: the model of every test that says nothing else.
inline const std::vector<std::string> usual_base{"linear_drag", "wind"};

inline Design design_of(const HiddenFlight& hidden) {
  Design design;
  design.drone.mass = hidden.mass;
  design.flight.air_density = hidden.air_density;
  return design;
}

inline FlightDiagnosisOptions beside(std::vector<std::string> base) {
  FlightDiagnosisOptions options;
  options.base = std::move(base);
  return options;
}

inline Diagnosis diagnosed(const HiddenFlight& hidden, const FlightLog& log,
                           const std::vector<std::string>& base = usual_base) {
  return diagnose_flight(design_of(hidden), log, beside(base));
}

inline Diagnosis diagnosed(const HiddenFlight& hidden,
                           const std::vector<std::string>& base = usual_base) {
  return diagnosed(hidden, fly(hidden), base);
}

}  // namespace tethercalc::truth
