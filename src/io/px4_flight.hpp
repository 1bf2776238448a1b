// Attitude and velocity from a PX4 log.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// Samples at the times of the velocities, in the order of the log.
struct Px4Motion {
  std::vector<double> time;               ///< s
  std::vector<double> roll, pitch, yaw;   ///< rad
  std::vector<double> north, east, down;  ///< m/s
  std::vector<double> down_position;      ///< m; empty where the log does not tell
  std::string source;                     ///< the messages they came from
  std::vector<Warning> notes;             ///< what was left out, and why
};

/// Reads vehicle_local_position (vx, vy, vz, z) and vehicle_attitude (q, rotating the body's
/// forward, right and down to north, east and down; before 2017 roll, pitch, yaw); of estimator
/// `core` > 0 its own estimator_local_position and estimator_attitude. (PX4,
/// msg/VehicleLocalPosition.msg and VehicleAttitude.msg.) The two are written at times of their
/// own: the attitude is interpolated to the times of the velocity; where its samples are more than
/// 0.3 s apart there, or the estimator calls the velocity invalid, the sample is left out.
///
/// Throws InputError where the log has none, or no such estimator.
[[nodiscard]] Px4Motion px4_motion(const AutopilotLog& log, int core);

}  // namespace tethercalc
