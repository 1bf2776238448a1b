// Flight logs of the CSV form, read the short way for tests that start from a log in memory.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tethercalc/identify/observations.hpp"

namespace tethercalc::test {

/// The columns time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s below one header line.
inline FlightLog read_flight_csv(const std::filesystem::path& path) {
  constexpr double degree = 0.017453292519943295;
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  FlightLog log;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    double values[7] = {};
    for (double& value : values) {
      fields >> value;
      fields.ignore(1);
    }
    log.time.push_back(values[0]);
    log.roll.push_back(values[1] * degree);
    log.pitch.push_back(values[2] * degree);
    log.yaw.push_back(values[3] * degree);
    log.north_velocity.push_back(values[4]);
    log.east_velocity.push_back(values[5]);
    log.down_velocity.push_back(values[6]);
  }
  return log;
}

}  // namespace tethercalc::test
