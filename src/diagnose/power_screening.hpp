// A power log made fit for comparison: wrong units, instruments that hang, spikes and clocks that
// disagree are found and dealt with before any physics is judged.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/power_chain.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// The channels that a comparison is made of: for the tether the supply pair, drone voltage and
/// height; for the converter the supply current, drone voltage and the bus; for the motors the bus,
/// the airspeed and, on a tether, the height. The bus is its power where that was measured, else
/// its voltage and current.
[[nodiscard]] std::vector<std::vector<double> PowerLog::*> compared_channels(Stage stage,
                                                                             const PowerLog& log);

/// The names of the channels that comparisons at these stages are made of, in the order of
/// `power_channels`, where the bus's power was not measured itself.
[[nodiscard]] std::vector<std::string> channels_needed(const std::vector<Stage>& stages,
                                                       bool free_flight);

/// Whether the log has them all.
[[nodiscard]] bool is_measured(Stage stage, const PowerLog& log);

/// A log with its bad samples marked and filled in, all channels on the clock of the supply
/// current or, without one, of the bus.
struct ScreenedPowerLog {
  PowerLog log;  ///< marked samples are interpolated; an optional channel that hangs for more than
                 ///< half of the log is gone
  /// Whether every channel that a stage compares was healthy in a sample. Without stages that the
  /// log lacks a channel of.
  std::map<Stage, std::vector<char>> usable;
  std::vector<Warning> notes;  ///< what was found, one sentence each, with channel names
};

/// Screens a log.
///
/// - *Stuck*: the same reading 20 times or more running, of a quantity that never rests in flight
///   (currents, the voltage at the drone), or of an instrument that is noisy in the rest of the
///   log.
/// - *Spikes*: further than 8 robust standard deviations from the median of the 7 samples around
///   (Hampel 1974; Pearson et al. 2016, EURASIP J. Adv. Signal Process. 2016:87).
/// - *Clocks*: the delay of the drone voltage and the bus pair against the supply current, and of
///   height and airspeed against it or, without one, the bus, that makes sample-to-sample changes
///   agree best with `model`. A wrong model has wrong magnitudes, not wrong moments, so this does
///   not depend on what is hidden. Delays below a quarter of a second or without clear improvement
///   count as none.
///
/// `model` is the base model. `log` needs at least 8 samples and a stage that is measured.
[[nodiscard]] ScreenedPowerLog screen_power_log(const PowerModel& model, const PowerLog& log);

/// The same in means over a second, where only the motors are compared and the log is faster. They
/// are judged in means over seconds anyway; the search takes as many times longer as there are
/// samples. A mean is of the usable samples, and usable where half of its samples are.
void average_fast_samples(ScreenedPowerLog& screened);

/// Throws std::invalid_argument with all that is wrong of the channels there are: currents, powers
/// or voltages that are not positive,
/// a drone voltage above the supply voltage, powers at the two ends of the tether that differ more
/// than any converter explains, the same readings at both, a power at the bus that is less than
/// a quarter of what carries the drone alone or far beyond what the motors take at most, heights
/// beyond the tether, airspeeds at which the drag would take far more, temperatures of no weather.
/// Bounds leave room for the ammeter gains and spec errors that are effects. Medians are compared,
/// or what nine tenths of the samples stay below, so that spikes do not matter.
void check_power_units(const Design& design, const PowerLog& log);

}  // namespace tethercalc
