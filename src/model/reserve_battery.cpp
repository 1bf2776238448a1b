#include "tethercalc/model/reserve_battery.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/constants.hpp"
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

double landing_power(const ReserveBattery& battery, double mass, double height) {
  return mass / battery_mass_per_watt(battery, height);
}

namespace {

ForceBalance force_balance(const Drone& drone, double mass, const Landing& landing) {
  return {mass * landing.gravity, landing.area_force_factor, landing.tether_drag,
          drone.drag.front_area, drone.drag.top_area};
}

/// Thrust of all motors, and how it grows with the mass, N/kg.
InclinedThrust all_thrust(const Drone& drone, double mass, const Landing& landing) {
  const ForceBalance balance = force_balance(drone, mass, landing);
  return inclined_thrust(balance, equilibrium_tan_pitch(balance, infinity), landing.gravity, 0);
}

/// kg that the drone holds with `thrust` N of one motor.
double held_mass(const Drone& drone, double thrust, const Landing& landing) {
  return weight_held(force_balance(drone, 0, landing), thrust * drone.motor_count) /
         landing.gravity;
}

/// W of the battery, with the data-sheet power of one motor.
double battery_power(const Drone& drone, double motor_power, double share) {
  return drone.motor_count * drone.motor_power_factor * share * motor_power + drone.auxiliary_power;
}

/// W of the battery for 1 N more of all motors together, on one piece of their curve.
double power_per_newton(const Drone& drone, std::size_t piece, double share) {
  return drone.motor_power_factor * share * drone.motor.slope(piece);
}

bool is_still(const Landing& landing) {
  return landing.area_force_factor == 0 && landing.tether_drag == 0;
}

}  // namespace

double landing_thrust(const Drone& drone, double mass, const Landing& landing) {
  return all_thrust(drone, mass, landing).value / drone.motor_count;
}

namespace {

/// The mass where the motors draw that share of their data-sheet power, however they lean.
double mass_at_share(const Drone& drone, double mass, const Landing& landing, double share) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, landing.height);
  const auto vertices = drone.motor.vertices();
  InclinedThrust all = all_thrust(drone, mass, landing);
  if (!(all.value / drone.motor_count < drone.motor.max_thrust())) return infinity;
  // From the drone without a battery upwards. Over the take-off mass the thrust bends up, so that
  // on a piece of the motor curve Newton's method does not step over the least solution, and goes
  // beyond the piece where that holds none. In still air its first step is exact.
  double takeoff = mass;
  for (std::size_t i = drone.motor.piece(all.value / drone.motor_count); i + 1 < vertices.size();
       ++i) {
    const double upper = held_mass(drone, vertices[i + 1].thrust, landing);
    const double price = per_watt * power_per_newton(drone, i, share);
    constexpr int most_steps = 100;
    for (int step = 0; step < most_steps; ++step) {
      const double thrust = all.value / drone.motor_count;
      const double power = vertices[i].power + drone.motor.slope(i) * (thrust - vertices[i].thrust);
      const double missing = per_watt * battery_power(drone, power, share) - (takeoff - mass);
      const double rate = 1 - price * all.slope;
      if (!(missing <= rate * (upper - takeoff))) break;
      const double gain = missing / rate;
      takeoff += gain;
      // Newton squares the error in every step.
      if (is_still(landing) || std::abs(gain) <= 1e-8 * takeoff) return takeoff - mass;
      all = all_thrust(drone, takeoff, landing);
    }
    takeoff = upper;
    all = all_thrust(drone, takeoff, landing);
  }
  return infinity;
}

PowerShare share_of(const Drone& drone, double mass, const Landing& landing) {
  const double tangent = equilibrium_tan_pitch(force_balance(drone, mass, landing), infinity);
  return translational_lift_share(drone.translational_lift, landing.airspeed, tangent);
}

}  // namespace

double reserve_battery_mass(const Drone& drone, double mass, const Landing& landing) {
  if (drone.reserve_battery.specific_energy == 0) return 0;
  if (drone.translational_lift.induced_share == 0 || landing.airspeed == 0) {
    return mass_at_share(drone, mass, landing, 1);
  }
  // The heavier the drone the less it leans, the smaller the share of the power and with it the
  // battery: what the share at a battery asks for falls as that grows, and meets it once.
  const auto asked = [&](double battery) {
    const double share = share_of(drone, mass + battery, landing).value;
    return mass_at_share(drone, mass, landing, share);
  };
  double low = 0;
  double high = held_mass(drone, drone.motor.max_thrust(), landing) - mass;
  double above = asked(low) - low;
  if (!(high > low) || !(asked(high) <= high)) return infinity;
  high = std::min(high, above);
  double below = asked(high) - high;
  // Secants in a bracket; where one end stays, half of its distance counts, so that both move.
  int stayed = 0;
  double battery = high;
  for (int step = 0; step < 200 && below < 0; ++step) {
    const double secant = (low * below - high * above) / (below - above);
    battery = secant > low && secant < high ? secant : 0.5 * (low + high);
    if (!(low < battery && battery < high)) break;
    const double here = asked(battery) - battery;
    if (std::abs(here) <= 1e-15 * (mass + battery)) break;
    if (here > 0) {
      stayed = std::max(stayed, 0) + 1;
      low = battery;
      above = here;
      if (stayed > 1) below *= 0.5;
    } else {
      stayed = std::min(stayed, 0) - 1;
      high = battery;
      below = here;
      if (stayed < -1) above *= 0.5;
    }
  }
  return battery;
}

BatteryGrowth reserve_battery_growth(const Drone& drone, double takeoff_mass,
                                     const Landing& landing) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, landing.height);
  if (per_watt == 0) return {};
  const ForceBalance balance = force_balance(drone, takeoff_mass, landing);
  const double tangent = equilibrium_tan_pitch(balance, infinity);
  const InclinedThrust by_mass = inclined_thrust(balance, tangent, landing.gravity, 0);
  const InclinedThrust by_drag =
      tangent == 0 ? InclinedThrust{} : inclined_thrust(balance, tangent, 0, 1);
  const std::size_t piece = drone.motor.piece(by_mass.value / drone.motor_count);
  const PowerShare share =
      translational_lift_share(drone.translational_lift, landing.airspeed, tangent);
  const double price = per_watt * power_per_newton(drone, piece, share.value);
  double more = price * by_mass.slope;
  double more_by_drag = price * by_drag.slope;
  if (share.slope != 0) {
    const double power = drone.motor.power(by_mass.value / drone.motor_count);
    const double by_share = per_watt * (battery_power(drone, power, 1) - drone.auxiliary_power);
    more += by_share * share.slope * by_mass.tan_slope;
    more_by_drag += by_share * share.slope * by_drag.tan_slope;
  }
  if (!(more < 1)) return {infinity, infinity};
  return {more / (1 - more), more_by_drag / (1 - more)};
}

double mass_without_battery(const Drone& drone, double takeoff_mass, double height,
                            double gravity) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, height);
  if (per_watt == 0) return takeoff_mass;
  // Where a piece is so steep that a heavier drone carries less, the most is at a vertex below.
  const double reachable =
      std::min(takeoff_mass, drone.motor.max_thrust() * drone.motor_count / gravity);
  const double thrust = reachable * gravity / drone.motor_count;
  double most = reachable - per_watt * battery_power(drone, drone.motor.power(thrust), 1);
  for (const MotorPoint& vertex : drone.motor.vertices()) {
    const double at_vertex = vertex.thrust * drone.motor_count / gravity;
    if (at_vertex > reachable) break;
    most = std::max(most, at_vertex - per_watt * battery_power(drone, vertex.power, 1));
  }
  return most;
}

}  // namespace tethercalc
