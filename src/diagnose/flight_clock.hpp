// Stamps of a flight log against the moments at which its samples were taken.
#pragma once

#include <optional>

#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// How far the stamps of a log are off even times, and what its velocities say of that.
struct ClockJitter {
  double step = 0;  ///< s between even times
  double rms = 0;   ///< s, stamps less even times
  /// Part of the stamps' deviations that the velocities show: 1 where samples were taken when their
  /// stamps say, 0 where they were taken evenly.
  double shown = 0;
  double shown_se = 0;  ///< standard error of that
};

/// Of the whole log, pieced together where more than a second is missing. Nothing where the stamps
/// keep no even step, a missing row being two of them, with deviations that know nothing of each
/// other and are small beside it: those of a clock that is read late now and then.
[[nodiscard]] std::optional<ClockJitter> clock_jitter(const FlightLog& log);

/// Where stamps jitter by more than 2 % of the step, and velocities show that samples were taken
/// evenly, puts even times in the stamps' place and says so.
///
/// Differences of velocities over stamps that are off by δ each are off by the part √2·δ/2Δt of
/// themselves: a noise that grows with what is measured, unlike that of any instrument.
[[nodiscard]] std::optional<Warning> even_out_stamps(FlightLog& log);

}  // namespace tethercalc
