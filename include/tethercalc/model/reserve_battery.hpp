// The battery on board that lands the drone when the tether fails.
#pragma once

namespace tethercalc {

struct Drone;

/// A reserve battery by what its cells can do; how large it is follows from the landing.
struct ReserveBattery {
  double specific_energy = 0;  ///< J/kg, of the whole pack; 0: there is no battery
  double usable_share = 0.8;   ///< in (0, 1], of its energy: a pack is not flown empty
  /// 1/s, the most power it gives over its energy. 10 per hour ("10C"), low for packs that are
  /// sold for drones.
  double discharge_rate = 10.0 / 3600;
  /// m/s, > 0. ArduCopter descends at 1.5 m/s unless told otherwise (parameter WPNAV_SPEED_DN).
  double descent_speed = 1.5;
};

/// Time in s that the landing from `height` m takes.
[[nodiscard]] double landing_time(const ReserveBattery& battery, double height);

/// Pack mass in kg for each W that the landing from `height` m takes: what its energy asks for, or
/// what its discharge rate does where that is more, as in landings of less than some minutes. 0
/// without a battery.
[[nodiscard]] double battery_mass_per_watt(const ReserveBattery& battery, double height);

/// Power in W of the motors and the auxiliaries that holds `mass` kg in still air, from the
/// battery: behind the converter, which is dead then. +infinity where the motors cannot.
[[nodiscard]] double landing_power(const Drone& drone, double mass, double gravity);

/// Mass in kg of the reserve battery that lands a drone of `mass` kg (all but the battery: drone,
/// converter, tether) from `height` m: the drone carries the whole tether down, and descending is
/// taken to need the power of hovering, which is a little more than it does. The battery carries
/// itself: its mass is the least m with m = battery_mass_per_watt·landing_power(mass + m), exactly.
/// 0 without a battery, +infinity where no battery can carry itself.
[[nodiscard]] double reserve_battery_mass(const Drone& drone, double mass, double height,
                                          double gravity);

/// How much more battery one more kilogram without it takes, kg/kg, at a take-off mass of
/// `takeoff_mass` kg; +infinity where a kilogram more of battery asks for another one.
[[nodiscard]] double reserve_battery_growth(const Drone& drone, double takeoff_mass, double height,
                                            double gravity);

/// The inverse of `mass + reserve_battery_mass(mass)`: the largest mass without battery in kg with
/// which the drone takes off at `takeoff_mass` kg or less. Not positive where the battery for its
/// auxiliaries alone is heavier.
[[nodiscard]] double mass_without_battery(const Drone& drone, double takeoff_mass, double height,
                                          double gravity);

}  // namespace tethercalc
