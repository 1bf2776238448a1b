// The channels of a log in which effects show themselves.
#pragma once

#include <string>
#include <vector>

#include "diagnose/flight_prediction.hpp"
#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/diagnose/power_log.hpp"

namespace tethercalc {

/// The channel of a flight that `id`, as in `Effect::channel`, names, one value a sample:
/// "forward_speed", "tilt", "tilt_rate", "yaw", "time", "braking" (forward speed times tilt while
/// they oppose, else NaN) or "sinking" (forward speed times down speed). Throws
/// std::invalid_argument for any other.
[[nodiscard]] Channel flight_channel(const std::string& id, const FlightRecord& record);

/// The same of a power log: "supply_current", "current_height" (their product), "bus_power",
/// "height", "airspeed" or "time". The log needs the channels in question.
[[nodiscard]] Channel power_channel(const std::string& id, const PowerLog& log);

}  // namespace tethercalc
