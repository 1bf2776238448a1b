#include "tethercalc/model/reserve_battery.hpp"

#include <algorithm>
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

namespace {

/// W of the battery, with the data-sheet power of one motor.
double battery_power(const Drone& drone, double motor_power) {
  return drone.motor_count * drone.motor_power_factor * motor_power + drone.auxiliary_power;
}

}  // namespace

double landing_power(const Drone& drone, double mass, double gravity) {
  return battery_power(drone, drone.motor.power(mass * gravity / drone.motor_count));
}

namespace {

/// W of the battery for one more kilogram, on one piece of the motor curve.
double power_per_kilogram(const Drone& drone, std::size_t piece, double gravity) {
  return drone.motor_power_factor * drone.motor.slope(piece) * gravity;
}

}  // namespace

double reserve_battery_mass(const Drone& drone, double mass, double height, double gravity) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, height);
  if (per_watt == 0) return 0;
  const auto vertices = drone.motor.vertices();
  // The mass carried is a line over the take-off mass on each piece of the motor curve. From the
  // drone without a battery upwards, the first piece that reaches `mass` holds the least solution.
  double lower = mass;
  // What is missing at `lower` is the battery for the power there, less the mass gained so far.
  const double thrust = mass * gravity / drone.motor_count;
  if (!(thrust < drone.motor.max_thrust())) return infinity;
  std::size_t i = drone.motor.piece(thrust);
  double missing =
      per_watt * battery_power(drone, vertices[i].power +
                                          drone.motor.slope(i) * (thrust - vertices[i].thrust));
  for (; i + 1 < vertices.size(); ++i) {
    const double rate = 1 - per_watt * power_per_kilogram(drone, i, gravity);
    const double upper = vertices[i + 1].thrust * drone.motor_count / gravity;
    if (missing <= rate * (upper - lower)) return lower + missing / rate - mass;
    missing -= rate * (upper - lower);
    lower = upper;
  }
  return infinity;
}

double reserve_battery_growth(const Drone& drone, double takeoff_mass, double height,
                              double gravity) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, height);
  if (per_watt == 0) return 0;
  const std::size_t piece = drone.motor.piece(takeoff_mass * gravity / drone.motor_count);
  const double more = per_watt * power_per_kilogram(drone, piece, gravity);
  return more < 1 ? more / (1 - more) : infinity;
}

double mass_without_battery(const Drone& drone, double takeoff_mass, double height,
                            double gravity) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, height);
  if (per_watt == 0) return takeoff_mass;
  // Where a piece is so steep that a heavier drone carries less, the most is at a vertex below.
  const double reachable =
      std::min(takeoff_mass, drone.motor.max_thrust() * drone.motor_count / gravity);
  double most = reachable - per_watt * landing_power(drone, reachable, gravity);
  for (const MotorPoint& vertex : drone.motor.vertices()) {
    const double at_vertex = vertex.thrust * drone.motor_count / gravity;
    if (at_vertex > reachable) break;
    most = std::max(most, at_vertex - per_watt * battery_power(drone, vertex.power));
  }
  return most;
}

}  // namespace tethercalc
