#include "tethercalc/model/reserve_battery.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "model/constants.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

double landing_time(const ReserveBattery& battery, double height) {
  return height / battery.descent_speed;
}

bool is_sized_by_energy(const ReserveBattery& battery, double height) {
  return landing_time(battery, height) / battery.usable_share >= 1 / battery.discharge_rate;
}

double battery_mass_per_watt(const ReserveBattery& battery, double height) {
  if (battery.specific_energy == 0) return 0;
  const double seconds = is_sized_by_energy(battery, height)
                             ? landing_time(battery, height) / battery.usable_share
                             : 1 / battery.discharge_rate;
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

/// A drone of `mass` kg without the battery that lands it.
struct Lander {
  const Drone& drone;
  const Landing& landing;
  double mass = 0;
  double per_watt = 0;  ///< kg of battery
};

/// What it asks for with a take-off mass.
struct Ask {
  double takeoff = 0;  ///< kg
  double tan_pitch = 0;
  InclinedThrust thrust;  ///< of all motors
  double share = 1;       ///< of the motors' data-sheet power
  double missing = 0;     ///< kg of battery asked for beyond what there is
};

Ask ask_at(const Lander& lander, double takeoff) {
  const auto& [drone, landing, mass, per_watt] = lander;
  const ForceBalance balance = force_balance(drone, takeoff, landing);
  const double tangent = equilibrium_tan_pitch(balance, infinity);
  Ask ask{takeoff, tangent, inclined_thrust(balance, tangent, landing.gravity, 0)};
  ask.share = translational_lift_share(drone.translational_lift, landing.airspeed, tangent).value;
  const double per_motor = drone.motor.power(ask.thrust.value / drone.motor_count);
  ask.missing = per_watt * battery_power(drone, per_motor, ask.share) - (takeoff - mass);
  return ask;
}

/// Whether the thrust bends up over the mass from there on. With the drag A_f·cosθ + A_t·sinθ + F,
/// dT/dW is (A_f + F·cosθ)/(A_f·cosθ·(1 + sin²θ) + F + A_t·sin³θ), which grows while the drone
/// levels out where sin²θ ≤ 1/3. Nowhere does the thrust fall.
bool thrust_bends_up(const Ask& at) { return at.tan_pitch * at.tan_pitch <= 0.5; }

/// The take-off mass where nothing is missing at the earliest, were the motors to draw `share` of
/// their data-sheet power on `piece` of their curve.
double earliest_takeoff(const Lander& lander, const Ask& at, std::size_t piece, double share) {
  const auto& [drone, landing, mass, per_watt] = lander;
  const MotorPoint& start = drone.motor.vertices()[piece];
  const double beyond = at.thrust.value / drone.motor_count - start.thrust;
  const double power = start.power + drone.motor.slope(piece) * beyond;
  const double missing = per_watt * battery_power(drone, power, share) - (at.takeoff - mass);
  if (!(missing > 0)) return at.takeoff;
  const double slope = thrust_bends_up(at) ? at.thrust.slope : 0;
  const double rate = 1 - per_watt * power_per_newton(drone, piece, share) * slope;
  return rate > 0 ? at.takeoff + missing / rate : infinity;
}

/// Whether from `at` to `end`, on `piece` of the motors' curve, a heavier drone is sure to ask for
/// less battery more than it is heavier.
bool lags_behind(const Lander& lander, const Ask& at, const Ask& end, std::size_t piece) {
  return thrust_bends_up(at) &&
         lander.per_watt * power_per_newton(lander.drone, piece, at.share) * end.thrust.slope < 1;
}

/// The take-off mass between two at which nothing is missing any more.
template <typename AskAt>
double takeoff_between(const Ask& at, const Ask& end, const AskAt& ask) {
  const boost::math::tools::eps_tolerance<double> to_the_last_digit;
  std::uintmax_t steps = 100;
  return boost::math::tools::toms748_solve([&](double takeoff) { return ask(takeoff).missing; },
                                           at.takeoff, end.takeoff, at.missing, end.missing,
                                           to_the_last_digit, steps)
      .second;
}

}  // namespace

double reserve_battery_mass(const Drone& drone, double mass, const Landing& landing) {
  if (drone.reserve_battery.specific_energy == 0) return 0;
  const bool share_changes = drone.translational_lift.induced_share > 0 && landing.airspeed != 0;
  // From the drone without a battery upwards. The heavier the drone the less it leans and the
  // smaller the share of the motors' power, so that up to some take-off mass the battery is at
  // least what the share there asks for. What this rules out is passed over, the rest is looked at
  // in strides, down to where two roots are taken for none.
  constexpr double longest = 0.3;  // relative to the mass
  constexpr double shortest = 1e-3;
  double stride = longest;
  const Lander lander{drone, landing, mass,
                      battery_mass_per_watt(drone.reserve_battery, landing.height)};
  const auto ask = [&](double takeoff) { return ask_at(lander, takeoff); };
  const auto vertices = drone.motor.vertices();
  Ask at = ask(mass);
  for (std::size_t i = drone.motor.piece(at.thrust.value / drone.motor_count);
       i + 1 < vertices.size(); ++i) {
    const double upper = held_mass(drone, vertices[i + 1].thrust, landing);
    while (at.takeoff < upper) {
      if (!(at.missing > 0)) return at.takeoff - mass;
      if (!share_changes && thrust_bends_up(at)) {
        // Newton's method, which squares the error in every step, and is exact in still air.
        const double next = earliest_takeoff(lander, at, i, 1);
        const bool last = is_still(landing) || next - at.takeoff <= 1e-8 * next;
        if (last && next <= upper) return next - mass;
        at = ask(std::min(next, upper));
        continue;
      }
      const Ask end = ask(std::min(at.takeoff * (1 + stride), upper));
      const bool one_root =
          lags_behind(lander, at, end, i) || end.takeoff <= at.takeoff * (1 + shortest);
      if (one_root && !(end.missing > 0)) return takeoff_between(at, end, ask) - mass;
      const double from = earliest_takeoff(lander, at, i, end.share);
      if (one_root || !(from < end.takeoff)) {
        at = end;
        stride = std::min(longest, 4 * stride);
      } else {
        stride = (end.takeoff / at.takeoff - 1) / 4;
        at = ask(from);
      }
    }
  }
  return at.missing > 0 ? infinity : at.takeoff - mass;
}

double mass_beside_battery(const Drone& drone, double takeoff_mass, const Landing& landing) {
  const double per_watt = battery_mass_per_watt(drone.reserve_battery, landing.height);
  return -ask_at({drone, landing, 0, per_watt}, takeoff_mass).missing;
}

double heaviest_landing(const Drone& drone, const Landing& landing) {
  return held_mass(drone, drone.motor.max_thrust(), landing);
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
  const double thrust = by_mass.value / drone.motor_count;
  const std::size_t piece = drone.motor.piece(thrust);
  const PowerShare share =
      translational_lift_share(drone.translational_lift, landing.airspeed, tangent);
  const double price = per_watt * power_per_newton(drone, piece, share.value);
  double more = price * by_mass.slope;
  double more_by_drag = price * by_drag.slope;
  if (share.slope != 0) {
    const double power = drone.motor.power(thrust);
    const double by_share = per_watt * (battery_power(drone, power, 1) - drone.auxiliary_power);
    more += by_share * share.slope * by_mass.tan_slope;
    more_by_drag += by_share * share.slope * by_drag.tan_slope;
  }
  if (!(more < 1)) return {infinity, infinity, thrust};
  return {more / (1 - more), more_by_drag / (1 - more), thrust};
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
