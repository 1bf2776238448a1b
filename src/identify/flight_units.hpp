// Whether a flight is in the units its channels should have: told before any physics is judged,
// since each mistake would pass for a huge drag or effect.
#pragma once

#include <optional>
#include <vector>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// m/s², one element a sample: yaw rate times speed to the right, which a frame that turns carries
/// into the forward speed, force or no force. 0 at both ends.
[[nodiscard]] std::vector<double> turn_acceleration(const Observations& flight);

/// How the changes over one second of the forward acceleration go with those of g·tan θ.
struct Leaning {
  double correlation = 0;  ///< of both
  double slope = 0;        ///< of the acceleration over g·tan θ
  double size = 0;         ///< of g·tan θ over that of the acceleration, root mean squares
};

/// What the turning of the frame does to the forward speed is no force and is taken off first.
/// `gravity` in m/s². Nothing where the flight is shorter than ten seconds, or one of the two never
/// changes.
[[nodiscard]] std::optional<Leaning> leaning_over_a_second(const Observations& flight,
                                                           double gravity);

/// A drone that leans forward by θ gains about g·tan θ of forward acceleration, less what drag
/// takes of it within a second: of the changes over one second (`leaning_over_a_second`) the slope
/// is 0.6 to 0.9 in real and in simulated flights.
///
/// Throws UnsuitableFlight where the pitch never moves, where the acceleration follows the pitch
/// with the wrong sign or in another proportion than any drag leaves, and where the pitch is too
/// level for the accelerations.
void check_flight_units(const Observations& flight, double gravity);

}  // namespace tethercalc
