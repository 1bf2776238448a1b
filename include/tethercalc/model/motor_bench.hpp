// From noisy test-bench points to a motor curve that rises.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tethercalc/model/motor_curve.hpp"

namespace tethercalc {

/// Measured points that contradicted each other and were replaced by their mean.
struct PooledMotorPoints {
  std::vector<std::size_t> members;  ///< positions in the measured points, by rising thrust
  MotorPoint mean;                   ///< the point in their place
};

/// What `isotonic_motor_points` made of measured points.
struct IsotonicMotorPoints {
  std::vector<MotorPoint> points;         ///< by strictly rising thrust and strictly rising power
  std::vector<PooledMotorPoints> pooled;  ///< by rising thrust; empty where nothing was pooled
};

/// Points fit for a MotorCurve from measured ones in any order: the isotonic regression of power on
/// thrust by pooling adjacent violators (Ayer, Brunk, Ewing, Reid and Silverman 1955, Annals of
/// Mathematical Statistics 26(4), 641–647): neighbours whose power does not rise are replaced by
/// their mean power, which is the least-squares fit among all curves that do not fall. Since a
/// MotorCurve is inverted it must rise strictly, so a pool becomes a single point at its mean
/// thrust instead of a level stretch. Points of equal thrust are pooled first. Points that rise are
/// kept to the last digit.
///
/// Throws std::invalid_argument where a thrust or power is not finite and positive. Takes time
/// n·log n.
[[nodiscard]] IsotonicMotorPoints isotonic_motor_points(std::span<const MotorPoint> measured);

}  // namespace tethercalc
