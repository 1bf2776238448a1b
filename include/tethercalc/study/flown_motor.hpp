// What a motor draws for its thrust, learned from the drone's own flight without tether.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>

#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// A flight from which no motor can be learned; says why.
class UnsuitablePowerFlight : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Forward flight beside what the hover says of it.
struct FlownForward {
  std::size_t rows = 0;  ///< of the flight
  double airspeed = 0;   ///< m/s, mean
  double ratio = 0;      ///< mean measured power over that of the curve for the thrust flown
};

/// A motor learned from a flight.
struct FlownMotor {
  MotorCurve curve;           ///< of one motor, in the air flown in
  double hover_thrust = 0;    ///< N, of one motor
  double hover_power = 0;     ///< W, of one motor
  double hover_seconds = 0;   ///< s, of stretches of 5 s or more flown below 2 m/s
  double hover_interval = 0;  ///< 95 % interval of that power, ± this share
  double band = 0;            ///< share by which the curve may be off anywhere, see `flown_motor`
  std::optional<FlownForward> forward;  ///< where the flight has enough of it
};

/// The motor of `design` (its drone's mass, number of motors, drag and auxiliary power, and the
/// flight's air density and gravity count), from a free flight's power at the bus and airspeed. The
/// battery feeds the auxiliaries as well; their power is taken off first, all else is the motors'.
/// A hover tells one point of the curve, at the weight; the rest follows momentum theory, P =
/// k·T^1.5 with k from there, up to `max_thrust` (N). The hover is what is flown below 2 m/s for 5
/// s or more at a time; its power's interval is that of the means of ten stretches of it, since
/// neighbouring rows resemble each other. The band adds, as squares, by how much measured motors
/// (`measured`) leave such a curve through their middle point, at 95 % of their points. Forward
/// flight, from 4 m/s on, is compared, not fitted: there the rotors need less power for a thrust
/// (`Drone::translational_lift`).
///
/// Throws UnsuitablePowerFlight for a log without power at the bus, less than 20 s or 50 rows of
/// hover, hover power that is not positive, and a greatest thrust below that of the hover;
/// std::invalid_argument for a flight on a tether (`check_flies_free`), whose cable was carried
/// too.
[[nodiscard]] FlownMotor flown_motor(const PowerLog& flight, const Design& design,
                                     double max_thrust, std::span<const MotorEntry> measured);

}  // namespace tethercalc
