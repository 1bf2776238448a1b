#include "tethercalc/io/mission.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/json_document.hpp"
#include "model/constants.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

/// MAV_CMD of the MAVLink message set "common".
enum class Command : int {
  waypoint = 16,
  loiter_time = 19,
  return_to_launch = 20,
  takeoff = 22,
  yaw = 115,
  change_speed = 178,
};

/// MAV_FRAME.
constexpr int frame_mission = 2;
constexpr int frame_relative_height = 3;

constexpr double turn_rate_deg_s = 30;
/// m a degree of latitude, as ArduPilot has it (LOCATION_SCALING_FACTOR, 0.011131884502145 m for
/// 1e-7 degrees).
constexpr double metres_per_degree = 111318.84502145;

/// As QGroundControl and ArduPilot number the seven: the last three are place and height.
struct Item {
  Command command = Command::waypoint;
  std::array<double, 7> parameters{};
  [[nodiscard]] bool has_place() const {
    return command != Command::yaw && command != Command::change_speed &&
           command != Command::return_to_launch;
  }
};

double degrees(double heading) {
  const double angle = std::round(std::remainder(heading / unit::degree, 360) * 10) / 10;
  return angle < 0 ? angle + 360 : angle + 0.0;
}

class Mission {
 public:
  explicit Mission(const Home& home) : home_(home) {}

  void take_off(double height) {
    at_.height = height;
    add_place(Command::takeoff, 0, at_);
  }
  void fly_to(const Waypoint& next) {
    const bool moves =
        std::hypot(next.north - at_.north, next.east - at_.east, next.height - at_.height) > 0.01;
    const double heading = degrees(next.heading);
    const double turn =
        std::isnan(heading_) ? 180 : std::abs(std::remainder(heading - heading_, 360));
    const double turning = turn / turn_rate_deg_s;
    if (!moves) {
      add_place(Command::loiter_time, std::ceil(turning + next.hold), at_);
      look(heading);
      return;
    }
    const double speed = std::round(next.speed * 10) / 10;
    if (turn > 0 || speed != speed_) {
      add_place(Command::loiter_time, std::ceil(turning) + 1, at_);
      if (speed != speed_) items_.push_back({Command::change_speed, {1, speed, -1}});
      speed_ = speed;
      if (turn > 0) look(heading);
    }
    add_place(Command::waypoint, std::ceil(next.hold), next);
    look(heading);
    at_ = next;
  }
  void return_home() { items_.push_back({Command::return_to_launch, {}}); }

  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

 private:
  void look(double heading) {
    heading_ = heading;
    items_.push_back({Command::yaw, {heading, turn_rate_deg_s, 0, 0}});
  }
  void add_place(Command command, double first, const Waypoint& place) {
    const double east_degree = metres_per_degree * std::cos(home_.latitude * unit::degree);
    items_.push_back({command,
                      {first, 0, 0, 0, home_.latitude + place.north / metres_per_degree,
                       std::remainder(home_.longitude + place.east / east_degree, 360),
                       std::round(place.height * 10) / 10}});
  }

  Home home_;
  Waypoint at_;
  double heading_ = nan;  ///< none yet
  double speed_ = 0;
  std::vector<Item> items_;
};

std::vector<Item> items_of(const NextFlight& flight, const Home& home) {
  Mission mission(home);
  mission.take_off(flight.limits.height);
  for (const Manoeuvre& manoeuvre : flight.manoeuvres) {
    for (const Waypoint& next : manoeuvre.waypoints) mission.fly_to(next);
  }
  mission.return_home();
  return mission.items();
}

std::string waypoints_text(const std::vector<Item>& items, const Home& home) {
  std::string text = "QGC WPL 110\n";
  int index = 0;
  const auto line = [&](bool current, int frame, const Item& item) {
    text += fmt::format("{}\t{}\t{}\t{}", index++, current ? 1 : 0, frame,
                        static_cast<int>(item.command));
    for (std::size_t k = 0; k < item.parameters.size(); ++k) {
      const bool degrees_of_place = k == 4 || k == 5;
      text += degrees_of_place ? fmt::format("\t{:.8f}", item.parameters[k])
                               : fmt::format("\t{:g}", item.parameters[k]);
    }
    text += "\t1\n";
  };
  // The first line is home itself, absolute.
  line(true, 0, {Command::waypoint, {0, 0, 0, 0, home.latitude, home.longitude, home.altitude}});
  for (const Item& item : items) line(false, frame_relative_height, item);
  return text;
}

std::string plan_text(const std::vector<Item>& items, const NextFlight& flight, const Home& home) {
  constexpr int ardupilot = 3;         // MAV_AUTOPILOT
  constexpr int quadrotor = 2;         // MAV_TYPE
  constexpr int relative_to_home = 1;  // QGroundControl's AltitudeMode
  Json list = Json::array();
  for (const Item& item : items) {
    Json entry;
    if (item.has_place()) {
      entry["AMSLAltAboveTerrain"] = nullptr;
      entry["Altitude"] = item.parameters[6];
      entry["AltitudeMode"] = relative_to_home;
    }
    entry["autoContinue"] = true;
    entry["command"] = static_cast<int>(item.command);
    entry["doJumpId"] = list.size() + 1;
    entry["frame"] = item.has_place() ? frame_relative_height : frame_mission;
    entry["params"] = item.parameters;
    entry["type"] = "SimpleItem";
    list.push_back(std::move(entry));
  }
  const Json plan{
      {"fileType", "Plan"},
      {"geoFence", {{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}}},
      {"groundStation", "QGroundControl"},
      {"mission",
       {{"cruiseSpeed", flight.limits.speed},
        {"firmwareType", ardupilot},
        {"globalPlanAltitudeMode", relative_to_home},
        {"hoverSpeed", flight.limits.speed},
        {"items", list},
        {"plannedHomePosition", {home.latitude, home.longitude, home.altitude}},
        {"vehicleType", quadrotor},
        {"version", 2}}},
      {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
      {"version", 1}};
  return json_text(plan);
}

/// Fields of a message with a place.
struct PlaceFields {
  std::string_view message;
  std::vector<std::string> fields;  // latitude and longitude in degrees, height in m; a condition
  double condition = 0;             // what the condition has to hold, if there is one
  double degree = 1;                // what the fields count in, °
  double metre = 1;                 // likewise, m
};

/// The first of these messages with a place other than (0, 0), which stands for none.
std::optional<Home> first_place(const AutopilotLog& log, const PlaceFields& from) {
  const auto columns = log.columns(from.message, from.fields);
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    const Home home{columns[0][i] * from.degree, columns[1][i] * from.degree,
                    columns[2][i] * from.metre};
    if (columns.size() > 3 && columns[3][i] != from.condition) continue;
    if (std::abs(home.latitude) > 1e-6 && std::abs(home.latitude) <= 85 &&
        std::abs(home.longitude) <= 180) {
      return home;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Home> logged_home(const AutopilotLog& log) {
  constexpr double at_home = 1;  // ORGN: 0 is the estimator's origin
  const std::array<PlaceFields, 8> places = {
      {{"ORGN", {"Lat", "Lng", "Alt", "Type"}, at_home},
       {"ORGN", {"Lat", "Lng", "Alt"}},
       {"POS", {"Lat", "Lng", "Alt"}},
       {"GPS", {"Lat", "Lng", "Alt"}},
       {"home_position", {"lat", "lon", "alt"}},
       {"vehicle_global_position", {"lat", "lon", "alt"}},
       {"vehicle_gps_position", {"latitude_deg", "longitude_deg", "altitude_msl_m"}},
       // Older PX4: integers.
       {"vehicle_gps_position", {"lat", "lon", "alt"}, 0, 1e-7, 1e-3}}};
  for (const PlaceFields& place : places) {
    if (const auto home = first_place(log, place)) return home;
  }
  return std::nullopt;
}

MissionFormat mission_format(std::string_view file) {
  if (file.ends_with(".waypoints") || file.ends_with(".txt")) return MissionFormat::waypoints;
  if (file.ends_with(".plan")) return MissionFormat::plan;
  throw InputError("--next-flight",
                   fmt::format("\"{}\" is no mission by its name; allowed are .waypoints and .txt "
                               "(ArduPilot) and .plan (QGroundControl)",
                               file));
}

std::string mission_text(const NextFlight& flight, const Home& home, MissionFormat format) {
  const std::vector<Item> items = items_of(flight, home);
  return format == MissionFormat::plan ? plan_text(items, flight, home)
                                       : waypoints_text(items, home);
}

}  // namespace tethercalc
