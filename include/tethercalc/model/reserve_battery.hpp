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

/// Whether that lasts so long that the pack's energy decides how large it is, not the power that it
/// gives.
[[nodiscard]] bool is_sized_by_energy(const ReserveBattery& battery, double height);

/// Pack mass in kg for each W that the landing from `height` m takes: what its energy asks for, or
/// what its discharge rate does where that is more, as in landings of less than some minutes. 0
/// without a battery.
[[nodiscard]] double battery_mass_per_watt(const ReserveBattery& battery, double height);

/// Power in W for which a battery of `mass` kg lands a drone from `height` m > 0: the inverse of
/// `battery_mass_per_watt`. Not without a battery.
[[nodiscard]] double landing_power(const ReserveBattery& battery, double mass, double height);

/// What a landing asks of the drone beside its mass. It holds its place against the wind as in
/// hover; neutral values are still air.
struct Landing {
  double height = 0;             ///< m to go down
  double gravity = 0;            ///< m/s²
  double area_force_factor = 0;  ///< N/m², `area_force_factor` of the airframe in the wind
  double tether_drag = 0;        ///< N of the whole tether in the wind
  double airspeed = 0;           ///< m/s of that wind, of either sign
};

/// N of one motor that holds `mass` kg in the wind of `landing`.
[[nodiscard]] double landing_thrust(const Drone& drone, double mass, const Landing& landing);

/// Mass in kg of the reserve battery that lands a drone of `mass` kg (all but the battery: drone,
/// converter, tether): the drone carries the whole tether down, its weight and its drag, and
/// descending is taken to need the power of hovering in that wind, which is a little more than it
/// does; the battery feeds motors and auxiliaries behind the converter, which is dead then. The
/// battery carries itself: its mass is the least m with m = battery_mass_per_watt·power(mass + m).
/// 0 without a battery, +infinity where no battery can carry itself.
[[nodiscard]] double reserve_battery_mass(const Drone& drone, double mass, const Landing& landing);

/// Mass in kg, all but the battery, of a drone whose battery takes it to `takeoff_mass` kg. The
/// inverse of `mass + reserve_battery_mass(mass)` where that reaches `takeoff_mass` without a leap.
/// NaN beyond `heaviest_landing`.
[[nodiscard]] double mass_beside_battery(const Drone& drone, double takeoff_mass,
                                         const Landing& landing);

/// Mass in kg of the heaviest drone that all its motors hold in the wind of `landing`.
[[nodiscard]] double heaviest_landing(const Drone& drone, const Landing& landing);

/// How much more battery more to hold takes.
struct BatteryGrowth {
  double by_mass = 0;  ///< kg for a kilogram more without it
  double by_drag = 0;  ///< kg for 1 N more drag of the tether
  double thrust = 0;   ///< N, of one motor as the battery lands the drone
};

/// At a take-off mass of `takeoff_mass` kg; +infinity where a kilogram more of battery asks for
/// another one.
[[nodiscard]] BatteryGrowth reserve_battery_growth(const Drone& drone, double takeoff_mass,
                                                   const Landing& landing);

/// In still air the inverse of `mass + reserve_battery_mass(mass)`: the largest mass without
/// battery in kg with which the drone takes off at `takeoff_mass` kg or less. Not positive where
/// the battery for its auxiliaries alone is heavier.
[[nodiscard]] double mass_without_battery(const Drone& drone, double takeoff_mass, double height,
                                          double gravity);

}  // namespace tethercalc
