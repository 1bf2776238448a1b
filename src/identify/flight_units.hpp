// Whether a flight is in the units its channels should have: told before any physics is judged,
// since each mistake would pass for a huge drag or effect.
#pragma once

#include <optional>
#include <vector>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// A horizontal axis of the stabilised frame.
enum class Axis { forward, right };

/// rad/s, one element a sample; 0 at both ends.
[[nodiscard]] std::vector<double> yaw_rate(const Observations& flight);

/// How the changes over one second of the acceleration along an axis go with those of g·tan θ, or
/// g·tan φ/cos θ to the right.
struct Leaning {
  double correlation = 0;  ///< of both; 0.8 to 0.95 in flights, about zero in a car or a hand
  double slope = 0;        ///< of the acceleration over what leaning gives
  double size = 0;         ///< of what leaning gives over the acceleration, root mean squares
};
/// Correlation above which a drone speeds up as it leans.
inline constexpr double leans_to_speed_up = 0.5;

/// What the turning of the frame does to the speeds is no force and is taken off first. `gravity`
/// in m/s². Nothing where the flight is shorter than ten seconds, or one of the two never changes
/// or is not known.
[[nodiscard]] std::optional<Leaning> leaning_over_a_second(const Observations& flight,
                                                           double gravity,
                                                           Axis axis = Axis::forward);

/// rad in [−π, π], by which the heading is to the right of the axis along which the drone speeds up
/// where its nose leans: the argument of the regression of one on the other as complex numbers, by
/// changes over a second. 0 where the acceleration to the right is not known, or follows no lean.
[[nodiscard]] double heading_from_leaning(const Observations& flight, double gravity);

/// rad in (−π, π], of the whole flight.
[[nodiscard]] double mean_heading(const Observations& flight);

/// Whether headings a good part of a turn, of `apart` rad, are flown, each for some time. By
/// default a third of a force across the one is along the other.
[[nodiscard]] bool turns(const Observations& flight, double apart = 0.35);

/// Whether the acceleration to the right tells of drag: it follows the roll, and the flight turns
/// or is flown to the side, so that it holds more than the roll's own errors.
[[nodiscard]] bool shows_both_axes(const Observations& flight, double gravity);

/// `heading_from_leaning` where that is clearly not 0. To be asked of flights that do not show both
/// axes (`shows_both_axes`): the logged forward speed is then the true one times its cosine; turns
/// in wind look like it. Real flights along one axis are within 3°.
[[nodiscard]] std::optional<double> heading_error(const Observations& flight, double gravity);

/// A drone that leans forward by θ gains about g·tan θ of forward acceleration, less what drag
/// takes of it within a second: of the changes over one second (`leaning_over_a_second`) the slope
/// is 0.6 to 0.9 in real and in simulated flights.
///
/// Throws UnsuitableFlight where the pitch never moves, where the acceleration follows the pitch or
/// the thrust with the wrong sign, or the pitch in another proportion than any drag leaves, where
/// the pitch is too level for the accelerations, in flight or on the ground, where leaning and
/// acceleration agree only after velocities are exchanged or the yaw is counted otherwise, and
/// where more than 8 m/s are kept nose-up on opposite headings, by wings.
void check_flight_units(const Observations& flight, double gravity);

}  // namespace tethercalc
