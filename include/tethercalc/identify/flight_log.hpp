// A drone's attitude and velocity over time: what drag is learned from.
#pragma once

#include <string>
#include <vector>

namespace tethercalc {

/// Time series of an estimator's output, one element a sample in every vector; all of the same
/// length, time strictly increasing.
struct FlightLog {
  std::vector<double> time;            ///< s
  std::vector<double> roll;            ///< rad
  std::vector<double> pitch;           ///< rad, positive nose-up
  std::vector<double> yaw;             ///< rad, clockwise from north
  std::vector<double> north_velocity;  ///< m/s
  std::vector<double> east_velocity;   ///< m/s
  std::vector<double> down_velocity;   ///< m/s
  /// What flew where the log says that it was no multirotor: "ArduPlane V3.1.2, an aeroplane".
  std::string other_vehicle;
};

}  // namespace tethercalc
