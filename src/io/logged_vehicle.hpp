// What flew, by what the log's firmware says of itself.
#pragma once

#include <string>

#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// The vehicle of a log.
struct LoggedVehicle {
  std::string firmware;   ///< "ArduCopter V4.5.7", "PX4 1.11.2"; may be empty
  std::string kind;       ///< "a multirotor", "an aeroplane"; empty where the log does not tell
  bool is_other = false;  ///< surely no multirotor
};

/// From the firmware's first words (ArduPilot), or from its information and vehicle_status (PX4).
[[nodiscard]] LoggedVehicle logged_vehicle(const AutopilotLog& log);

}  // namespace tethercalc
