// The bottom of the total power along a stretch of motor curve on which it is one valley.
#pragma once

#include "solve/thrust_at.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// The radius in `radii` with the least total power, where the motor follows `pieces` of `motor`,
/// whose slopes rise, and the power is one valley. `start` lies in `radii` and on those pieces, or
/// above the motor's last point if that ends them.
///
/// The bottom lies where the loss saved by a little more radius equals the power spent on carrying
/// it, where a warm cable also saves by cooling down. Saved over spent falls all the way: savings
/// with 1/r³, spending rises about with r, and jumps up at each vertex. So the bottom is within a
/// piece, where the ratio passes 1, or at a vertex, where it jumps across. A step to where the
/// ratio would be 1 if it fell with a power of r lands close; what is known is kept as a bracket;
/// and a vertex is visited where a step would leave its piece but a step with the next piece's
/// slope would not reach it.
[[nodiscard]] ThrustAt valley_bottom(const SteadyFlight& flight, const WarmTether& tether,
                                     const MotorCurve& motor, Pieces pieces, Interval radii,
                                     const ThrustAt& start);

}  // namespace tethercalc
