// A tethered drone as the physics sees it: SI units, every effect a parameter with a neutral value.
#pragma once

#include <numbers>

#include "tethercalc/model/airframe.hpp"
#include "tethercalc/model/converter.hpp"
#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/model/tether.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// The two flight conditions a design is judged in. `hover` holds its place against the headwind;
/// `forward` flies at the design airspeed plus the headwind.
enum class Condition { hover, forward };

struct Drone {
  double mass = 0;  ///< kg, ready to fly, without tether
  int motor_count = 4;
  MotorCurve motor;
  double motor_power_factor = 1;  ///< motors draw this times what the curve says
  double auxiliary_power = 0;     ///< W at the converter input: flight controller and payload
  AirframeDrag drag;
};

struct Supply {
  double voltage = 0;  ///< V at the ground end of the tether
  Converter converter;
};

struct Flight {
  double airspeed = 0;                ///< m/s in forward flight
  double headwind = 0;                ///< m/s, added to the airspeed in both conditions
  double air_density = 1.293;         ///< kg/m³
  double gravity = standard_gravity;  ///< m/s²
};

struct Requirements {
  double thrust_headroom = 2;  ///< available over necessary thrust, at least
  Condition headroom_at = Condition::hover;
  Condition power_at = Condition::forward;  ///< where the power is minimised
  double max_pitch = std::numbers::pi / 4;  ///< rad, in (0, π/2)
  bool buffer_battery =
      false;  ///< true: headroom is reported but not enforced (paper section III-A)
};

struct Design {
  Drone drone;
  Tether tether;
  Supply supply;
  Flight flight;
  Requirements requirements;
};

/// Airspeed in m/s in `condition`.
[[nodiscard]] double airspeed(const Design& design, Condition condition);

}  // namespace tethercalc
