// Missions as ground stations read them.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/dataflash_writer.hpp"
#include "support/ulog_writer.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/mission.hpp"

using namespace tethercalc;

namespace {

constexpr Home zurich{47.4, 8.5, 410};

NextFlight one_pass() {
  NextFlight flight;
  flight.limits = {.speed = 12, .acceleration = 2.5, .height = 15, .ceiling = 30, .reach = 80};
  const double east = std::acos(-1.0) / 2;
  flight.manoeuvres = {{"pass",
                        {{.east = 40, .height = 15, .speed = 8, .heading = east, .hold = 2},
                         {.height = 15, .speed = 8, .heading = east, .hold = 2}},
                        20},
                       {"hover", {{.height = 15, .speed = 1.5, .heading = 0, .hold = 6}}, 9}};
  return flight;
}

}  // namespace

TEST_CASE("an ArduPilot mission has its commands in the order they act") {
  CHECK(mission_text(one_pass(), zurich, MissionFormat::waypoints) ==
        "QGC WPL 110\n"
        "0\t1\t0\t16\t0\t0\t0\t0\t47.40000000\t8.50000000\t410\t1\n"
        "1\t0\t3\t22\t0\t0\t0\t0\t47.40000000\t8.50000000\t15\t1\n"
        "2\t0\t3\t19\t7\t0\t0\t0\t47.40000000\t8.50000000\t15\t1\n"
        "3\t0\t3\t178\t1\t8\t-1\t0\t0.00000000\t0.00000000\t0\t1\n"
        "4\t0\t3\t115\t90\t30\t0\t0\t0.00000000\t0.00000000\t0\t1\n"
        "5\t0\t3\t16\t2\t0\t0\t0\t47.40000000\t8.50053086\t15\t1\n"
        "6\t0\t3\t115\t90\t30\t0\t0\t0.00000000\t0.00000000\t0\t1\n"
        "7\t0\t3\t16\t2\t0\t0\t0\t47.40000000\t8.50000000\t15\t1\n"
        "8\t0\t3\t115\t90\t30\t0\t0\t0.00000000\t0.00000000\t0\t1\n"
        "9\t0\t3\t19\t9\t0\t0\t0\t47.40000000\t8.50000000\t15\t1\n"
        "10\t0\t3\t115\t0\t30\t0\t0\t0.00000000\t0.00000000\t0\t1\n"
        "11\t0\t3\t20\t0\t0\t0\t0\t0.00000000\t0.00000000\t0\t1\n");
}

TEST_CASE("a QGroundControl plan has the same commands as the mission") {
  const auto plan = nlohmann::json::parse(mission_text(one_pass(), zurich, MissionFormat::plan));
  CHECK(plan["fileType"] == "Plan");
  CHECK(plan["version"] == 1);
  CHECK(plan["groundStation"] == "QGroundControl");
  CHECK(plan["geoFence"]["version"] == 2);
  CHECK(plan["rallyPoints"]["version"] == 2);
  CHECK(plan["mission"]["version"] == 2);
  CHECK(plan["mission"]["plannedHomePosition"] == nlohmann::json({47.4, 8.5, 410}));
  std::istringstream lines(mission_text(one_pass(), zurich, MissionFormat::waypoints));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);  // home
  int id = 0;
  for (const auto& item : plan["mission"]["items"]) {
    REQUIRE(std::getline(lines, line));
    std::istringstream fields(line);
    double number = 0;
    for (int k = 0; k < 4; ++k) fields >> number;
    CHECK(item["command"] == number);
    CHECK(item["doJumpId"] == ++id);
    CHECK(item["type"] == "SimpleItem");
    CHECK(item["autoContinue"] == true);
    for (const auto& parameter : item["params"]) {
      fields >> number;
      CHECK(parameter.get<double>() == Approx(number).margin(1e-8));
    }
    const bool has_place = item["params"][4] != 0;
    CHECK(item["frame"] == (has_place ? 3 : 2));
    CHECK(item.contains("Altitude") == has_place);
  }
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("the name of a file says how a mission is written") {
  CHECK(mission_format("a/next.waypoints") == MissionFormat::waypoints);
  CHECK(mission_format("next.txt") == MissionFormat::waypoints);
  CHECK(mission_format("next.plan") == MissionFormat::plan);
  CHECK_THROWS_AS(mission_format("next.kml"), InputError);
  CHECK_THROWS_WITH(mission_format("plan"), Catch::Matchers::Contains(".plan (QGroundControl)"));
}

TEST_CASE("home is where the log says that it is") {
  test::DataFlashWriter log;
  log.define(70, "POS", "QLLf", "TimeUS,Lat,Lng,Alt");
  log.add(70, {std::uint64_t{1000}, std::int64_t{0}, std::int64_t{0}, 0.0});
  log.add(70, {std::uint64_t{2000}, std::int64_t{473977000}, std::int64_t{85456000}, 411.0});
  const auto first = logged_home(AutopilotLog(log.bytes(), "log"));
  REQUIRE(first);
  CHECK(first->latitude == 47.3977);
  CHECK(first->longitude == 8.5456);
  CHECK(first->altitude == 411);
  log.define(71, "ORGN", "QBLLf", "TimeUS,Type,Lat,Lng,Alt");
  log.add(71, {std::uint64_t{3000}, std::uint64_t{0}, std::int64_t{100000000},
               std::int64_t{200000000}, 5.0});
  log.add(71, {std::uint64_t{3000}, std::uint64_t{1}, std::int64_t{110000000},
               std::int64_t{200000000}, 6.0});
  CHECK(logged_home(AutopilotLog(log.bytes(), "log"))->latitude == 11);
  test::DataFlashWriter without;
  test::define_xkf1(without);
  CHECK_FALSE(logged_home(AutopilotLog(without.bytes(), "log")));
}

TEST_CASE("home is where the receiver of an older PX4 was, which counted in integers") {
  test::ULogWriter log;
  log.format("vehicle_gps_position:uint64_t timestamp;int32_t lat;int32_t lon;int32_t alt;");
  log.subscribe(3, "vehicle_gps_position");
  const auto place = [&](std::int32_t lat, std::int32_t lon, std::int32_t alt) {
    log.data(3, test::ULogContent().put(std::uint64_t{1000}).put(lat).put(lon).put(alt));
  };
  place(0, 0, 0);  // no fix
  place(634170622, 104082151, 66814);
  const std::vector<std::byte> bytes(log.bytes().begin(), log.bytes().end());
  const auto home = logged_home(AutopilotLog(bytes, "log"));
  REQUIRE(home);
  CHECK(home->latitude == Approx(63.4170622).epsilon(1e-12));
  CHECK(home->longitude == Approx(10.4082151).epsilon(1e-12));
  CHECK(home->altitude == Approx(66.814).epsilon(1e-12));
}
