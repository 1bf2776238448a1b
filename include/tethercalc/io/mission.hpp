// Flights as the missions that autopilots and ground stations read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "tethercalc/diagnose/next_flight.hpp"
#include "tethercalc/io/autopilot_log.hpp"

namespace tethercalc {

/// Where a mission begins and ends.
struct Home {
  double latitude = 0;   ///< degrees north, −85 to 85
  double longitude = 0;  ///< degrees east, −180 to 180
  double altitude = 0;   ///< m above sea level; missions are flown relative to home
};

/// Where the drone took off, as a log has it. DataFlash: home (message ORGN of type 1), else the
/// estimator's origin, else the first position (POS), else the first of a satellite receiver (GPS).
/// ULog: home_position, else the first vehicle_global_position or vehicle_gps_position. Nothing
/// where it has none.
[[nodiscard]] std::optional<Home> logged_home(const AutopilotLog& log);

/// How a mission is written.
enum class MissionFormat {
  waypoints,  ///< text, "QGC WPL 110": ArduPilot, Mission Planner, MAVProxy (mavlink.io, File
              ///< Formats)
  plan,       ///< JSON of QGroundControl (QGroundControl Developer Guide, Plan File Format)
};

/// That a file of this name has: .waypoints or .txt, and .plan. Throws InputError for any other.
[[nodiscard]] MissionFormat mission_format(std::string_view file);

/// Take-off, the manoeuvres, and the return home. Before each speed or heading that differs from
/// the one before, the drone hovers for as long as the nose takes to turn by 30° a second. The
/// heading is commanded again on each way: ArduPilot else points the nose to the next waypoint.
/// Commands are MAVLink's, heights are relative to home, of which a metre is as many degrees as in
/// ArduPilot. `home` within its bounds.
[[nodiscard]] std::string mission_text(const NextFlight& flight, const Home& home,
                                       MissionFormat format);

}  // namespace tethercalc
