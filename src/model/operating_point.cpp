#include "tethercalc/model/operating_point.hpp"

#include <cmath>
#include <limits>

#include "tethercalc/model/conductor_heat.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

double or_nan(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

/// Optima may lie on a limit, and are beyond it by rounding then: this much more still counts.
constexpr double rounding = 1e-9;

/// The thrust, or the motors' last where it exceeds that by rounding only.
double within_reach(double thrust, const Design& design) {
  const double most = design.drone.motor.max_thrust();
  return thrust > most && thrust <= most * (1 + rounding) ? most : thrust;
}

/// What surrounds the tether in the air: the flight's air and wind.
Surroundings surroundings(const SteadyFlight& flight) {
  const Design& design = flight.design();
  Surroundings around;
  around.temperature_C = *design.tether.ambient_temperature_C;
  around.air_density = design.flight.air_density;
  around.wind = std::abs(flight.airspeed());
  around.sun = design.tether.sun;
  around.gravity = design.flight.gravity;
  return around;
}

/// Replaces the resistance by that of the steady state that the drone's power leads to.
void warm_up(const SteadyFlight& flight, double radius, OperatingPoint& point) {
  const Design& design = flight.design();
  const double ambient = *design.tether.ambient_temperature_C;
  const double cold = flight.resistance(radius, ambient);
  point.tether_resistance = cold;
  if (std::isnan(point.drone_power)) return;
  const double voltage = design.supply.voltage;
  const TetherHeatState state = steady_tether(design.tether, radius, flight.wall(), voltage,
                                              point.drone_power, surroundings(flight));
  if (!state.steady) {
    point.thermal_runaway = supplied_power(voltage, cold, point.drone_power) > 0;
    return;
  }
  point.tether_resistance = state.resistance;
  point.conductor_temperature = state.conductor_temperature_C;
  if (state.drum_temperature_C) point.drum_temperature = *state.drum_temperature_C;
}

/// Mass of what flies, but for the battery.
double mass_without_battery(const SteadyFlight& flight, double radius) {
  const Design& design = flight.design();
  return design.drone.mass + converter_mass(design.supply.converter) + flight.tether_mass(radius);
}

/// The operating point of a flight that carries a battery of `battery_mass`.
OperatingPoint evaluate_carrying(const SteadyFlight& flight, double area, double battery_mass) {
  const Design& design = flight.design();
  const double radius = conductor_radius(area);
  const double tangent =
      or_nan(flight.tan_pitch(radius, flight.tan_pitch_limit() * (1 + rounding)));

  OperatingPoint point;
  point.cross_section = area;
  point.tether_mass = flight.tether_mass(radius);
  point.takeoff_mass = mass_without_battery(flight, radius) + battery_mass;
  point.battery_mass = battery_mass;
  point.pitch = flight.pitch_sign() * std::atan(tangent);
  point.necessary_thrust = flight.necessary_thrust(radius, tangent);
  point.drone_power = or_nan(flight.drone_power(within_reach(point.necessary_thrust, design)));
  point.tether_tension =
      std::hypot(point.tether_mass * design.flight.gravity + design.tether.winch_pull,
                 flight.tether_drag(radius));
  point.tether_resistance = flight.resistance(radius);
  if (design.tether.ambient_temperature_C) warm_up(flight, radius, point);
  point.available_power = flight.available_power(point.tether_resistance);
  point.available_thrust = flight.available_thrust(point.available_power);
  point.headroom = point.available_thrust / point.necessary_thrust;
  point.total_power =
      point.thermal_runaway
          ? std::numeric_limits<double>::quiet_NaN()
          : supplied_power(design.supply.voltage, point.tether_resistance, point.drone_power);
  point.tether_loss = point.total_power - point.drone_power;
  point.current = point.total_power / design.supply.voltage;
  point.received_voltage = design.supply.voltage - point.current * point.tether_resistance;
  constexpr double edge_rounding = 1e-12;
  point.flyable = point.headroom >= 1 - edge_rounding && !point.thermal_runaway;
  return point;
}

/// A drone that no battery lands, since none can carry itself.
OperatingPoint beyond_any_battery(const SteadyFlight& flight, double area) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const double radius = conductor_radius(area);
  OperatingPoint point;
  point.cross_section = area;
  point.tether_mass = flight.tether_mass(radius);
  point.tether_resistance = flight.resistance(radius);
  point.battery_mass = std::numeric_limits<double>::infinity();
  for (double OperatingPoint::*quantity :
       {&OperatingPoint::takeoff_mass, &OperatingPoint::pitch, &OperatingPoint::available_power,
        &OperatingPoint::available_thrust, &OperatingPoint::necessary_thrust,
        &OperatingPoint::headroom, &OperatingPoint::drone_power, &OperatingPoint::total_power,
        &OperatingPoint::tether_loss, &OperatingPoint::current, &OperatingPoint::received_voltage,
        &OperatingPoint::tether_tension}) {
    point.*quantity = nan;
  }
  return point;
}

}  // namespace

OperatingPoint evaluate(const SteadyFlight& flight, double area) {
  const Design& design = flight.design();
  if (design.drone.reserve_battery.specific_energy == 0) return evaluate_carrying(flight, area, 0);
  const double battery =
      reserve_battery_mass(design.drone, mass_without_battery(flight, conductor_radius(area)),
                           design.tether.length, design.flight.gravity);
  return std::isfinite(battery) ? evaluate_carrying(flight.carrying(battery), area, battery)
                                : beyond_any_battery(flight, area);
}

OperatingPoint evaluate(const Design& design, double area, Condition condition) {
  return evaluate(SteadyFlight(design, condition), area);
}

}  // namespace tethercalc
