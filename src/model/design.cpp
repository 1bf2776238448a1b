#include "tethercalc/model/design.hpp"

#include <algorithm>
#include <cmath>

namespace tethercalc {

void renew_drag_estimate(Drone& drone) {
  if (drone.drag.is_estimate) drone.drag = drag_of_mass(drone.mass);
}

namespace {

/// What the spec says of the weather: without an ambient temperature the cable, at no current, is
/// as warm as the spec's conductor.
double usual_ambient(const Tether& tether) {
  return tether.ambient_temperature_C.value_or(tether.conductor_temperature_C);
}

}  // namespace

std::optional<double> bench_air_density(const Drone& drone) {
  return drone.motor_air_density ? drone.motor_air_density : drone.motor.measured_in();
}

MotorCurve motor_in_flight(const Design& design) {
  const std::optional<double> measured = bench_air_density(design.drone);
  if (!measured || *measured == design.flight.air_density) return design.drone.motor;
  return design.drone.motor.in_air(design.flight.air_density / *measured);
}

Drone drone_in_flight(const Design& design) {
  Drone drone = design.drone;
  drone.motor = motor_in_flight(design);
  if (bench_air_density(drone)) drone.motor_air_density = design.flight.air_density;
  return drone;
}

std::optional<UnscaledMotors> unscaled_motors(const Design& design) {
  constexpr double noticeable = 0.03;
  const double ratio = design.flight.air_density / standard_air_density;
  if (bench_air_density(design.drone) || std::abs(ratio - 1) <= noticeable) return std::nullopt;
  return UnscaledMotors{ideal_power_in_air(ratio), ratio};
}

double wind_at_drone(const Design& design) {
  const Flight& flight = design.flight;
  if (flight.headwind == 0) return 0;
  MovingAir air;
  air.profile = flight.wind_profile;
  air.station_height = flight.station_height;
  air.reference_height =
      flight.wind_reference_height.value_or(flight.station_height + design.tether.length);
  air.exponent = flight.wind_exponent;
  air.roughness_length = flight.roughness_length;
  return flight.headwind * wind_share(air, design.tether.length);
}

double airspeed(const Design& design, Condition condition) {
  const double wind = wind_at_drone(design);
  return condition == Condition::hover ? wind : design.flight.airspeed + wind;
}

FlightState flight_state(const Design& design, Condition condition) {
  const Tether& tether = design.tether;
  FlightState state{airspeed(design, condition), tether.length, tether.spooled_length,
                    usual_ambient(tether)};
  if (condition == Condition::forward) state.own_airspeed = design.flight.airspeed;
  return state;
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
