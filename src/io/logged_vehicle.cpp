#include "io/logged_vehicle.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tethercalc {
namespace {

struct Firmware {
  std::string_view name;  // with which its words begin
  std::string_view kind;
  bool is_other;
};
constexpr std::array<Firmware, 9> ardupilot_firmwares = {
    {{"ArduCopter", "a multirotor", false},
     {"APM:Copter", "a multirotor", false},
     {"ArduPlane", "an aeroplane", true},
     {"APM:Plane", "an aeroplane", true},
     {"ArduRover", "a rover", true},
     {"APM:Rover", "a rover", true},
     {"ArduSub", "a submarine", true},
     {"Blimp", "an airship", true},
     {"AntennaTracker", "an antenna tracker", true}}};

LoggedVehicle ardupilot_vehicle(const LogContents& contents) {
  for (const std::string& words : contents.words) {
    for (const Firmware& firmware : ardupilot_firmwares) {
      if (!words.starts_with(firmware.name)) continue;
      return {words, std::string(firmware.kind), firmware.is_other};
    }
  }
  return {contents.words.empty() ? "" : contents.words.front(), "", false};
}

/// The value that most messages hold; a damaged one does not decide.
std::optional<int> usual_value(const AutopilotLog& log, std::string_view message,
                               const std::string& field) {
  std::map<double, std::size_t> counts;
  const std::vector<std::string> fields = {field};
  const auto columns = log.columns(message, fields);
  for (const double value : columns.front()) ++counts[value];
  std::optional<int> usual;
  std::size_t most = 0;
  for (const auto& [value, count] : counts) {
    if (count <= most || !(value >= 0 && value < 256)) continue;
    most = count;
    usual = static_cast<int>(value);
  }
  return usual;
}

/// By MAV_TYPE of the MAVLink message set "common".
std::pair<std::string_view, bool> kind_of_system(int type) {
  switch (type) {
    case 2:
      return {"a multirotor (quadrotor)", false};
    case 3:
      return {"a coaxial helicopter", true};
    case 4:
      return {"a helicopter", true};
    case 13:
      return {"a multirotor (hexarotor)", false};
    case 14:
      return {"a multirotor (octorotor)", false};
    case 15:
      return {"a multirotor (tricopter)", false};
    case 29:
      return {"a multirotor (dodecarotor)", false};
    case 1:
      return {"an aeroplane", true};
    case 5:
      return {"an antenna tracker", true};
    case 7:
      return {"an airship", true};
    case 10:
      return {"a rover", true};
    case 11:
      return {"a boat", true};
    case 12:
      return {"a submarine", true};
    default:
      break;
  }
  constexpr int first_vtol = 19;
  constexpr int last_vtol = 25;
  if (type >= first_vtol && type <= last_vtol) return {"a VTOL aeroplane", true};
  return {"", false};
}

/// "1.11.2" from ver_sw_release, which holds it as bytes from the highest (PX4, version.h), and a
/// kind of release in the lowest.
std::string px4_version(const LogContents& contents) {
  const auto release = contents.information.find("ver_sw_release");
  if (release == contents.information.end()) return "";
  const auto number =
      static_cast<std::uint32_t>(std::strtoul(release->second.c_str(), nullptr, 10));
  return fmt::format(" {}.{}.{}", number >> 24, (number >> 16) & 0xFF, (number >> 8) & 0xFF);
}

LoggedVehicle px4_vehicle(const AutopilotLog& log) {
  const LogContents& contents = log.contents();
  LoggedVehicle vehicle;
  const auto system = contents.information.find("sys_name");
  if (system != contents.information.end()) vehicle.firmware = system->second;
  if (vehicle.firmware == "PX4") vehicle.firmware += px4_version(contents);
  const auto hardware = contents.information.find("ver_hw");
  if (hardware != contents.information.end()) vehicle.firmware += " on " + hardware->second;

  // VEHICLE_TYPE of PX4's VehicleStatus.msg; a VTOL flies as more than one.
  constexpr int rotary_wing = 1;
  constexpr std::array<std::string_view, 5> types = {"", "a multirotor", "an aeroplane", "a rover",
                                                     "an airship"};
  const auto system_type = usual_value(log, "vehicle_status", "system_type");
  const auto type = usual_value(log, "vehicle_status", "vehicle_type");
  if (usual_value(log, "vehicle_status", "is_vtol").value_or(0) != 0) {
    vehicle.kind = "a VTOL aeroplane";
    vehicle.is_other = true;
  } else if (system_type && !kind_of_system(*system_type).first.empty()) {
    const auto [kind, is_other] = kind_of_system(*system_type);
    vehicle.kind = kind;
    vehicle.is_other = is_other;
  } else if (type && *type > 0 && *type < static_cast<int>(types.size())) {
    vehicle.kind = types[static_cast<std::size_t>(*type)];
    vehicle.is_other = *type != rotary_wing;
  }
  return vehicle;
}

}  // namespace

LoggedVehicle logged_vehicle(const AutopilotLog& log) {
  return log.format() == LogFormat::ulog ? px4_vehicle(log) : ardupilot_vehicle(log.contents());
}

}  // namespace tethercalc
