// What a design does with a given conductor in steady hover or forward flight.
#pragma once

#include <limits>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// Steady flight with one conductor cross-section. SI units; forces and thrusts per motor. NaN
/// marks a quantity that does not exist: everything that needs the tilt where the tilt exceeds its
/// limit, drone power where the motors cannot make the thrust, everything behind it where the line
/// cannot deliver the power.
struct OperatingPoint {
  double cross_section = 0;      ///< m², one conductor
  double tether_resistance = 0;  ///< Ω, loop
  double tether_mass = 0;        ///< kg, airborne
  double takeoff_mass = 0;       ///< kg, drone, converter, reserve battery and airborne tether
  double battery_mass = 0;       ///< kg, of the reserve battery; infinite where none suffices
  double pitch = 0;              ///< rad, positive leaning into the motion
  double available_power = 0;    ///< W at the converter input, at the lowest received voltage
  double available_thrust = 0;   ///< N per motor from that power
  double necessary_thrust = 0;   ///< N per motor
  double headroom = 0;           ///< available over necessary thrust
  double drone_power = 0;        ///< W at the converter input
  double total_power = 0;        ///< W from the ground supply
  double tether_loss = 0;        ///< W
  double current = 0;            ///< A
  double received_voltage = 0;   ///< V at the converter input

  /// N, the greatest along the tether: its weight, drag and winch pull. NaN where it cannot hang
  /// between station and drone.
  double tether_tension = 0;
  double tether_length = 0;  ///< m in the air; NaN likewise

  /// °C in the air and on the drum, where the tether has an ambient temperature; NaN otherwise, and
  /// where there is no steady state. On the drum NaN also where its cooling is not known; the
  /// resistance of that part is then taken at the temperature of the part in the air.
  double conductor_temperature = std::numeric_limits<double>::quiet_NaN();
  double drum_temperature = std::numeric_limits<double>::quiet_NaN();  ///< see above
  /// True where current and temperature drive each other up without end: the power could be
  /// delivered over the cold cable, and no steady state over the warm one exists. Nothing is
  /// available then, and the resistance is that of the cable at the temperature of the air.
  bool thermal_runaway = false;
};

/// The operating point for conductors of `area` m² (> 0, finite) in `condition`.
///
/// Paper section III-A with the neutral-valued parameters of `Design` in place:
/// T_nec = (m_d + m_t)g/(n cosθ); P_drone = converter(n·f·P_motor(T_nec)) + P_aux;
/// T_avail = motor(converter⁻¹(P_avail − P_aux)/(n·f)); U·I = P_drone + I²R.
/// The auxiliary power is drawn at the converter's input. Where the tether is heated, resistance,
/// current and conductor temperature agree with each other (see conductor_heat.hpp), and everything
/// that depends on the resistance with them.
[[nodiscard]] OperatingPoint evaluate(const Design& design, double area, Condition condition);

/// The same in any flight state.
[[nodiscard]] OperatingPoint evaluate(const Design& design, double area, const FlightState& state);

class SteadyFlight;

/// The same where many areas are evaluated in one flight.
[[nodiscard]] OperatingPoint evaluate(const SteadyFlight& flight, double area);

/// W that the converter gives the motors in `point`: what the drone takes, less its auxiliaries,
/// through the converter.
[[nodiscard]] double power_behind_converter(const Design& design, const OperatingPoint& point);

}  // namespace tethercalc
