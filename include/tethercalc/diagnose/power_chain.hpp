// What the instruments of a power log should have read: the chain from the ground supply to the
// motors, stage by stage, each predicted from the measured quantities before it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// The cable's own I²R heat. Its temperature is ambient plus a rise that follows, with one time
/// constant, the balance of heat made and carried off:
/// rise_settled = rise_per_loss·I²R′/(1 + wind_cooling·√v), R′ the loop's resistance per metre at
/// 20 °C. Still-air cooling plus a part that grows with the square root of the airspeed is King's
/// law for a wire across the wind (King 1914, Phil. Trans. A 214:373).
struct ConductorHeating {
  double rise_per_loss = 0;    ///< K per W/m of loop, in still air, settled
  double time_constant = 200;  ///< s, > 0
  double wind_cooling = 0;     ///< (s/m)^½, ≥ 0
};

/// A converter by its losses: input = output + fixed + square·output². The fixed part drives the
/// switches, the square one heats the windings (Erickson and Maksimović, Fundamentals of Power
/// Electronics, 3rd ed., section 4.3).
struct ConverterLosses {
  double fixed = 0;   ///< W
  double square = 0;  ///< 1/W
};

/// A design as it flew, with what does not outlive the flight beside it. As constructed from a
/// design, nothing is added to it: the base model.
struct PowerModel {
  Design design;                                    ///< the design as the spec has it
  std::optional<ConductorHeating> heating;          ///< empty: conductor at the spec's temperature
  std::optional<ConverterLosses> converter_losses;  ///< empty: the spec's efficiency
  double supply_current_gain = 1;                   ///< the ground ammeter's reading over the truth
};

/// Loop resistance in Ω at every sample. The deployed length is the height. Where the spec has
/// cable on the drum (`tether.spooled_length` > 0) the whole cable, design length and spooled,
/// carries the current at every height: what is not in the air is on the drum. Where it has none,
/// the cable is as long as the height.
///
/// Needs `design.tether.cross_section`. Heating starts at rest and takes its current from the log,
/// the ambient temperature too, or the spec's conductor temperature where that was not measured.
[[nodiscard]] std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log);

/// Power in W at the converter's input, without auxiliaries, for W at its output, and the slope.
struct ConverterInput {
  double power = 0;  ///< W at the converter input
  double slope = 1;  ///< derivative by the output power
};
/// Input power of the converter for `output_power` in W, with its slope.
[[nodiscard]] ConverterInput converter_input(const PowerModel& model, double output_power);

/// Power in W at the bus in steady flight at every sample's height and airspeed. Above the motors'
/// largest thrust their curve is continued straight, and the design's limit of the tilt does not
/// count, so that the value stays finite: a log shows what was flown. NaN beyond a tilt of 80°.
[[nodiscard]] std::vector<double> motor_power(const PowerModel& model, const PowerLog& log);

/// The design that flies as `model` does, for everything in it that outlives the flight: the
/// converter's losses become efficiencies between `lowest_output` and `highest_output` (W, the
/// range seen in flight) and, for the sake of higher loads, up to twice that; the heat becomes the
/// conductor temperature that settles at `current` (A) and `airspeed` (m/s) over
/// `ambient_temperature_C`.
struct FlownRange {
  double lowest_output = 0;           ///< W, least converter output flown
  double highest_output = 0;          ///< W, most converter output flown
  double current = 0;                 ///< A, mean tether current
  double airspeed = 0;                ///< m/s, mean airspeed
  double ambient_temperature_C = 20;  ///< °C, mean
};
/// The design with every effect that outlives the flight in its field, at the conditions `flown`.
[[nodiscard]] Design lasting_design(const PowerModel& model, const FlownRange& flown);

}  // namespace tethercalc
