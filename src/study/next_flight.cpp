#include "tethercalc/study/next_flight.hpp"

#include <algorithm>
#include <stdexcept>

#include "study/as_flown.hpp"

namespace tethercalc {

NextFlight study_next_flight(const NextFlightQuestion& question) {
  if (!question.logged.flight) throw std::invalid_argument("there is no flight to follow up");
  const LoggedFlight& flight = *question.logged.flight;
  const Design design = as_flown(question.logged.design, flight);
  FlightLimits limits = flown_limits(design, flight.flights);
  if (question.height) {
    limits.ceiling += *question.height - limits.height;
    limits.height = *question.height;
  }
  limits.reach = question.reach.value_or(limits.reach);
  return plan_next_flight(design, flight.flights, flight_options(question.logged),
                          question.diagnosis, limits);
}

}  // namespace tethercalc
