// Logs whose numbers cannot be what their columns say: a wrong unit, a wrong sign, columns
// exchanged. Told before any physics is judged, since each would pass for a huge effect.
#pragma once

#include <vector>

#include "diagnose/flight_prediction.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// A drone that leans forward by θ gains about g·tan θ of forward acceleration, less what drag
/// takes of it within a second: of the changes over one second the slope is 0.6 to 0.9 in real and
/// in simulated flights. What the turning of the frame does to the forward speed is no force and is
/// taken off first. `forward_acceleration` in m/s², one a sample of `flight`; `step` is the
/// sampling interval in s.
///
/// Throws UnsuitableFlight where the pitch never moves, where the acceleration follows the pitch
/// with the wrong sign or in another proportion than any drag leaves, and where the pitch is too
/// level for the accelerations.
void check_flight_units(const FlightRecord& flight, const std::vector<double>& forward_acceleration,
                        double step);

/// Throws std::invalid_argument with all that is wrong: currents or voltages that are not positive,
/// a drone voltage above the supply voltage, powers at the two ends of the tether that differ more
/// than any converter explains, heights beyond the tether, temperatures of no weather. Bounds leave
/// room for the ammeter gains and spec errors that are effects. Medians are compared, so that
/// spikes do not matter.
void check_power_units(const Design& design, const PowerLog& log);

}  // namespace tethercalc
