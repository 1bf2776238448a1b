// Samples of a flight log that cannot be true: spikes, stuck sensors, and numbers that cannot be
// what their columns say. Told before any physics is judged, since each would pass for a huge
// effect.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/flight_prediction.hpp"
#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// What was found wrong with a log within a range of it.
struct LogFaults {
  std::vector<bool> sample;        ///< true where some channel of the whole log cannot be trusted
  std::vector<std::string> notes;  ///< sentences for a person
  bool level_assumed = false;      ///< the roll never moves
  bool height_unknown = false;     ///< the down velocity never moves
};

/// Marks spikes (a sample that stands out from the line between its neighbours ten times as far as
/// samples usually do, and twice as far as the neighbours are apart: Hampel's identifier on second
/// differences, see Pearson, Outliers in Process Modeling and Identification, IEEE Trans. Control
/// Systems Technology 10, 2002) and stretches of a second and more in which a channel repeats one
/// value while it moves elsewhere. Spikes are replaced in `log` by that line, so that neighbours do
/// not inherit them.
[[nodiscard]] LogFaults repair_flight_log(FlightLog& log, const SampleRange& range);

/// How the changes over one second of the forward acceleration go with those of g·tan θ.
struct Leaning {
  double correlation = 0;  ///< of both
  double slope = 0;        ///< of the acceleration over g·tan θ
  double size = 0;         ///< of g·tan θ over that of the acceleration, root mean squares
};

/// What the turning of the frame does to the forward speed is no force and is taken off first.
/// `forward_acceleration` in m/s², one a sample of `flight`; `step` is the sampling interval in s.
/// Nothing where the flight is shorter than ten seconds, or one of the two never changes.
[[nodiscard]] std::optional<Leaning> leaning_over_a_second(
    const FlightRecord& flight, const std::vector<double>& forward_acceleration, double step);

/// A drone that leans forward by θ gains about g·tan θ of forward acceleration, less what drag
/// takes of it within a second: of the changes over one second (`leaning_over_a_second`) the slope
/// is 0.6 to 0.9 in real and in simulated flights.
///
/// Throws UnsuitableFlight where the pitch never moves, where the acceleration follows the pitch
/// with the wrong sign or in another proportion than any drag leaves, and where the pitch is too
/// level for the accelerations.
void check_flight_units(const FlightRecord& flight, const std::vector<double>& forward_acceleration,
                        double step);

}  // namespace tethercalc
