#include "tethercalc/model/reserve_battery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

double landing_time(const ReserveBattery& battery, double height) {
  return height / battery.descent_speed;
}

double battery_mass_per_watt(const ReserveBattery& battery, double height) {
  if (battery.specific_energy == 0) return 0;
  const double seconds =
      std::max(landing_time(battery, height) / battery.usable_share, 1 / battery.discharge_rate);
  return seconds / battery.specific_energy;
}

double landing_power(const Drone& drone, double mass, double gravity) {
  return drone.motor_count * drone.motor_power_factor *
             drone.motor.power(mass * gravity / drone.motor_count) +
         drone.auxiliary_power;
}

double reserve_battery_mass(const Drone& drone, double mass, double height, double gravity) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, height);
  if (per_watt == 0) return 0;
  // From no battery upwards: power rises with mass, so that no step passes the least solution. Each
  // kilogram of battery asks for a small part of another one, and a dozen steps do; where it asks
  // for nearly another one, no drone would fly.
  double battery = 0;
  for (int step = 0; step < 200; ++step) {
    const double next = per_watt * landing_power(drone, mass + battery, gravity);
    if (!std::isfinite(next)) break;
    if (next - battery <= 1e-15 * next) return next;
    battery = next;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace tethercalc
