// What the tilt of a flight says of a drone's drag: what a power log of the same flight is held
// against, too.
#pragma once

#include <vector>

#include "tethercalc/model/airframe.hpp"

namespace tethercalc {

/// Force over mass is all that a tilt shows: a drone twice as heavy with twice the drag leans
/// alike.
///
/// `over_mass` is the mean over `airspeed` of g·tan θ, θ being the tilt of steady flight. Its
/// elements are the pseudo-values of the jackknife over blocks, N·q − (N − 1)·q_b with q_b from the
/// fit without block b (Tukey 1958): their mean is the estimate, and they spread as independent
/// readings of it would.
struct DragByTilt {
  AirframeDrag law;               ///< that of a drone with the mass that the flight was judged by
  std::vector<double> airspeed;   ///< m/s, forward positive: means of equal parts of what was flown
  std::vector<double> time;       ///< s of the flight's clock, the middle of each block
  std::vector<double> over_mass;  ///< m/s², one a block
};

}  // namespace tethercalc
