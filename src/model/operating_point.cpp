#include "tethercalc/model/operating_point.hpp"

#include <cmath>

#include "model/constants.hpp"
#include "model/tether_heat.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

double or_nan(double value) { return std::isfinite(value) ? value : nan; }

/// Optima may lie on a limit, and are beyond it by rounding then: this much more still counts.
constexpr double rounding = 1e-9;

/// The thrust, or the motors' last where it exceeds that by rounding only.
double within_reach(double thrust, const MotorCurve& motor) {
  const double most = motor.max_thrust();
  return thrust > most && thrust <= most * (1 + rounding) ? most : thrust;
}

/// Replaces the resistance by that of the steady state that the drone's power leads to.
void warm_up(const SteadyFlight& flight, double radius, OperatingPoint& point) {
  const TetherHeat heat(flight, radius);
  point.tether_resistance = heat.resistance({flight.state().ambient_temperature_C, std::nullopt});
  if (std::isnan(point.drone_power)) return;
  const TetherHeatState state = heat.carrying(point.drone_power);
  if (!state.steady) {
    // What rounding alone keeps the cold cable from carrying counts as carried by the headroom too.
    point.thermal_runaway = supplied_power(flight.design().supply.voltage, point.tether_resistance,
                                           point.drone_power * (1 - 10 * rounding)) > 0;
    return;
  }
  point.tether_resistance = state.resistance;
  point.conductor_temperature = state.temperatures.in_air;
  point.drum_temperature = state.temperatures.on_drum.value_or(nan);
}

}  // namespace

OperatingPoint evaluate(const SteadyFlight& flight, double area) {
  const Design& design = flight.design();
  const double radius = conductor_radius(area);
  const TetherLoad load = flight.tether().load(radius);

  OperatingPoint point;
  point.cross_section = area;
  point.tether_mass = or_nan(load.mass);
  point.tether_length = or_nan(load.length);
  point.tether_tension = or_nan(load.greatest_tension());
  point.tether_resistance = or_nan(flight.tether().resistance(radius));
  point.battery_mass = flight.battery_mass(radius);
  point.takeoff_mass = or_nan(flight.takeoff_mass(radius, point.battery_mass));
  const double weight = flight.lifted(radius, point.takeoff_mass);
  const double tangent =
      std::isnan(point.takeoff_mass)
          ? nan
          : or_nan(flight.tan_pitch(radius, weight, flight.tan_pitch_limit() * (1 + rounding)));
  point.pitch = flight.pitch_sign() * std::atan(tangent);
  point.necessary_thrust = flight.necessary_thrust(weight, tangent);
  // What is available does not end where the tilt does.
  const double leaning = std::isnan(tangent) && flight.share_changes()
                             ? flight.tan_pitch(radius, weight, infinity)
                             : tangent;
  const double share = flight.power_share(leaning).value;
  point.drone_power =
      or_nan(flight.drone_power(within_reach(point.necessary_thrust, flight.motor()), share));
  if (is_heated(design.tether)) warm_up(flight, radius, point);
  // A cable that runs away has no state in which anything is available.
  const bool exists = !point.thermal_runaway && !std::isinf(point.battery_mass);
  point.available_power = exists ? flight.available_power(point.tether_resistance) : nan;
  point.available_thrust = exists ? flight.available_thrust(point.available_power, share) : nan;
  point.headroom = point.available_thrust / point.necessary_thrust;
  point.total_power =
      exists ? supplied_power(design.supply.voltage, point.tether_resistance, point.drone_power)
             : nan;
  point.tether_loss = point.total_power - point.drone_power;
  point.current = point.total_power / design.supply.voltage;
  point.received_voltage = design.supply.voltage - point.current * point.tether_resistance;
  return point;
}

OperatingPoint evaluate(const Design& design, double area, Condition condition) {
  return evaluate(SteadyFlight(design, condition), area);
}

OperatingPoint evaluate(const Design& design, double area, const FlightState& state) {
  return evaluate(SteadyFlight(design, state), area);
}

double power_behind_converter(const Design& design, const OperatingPoint& point) {
  return converter_output_power(design.supply.converter,
                                point.drone_power - design.drone.auxiliary_power);
}

}  // namespace tethercalc
