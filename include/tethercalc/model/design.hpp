// A tethered drone as the physics sees it: SI units, every effect a parameter with a neutral value;
// and where, how fast and in what air it flies.
#pragma once

#include <numbers>
#include <optional>

#include "tethercalc/model/airframe.hpp"
#include "tethercalc/model/converter.hpp"
#include "tethercalc/model/hanging_cable.hpp"
#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/model/reserve_battery.hpp"
#include "tethercalc/model/tether.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// The two flight conditions a design is judged in. `hover` holds its place against the headwind;
/// `forward` flies at the design airspeed plus the headwind.
enum class Condition { hover, forward };

/// What flies, without its tether.
struct Drone {
  double mass = 0;      ///< kg, ready to fly, without tether
  int motor_count = 4;  ///< motors sharing the thrust equally
  MotorCurve motor;     ///< of one motor with its propeller
  /// kg/m³ of the air that the motor's curve was measured in; nothing: what the curve itself
  /// states.
  std::optional<double> motor_air_density{};
  double motor_power_factor = 1;  ///< motors draw this times what the curve says
  double auxiliary_power = 0;     ///< W at the converter input: flight controller and payload
  AirframeDrag drag;              ///< of the airframe, not of the tether
  TranslationalLift translational_lift;  ///< of the rotors
  ReserveBattery reserve_battery{};      ///< its mass comes to `mass`, and to the tether's
};

/// To be called where the mass of a drone was changed: a drag that is an estimate becomes that of
/// the mass (`drag_of_mass`), a measured one stays.
void renew_drag_estimate(Drone& drone);

inline constexpr double least_drone_mass = 0.01;    ///< kg: what is lighter is no drone
inline constexpr double least_tether_length = 0.1;  ///< m: what is shorter is no tether

/// What feeds the drone: the ground supply, and the converter at the tether's upper end.
struct Supply {
  double voltage = 0;   ///< V at the ground end of the tether
  Converter converter;  ///< from tether voltage to motor voltage
};

/// Where and how fast the drone flies.
struct Flight {
  double airspeed = 0;                ///< m/s in forward flight
  double headwind = 0;                ///< m/s, the wind, added to the airspeed in both conditions
  double air_density = 1.293;         ///< kg/m³
  double gravity = standard_gravity;  ///< m/s²

  /// m, ≥ 0, by which the drone stands aside of its station, upwind of it: of all sides the
  /// one that mostly takes the least power (`worst_side`). For a solved tether; a straight one
  /// hangs down from the drone.
  double horizontal_offset = 0;
  double station_height = 0;  ///< m of the tether's lower end over ground, ≥ 0

  WindProfile wind_profile = WindProfile::uniform;  ///< how the wind grows with height
  double wind_exponent = 1.0 / 7;                   ///< of the power law
  double roughness_length = 0.03;                   ///< m, of the logarithmic profile
  /// m over ground at which `headwind` blows; nothing: at the drone.
  std::optional<double> wind_reference_height{};

  bool operator==(const Flight&) const = default;  ///< member by member
};

/// What a cross-section must satisfy, and what is minimised among those that do.
struct Requirements {
  double thrust_headroom = 2;                ///< available over necessary thrust, at least
  Condition headroom_at = Condition::hover;  ///< where the headroom is demanded
  Condition power_at = Condition::forward;   ///< where the power is minimised
  double max_pitch = std::numbers::pi / 4;   ///< rad, in (0, π/2)
  bool buffer_battery =
      false;  ///< true: headroom is reported but not enforced (paper section III-A)
  double strength_safety_factor =
      0;  ///< breaking load over tension of the tether, at least; 0: not asked for
};

/// All that decides an operating point, but for the cross-section and the flight condition.
struct Design {
  Drone drone;                ///< what flies
  Tether tether;              ///< what it hangs on
  Supply supply;              ///< what feeds it
  Flight flight;              ///< where and how fast it flies
  Requirements requirements;  ///< what the optimum must satisfy
};

/// kg/m³ of the air that the motors' curve was measured in; nothing where nobody states it, and the
/// curve counts in any air.
[[nodiscard]] std::optional<double> bench_air_density(const Drone& drone);

/// The curve of one motor in the air that the design flies in: scaled from the air it was measured
/// in (see `MotorCurve::in_air`), where that is known.
[[nodiscard]] MotorCurve motor_in_flight(const Design& design);

/// The drone with that curve.
[[nodiscard]] Drone drone_in_flight(const Design& design);

/// What the density of the air would change of motors whose curve counts in any.
struct UnscaledMotors {
  double power_ratio = 1;   ///< of an ideal rotor's power for a thrust, over that of the curve
  double thrust_ratio = 1;  ///< of the greatest thrust
};

/// That, of a curve measured in `standard_air_density`, as `MotorCurve::in_air` has it. Nothing
/// where the air of the bench is stated, so that the curve is scaled, and where that of the flight
/// is within 3 % of the standard one.
[[nodiscard]] std::optional<UnscaledMotors> unscaled_motors(const Design& design);

/// Wind at the drone in m/s, `tether.length` over its station: `headwind`, or what the profile
/// makes of it from the reference height to there; none below the roughness length.
[[nodiscard]] double wind_at_drone(const Design& design);

/// Airspeed in m/s in `condition`.
[[nodiscard]] double airspeed(const Design& design, Condition condition);

/// The state of a flight at one moment. Together with a design it makes one operating point.
struct FlightState {
  double airspeed = 0;  ///< m/s through the air, forward positive
  /// m of cable in the air where it hangs straight: the height over the station. A solved tether
  /// reaches as high with what it takes.
  double deployed = 0;
  /// m of cable on the drum, in the circuit and not in the air, while `deployed` is out.
  double on_drum = 0;
  /// °C of the air around the tether. Heats nothing where the design asks for no heat balance.
  double ambient_temperature_C = 20;
  /// rad, clockwise seen from above, from where the air comes that it meets: 0 from where the drone
  /// stands aside of its station, so that it blows from there over the station. For a solved tether
  /// of one conductor (`ConductorsAsked::one`) in an operating point.
  double wind_from = 0;
  /// m/s of the airspeed that the drone flies itself: the profile of the wind shapes the rest only.
  double own_airspeed = 0;
};

/// The state in which a design is judged in `condition`: the whole `tether.length` in the air,
/// `tether.spooled_length` on the drum.
[[nodiscard]] FlightState flight_state(const Design& design, Condition condition);

/// The state at `height` m (≥ 0) and `airspeed` m/s, in air of `ambient_temperature_C` where that
/// was measured. A design with cable on the drum has all its cable at every height: what is not in
/// the air is on the drum. Without, its cable is as long as it flies high.
[[nodiscard]] FlightState flight_state_at(
    const Design& design, double height, double airspeed,
    std::optional<double> ambient_temperature_C = std::nullopt);

}  // namespace tethercalc
