#include "tethercalc/model/design.hpp"

#include <algorithm>

namespace tethercalc {
namespace {

/// What the spec says of the weather: without an ambient temperature the cable, at no current, is
/// as warm as the spec's conductor.
double usual_ambient(const Tether& tether) {
  return tether.ambient_temperature_C.value_or(tether.conductor_temperature_C);
}

}  // namespace

double airspeed(const Design& design, Condition condition) {
  const Flight& flight = design.flight;
  return condition == Condition::hover ? flight.headwind : flight.airspeed + flight.headwind;
}

FlightState flight_state(const Design& design, Condition condition) {
  const Tether& tether = design.tether;
  return {airspeed(design, condition), tether.length, tether.spooled_length, usual_ambient(tether)};
}

FlightState flight_state_at(const Design& design, double height, double airspeed,
                            std::optional<double> ambient_temperature_C) {
  const Tether& tether = design.tether;
  const double ambient = ambient_temperature_C.value_or(usual_ambient(tether));
  if (tether.spooled_length == 0) return {airspeed, height, 0, ambient};
  const double all = tether.length + tether.spooled_length;
  return {airspeed, height, std::max(0.0, all - height), ambient};
}

}  // namespace tethercalc
