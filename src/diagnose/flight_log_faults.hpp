// Samples of a flight log that cannot be true: spikes and stuck sensors. Told before any physics is
// judged, since each would pass for a huge effect.
#pragma once

#include <vector>

#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// What was found wrong with a log within a range of it.
struct LogFaults {
  std::vector<bool> sample;     ///< true where some channel of the whole log cannot be trusted
  std::vector<Warning> notes;   ///< what was found
  bool level_assumed = false;   ///< the roll never moves
  bool height_unknown = false;  ///< the down velocity never moves
};

/// Marks spikes (a sample that stands out from the line between its neighbours ten times as far as
/// samples usually do, and twice as far as the neighbours are apart, and is no corner between
/// straight lines: Hampel's identifier on second differences, see Pearson, Outliers in Process
/// Modeling and Identification, IEEE Trans. Control Systems Technology 10, 2002) and stretches of a
/// second and more in which a channel repeats one value while it moves elsewhere. Spikes are
/// replaced in `log` by that line, so that neighbours do not inherit them.
[[nodiscard]] LogFaults repair_flight_log(FlightLog& log, const SampleRange& range);

}  // namespace tethercalc
