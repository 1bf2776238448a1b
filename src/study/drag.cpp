#include "tethercalc/study/drag.hpp"

#include <utility>

namespace tethercalc {

DragStudy study_drag(std::string name, std::span<const FlightLog> logs,
                     const DragIdentificationOptions& options) {
  DragStudy study{std::move(name), identify_drag(logs, options), {}};
  DragFitOptions quadratic;
  quadratic.bounds.max_linear_speed = 1e-6;  // m/s, a millionth of the linear term that matters
  try {
    study.without_linear = fit_drag(study.identified.flights, options.conditions, quadratic);
  } catch (const UnsuitableFlight&) {
    // The comparison is left out; the fit itself stands.
  }
  return study;
}

}  // namespace tethercalc
