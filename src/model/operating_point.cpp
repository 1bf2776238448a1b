#include "tethercalc/model/operating_point.hpp"

#include <cmath>
#include <limits>

#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

double or_nan(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

OperatingPoint evaluate(const SteadyFlight& flight, double area) {
  const Design& design = flight.design();
  const double radius = conductor_radius(area);
  const double tangent = or_nan(flight.tan_pitch(radius, flight.tan_pitch_limit()));

  OperatingPoint point;
  point.cross_section = area;
  point.tether_resistance = flight.resistance(radius);
  point.tether_mass = flight.tether_mass(radius);
  point.takeoff_mass = flight.takeoff_mass(radius);
  point.pitch = flight.pitch_sign() * std::atan(tangent);
  point.available_power = flight.available_power(point.tether_resistance);
  point.available_thrust = flight.available_thrust(point.available_power);
  point.necessary_thrust = flight.necessary_thrust(radius, tangent);
  point.headroom = point.available_thrust / point.necessary_thrust;
  point.drone_power = or_nan(flight.drone_power(point.necessary_thrust));
  point.total_power =
      supplied_power(design.supply.voltage, point.tether_resistance, point.drone_power);
  point.tether_loss = point.total_power - point.drone_power;
  point.current = point.total_power / design.supply.voltage;
  point.received_voltage = design.supply.voltage - point.current * point.tether_resistance;
  constexpr double rounding = 1e-12;
  point.flyable = point.headroom >= 1 - rounding;
  return point;
}

OperatingPoint evaluate(const Design& design, double area, Condition condition) {
  return evaluate(SteadyFlight(design, condition), area);
}

}  // namespace tethercalc
