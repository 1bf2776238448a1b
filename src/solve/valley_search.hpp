// The bottom of the total power along a stretch of motor curve on which it is one valley.
#pragma once

#include <cstddef>

#include "solve/thrust_at.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// Pieces of a motor curve, both included.
struct Pieces {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The radius in `radii` with the least total power, where the motor follows `pieces` of `motor`,
/// whose slopes rise, and the converter's efficiency is constant. `start` lies in `radii` and on
/// those pieces, or above the motor's last point if that ends them.
///
/// The bottom lies where the loss saved by a little more radius equals the power spent on carrying
/// it. Saved over spent falls all the way: savings with 1/r³, spending rises about with r, and
/// jumps up at each vertex. So the bottom is within a piece, where the ratio passes 1, or at a
/// vertex, where it jumps across. A step to where the ratio would be 1 if it fell with a power of r
/// lands close; what is known is kept as a bracket; and a vertex is visited where a step would
/// leave its piece but a step with the next piece's slope would not reach it.
[[nodiscard]] ThrustAt valley_bottom(const SteadyFlight& flight, const MotorCurve& motor,
                                     Pieces pieces, Interval radii, const ThrustAt& start);

}  // namespace tethercalc
