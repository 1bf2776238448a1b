// A flight log, and what it says about drag: motion and attitude in the stabilised frame, sample by
// sample.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// Time series of an estimator's output, one element a sample in every vector; all of the same
/// length, time strictly increasing.
struct FlightLog {
  std::vector<double> time;   ///< s
  std::vector<double> roll;   ///< rad
  std::vector<double> pitch;  ///< rad, positive nose-up
  std::vector<double> yaw;    ///< rad, clockwise from north; runs on over whole turns, no jumps
  std::vector<double> north_velocity;  ///< m/s
  std::vector<double> east_velocity;   ///< m/s
  std::vector<double> down_velocity;   ///< m/s
  /// Velocity of the air over ground, m/s, where it was measured; else both are empty.
  std::vector<double> north_wind{};
  std::vector<double> east_wind{};  ///< likewise
  /// What flew where the log says that it was no multirotor: "ArduPlane V3.1.2, an aeroplane".
  std::string other_vehicle{};
};

/// A log, or the chosen part of it, that cannot tell what it is asked. The message is a sentence
/// for the user: what is wrong, where, and what would help.
class UnsuitableFlight : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Samples first ≤ i < last of a log.
struct SampleRange {
  std::size_t first = 0;  ///< index of the first sample
  std::size_t last = 0;   ///< index after the last one

  /// Number of samples.
  [[nodiscard]] std::size_t size() const { return last - first; }
  /// Same bounds.
  bool operator==(const SampleRange&) const = default;
};

/// How attitude and speeds are turned into accelerations.
enum class Kinematics {
  exact,
  published,  ///< as in the paper: see `observe` and `fit_drag`
};

/// Time series in the stabilised frame, which turns with the yaw but neither pitches nor rolls: its
/// forward and right axes are horizontal, down is down. One element a sample in every vector.
struct Observations {
  std::vector<double> time;            ///< s, the log's own clock
  std::vector<double> tilt;            ///< rad, θ: positive leaning forward (nose down)
  std::vector<double> roll;            ///< rad
  std::vector<double> yaw;             ///< rad
  std::vector<double> forward_speed;   ///< m/s over ground
  std::vector<double> right_speed;     ///< m/s over ground
  std::vector<double> down_speed;      ///< m/s
  std::vector<double> forward_wind{};  ///< m/s over ground; empty where not measured
  std::vector<double> right_wind{};    ///< likewise
  /// m/s², of the velocity over ground, along the heading at each sample: what forces do, however
  /// the nose turns. In the published kinematics the rate of change of forward_speed, which a turn
  /// changes as well.
  std::vector<double> forward_acceleration;
  std::vector<double> right_acceleration;     ///< m/s², of the velocity over ground, to the right
  std::vector<double> down_acceleration;      ///< m/s²
  std::vector<double> expected_acceleration;  ///< m/s² forward if there were no drag
  Kinematics kinematics = Kinematics::exact;  ///< of the accelerations forward

  /// Number of samples.
  [[nodiscard]] std::size_t size() const { return time.size(); }
};

/// Throws UnsuitableFlight unless all series of `log` have the same length of at least 3, are
/// finite, and time strictly increases, naming the first offending sample; and where something else
/// than a multirotor flew.
void validate(const FlightLog& log);

/// The samples taken at `from` ≤ time ≤ `to` seconds of the log's own clock (either may be
/// infinite). Throws UnsuitableFlight where there are none.
[[nodiscard]] SampleRange range_in_seconds(const FlightLog& log, double from, double to);

/// The samples from `from` to `to` percent of the number of samples, each bound rounded down:
/// 0 ≤ from < to ≤ 100. Throws UnsuitableFlight otherwise, or where no sample is left.
[[nodiscard]] SampleRange range_in_percent(const FlightLog& log, double from, double to);

/// A place in a log: seconds of its own clock, or percent of its samples.
struct LogPosition {
  double value = 0;      ///< s, or percent in [0, 100]
  bool percent = false;  ///< what `value` counts
};

/// The samples from `from` to `to`, each in its own unit and either absent for the log's own end.
/// Throws UnsuitableFlight where no sample is left.
[[nodiscard]] SampleRange select_range(const FlightLog& log, std::optional<LogPosition> from,
                                       std::optional<LogPosition> to);

/// The parts of the log that are flown from place to place, in their order: each from the first to
/// the last time that the horizontal speed stays at 1 m/s or more for at least 1 s.
/// Such stretches with less than 30 s between them belong together (a pause in the air is data
/// too); a longer pause may be a landing, and on the ground attitude is no thrust. Throws
/// UnsuitableFlight where the drone never moves so.
[[nodiscard]] std::vector<SampleRange> moving_parts(const FlightLog& log);

/// The longest of `moving_parts`, the first of equal ones.
[[nodiscard]] SampleRange moving_part(const FlightLog& log);

/// Mean pitch in rad over the whole of `hover`: what the attitude estimator reads in level flight
/// without wind, to be passed to `observe` (paper section IV, first flight). The hover should turn
/// through all headings, else a steady wind leans into it, and hold no time on the ground, whose
/// slope is no offset. Throws UnsuitableFlight where the drone flies forward or backward at more
/// than 2 m/s for a fifth of the samples: it leans to do so.
[[nodiscard]] double pitch_offset_from_hover(const FlightLog& hover);

/// Median step in s of `time`, which has at least two entries and rises.
[[nodiscard]] double median_step(const std::vector<double>& time);
/// Of the same, in s: a longer step is a gap.
[[nodiscard]] double shortest_gap(const std::vector<double>& time);

/// Turns samples `range` of `log` into observations.
///
/// - θ = −(pitch − pitch_offset), `pitch_offset` in rad.
/// - Velocities are rotated by the yaw; accelerations are the derivative of the *rotated* speeds:
///   central differences of second order for the given, not necessarily even, times (the
///   three-point formula exact for parabolas), taken over the whole log, so that a bound of the
///   range is not an edge. No smoothing (paper section IV).
/// - expected_acceleration = (g − a_D)·tanθ: the thrust that carries the drone in height, leaning
///   forward. So it is for Euler angles in the order yaw, pitch, roll, whatever the roll φ; the
///   published one (paper eq. for a_ef, whose a_od is positive upward) divides by cosφ, within ±5°
///   of roll at most 0.4 %.
///
/// A step of more than three times the median one is a gap. Nothing is differentiated across it:
/// the neighbours of a gap, like the ends of the log, get one-sided differences, and a sample alone
/// between two gaps is left out, so the result may be shorter than the range.
///
/// `gravity` in m/s², > 0. Throws UnsuitableFlight for an invalid log, a range that is empty or
/// exceeds it, where the drone tilts or rolls beyond 75° within the range: there the thrust no
/// longer carries it, and where more than 1 % of the range is faster than 200 m/s: there the
/// estimator has diverged.
[[nodiscard]] Observations observe(const FlightLog& log, const SampleRange& range,
                                   double pitch_offset, double gravity = standard_gravity,
                                   Kinematics kinematics = Kinematics::exact);

/// Drag over mass, m/s², one element a sample: what leaning would give, `expected_acceleration`,
/// less `forward_acceleration`.
[[nodiscard]] std::vector<double> forward_drag_over_mass(const Observations& flight);

}  // namespace tethercalc
