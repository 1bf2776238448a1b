// Drag from flight logs in one call: range, observations, fit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tethercalc/identify/drag_fit.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// What the logs do not say.
struct DragIdentificationOptions {
  DragFitConditions conditions;               ///< mass, air density, gravity
  double pitch_offset = 0;                    ///< rad, what the log's pitch reads in level flight
  Kinematics kinematics = Kinematics::exact;  ///< published: reproduces the paper's digits
  std::optional<LogPosition> from;            ///< first of the samples to use, in every log
  std::optional<LogPosition> to;  ///< last of them; with neither, the moving part is used
};

/// A fit together with what it was made of.
struct DragIdentification {
  DragIdentificationOptions options;  ///< as given
  std::vector<Observations> flights;  ///< one a log: the part of it that went into the fit
  DragFit fit;                        ///< of all logs together
};

/// The observations that `identify_drag` makes of one log: the samples chosen by `options`, or the
/// moving part. Throws UnsuitableFlight where the log is invalid or has no such part, and where its
/// numbers cannot be in the units that they should have (pitch in radians or upside down, speeds in
/// km/h, time in milliseconds): drag and diagnosis refuse the same.
[[nodiscard]] Observations observe_part(const FlightLog& log,
                                        const DragIdentificationOptions& options);

/// What is to be said of a log whose flights beside the longest are not observed, since no range is
/// chosen; nothing of others. Throws UnsuitableFlight where the drone never moves.
[[nodiscard]] std::optional<Warning> unused_flights_warning(
    const FlightLog& log, const DragIdentificationOptions& options);

/// Fits the drag shared by `logs` and the wind of each, see `fit_drag`, to the samples chosen by
/// `options`, see `select_range` and `moving_part`. Throws UnsuitableFlight where a log is invalid
/// or cannot determine the parameters; of several logs, the message says which.
[[nodiscard]] DragIdentification identify_drag(std::span<const FlightLog> logs,
                                               const DragIdentificationOptions& options);

}  // namespace tethercalc
