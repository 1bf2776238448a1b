// Which samples of a flight log are judged: those in which a multirotor flies, at a rate at which
// drag shows.
#pragma once

#include <vector>

#include "diagnose/flight_prediction.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// A log and what of it is judged.
struct FlightSamples {
  FlightLog log;
  SampleRange range;              ///< of `log`
  std::vector<Warning> notes;     ///< what was left out, and why
  std::vector<Detour> taken_out;  ///< between samples of the range, where no sample is left
};

/// The log with all its flights: of its `moving_parts` the longest, and others that last, in which
/// the drone speeds up as it leans, as nothing does that is carried or driven. What lies between
/// them is taken out, and so are stretches in which the drone stands (on the ground attitude is no
/// thrust) and those in which it is tilted too far for its thrust to carry it. Throws
/// UnsuitableFlight where nothing is left.
[[nodiscard]] FlightSamples flown_samples(FlightLog log, double gravity);

/// The judged samples of a log with more than 20 a second in means over stretches of about a tenth
/// of a second; slower ones as they are. Drag and attitude act within some tenths of a second:
/// faster samples hold no more of them, but the noise of a difference grows with the rate.
/// `faulty` has one element a sample of the log; a mean with one of them is faulty.
void average_fast_samples(FlightSamples& samples, std::vector<bool>& faulty);

}  // namespace tethercalc
