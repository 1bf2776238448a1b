// The power of an autopilot's flight out of its own log: which monitor, which stretch, which
// airspeed. Logs are written field by field; every expected value is what was written.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "support/dataflash_writer.hpp"
#include "support/reference_data.hpp"
#include "support/ulog_writer.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"

using namespace tethercalc;
using Catch::Contains;
using test::DataFlashWriter;
using test::LoggedValue;
using test::ULogContent;
using test::ULogWriter;

namespace {

constexpr int xkf1 = 64, bat = 65, ev = 66, xkf2 = 67, arsp = 68, msg = 69, curr = 70;

std::uint64_t us(double seconds) { return static_cast<std::uint64_t>(std::llround(1e6 * seconds)); }

/// From 10 s to 300 s, taking off at 20 s and landing at 280 s: 30 m up, 4 m/s to the north, 3 m/s
/// to the east; positions count from 100 m below take-off.
DataFlashWriter flight() {
  DataFlashWriter log;
  log.define(xkf1, "XKF1", "QBfffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,PD");
  log.define(bat, "BAT", "QBff", "TimeUS,Inst,Volt,Curr");
  log.define(ev, "EV", "QB", "TimeUS,Id");
  log.define(xkf2, "XKF2", "QBff", "TimeUS,C,VWN,VWE");
  log.define(arsp, "ARSP", "Qf", "TimeUS,Airspeed");
  log.define(msg, "MSG", "QZ", "TimeUS,Message");
  log.define(curr, "CURR", "IIhhh", "TimeMS,ThrTot,Volt,Curr,Vcc");
  for (int i = 100; i < 3000; ++i) {
    const double t = 0.1 * i;
    if (i == 200) log.add(ev, {us(t), std::uint64_t{28}});
    if (i == 2800) log.add(ev, {us(t), std::uint64_t{18}});
    const bool flies = t >= 20 && t <= 280;
    log.add(xkf1, {us(t), std::uint64_t{0}, 0.0, -5.0, 90.0, flies ? 4.0 : 0.0, flies ? 3.0 : 0.0,
                   0.0, t > 21 && flies ? -130.0 : -100.0});
  }
  return log;
}

void add_battery(DataFlashWriter& log, unsigned number, double voltage, double current,
                 double later = 0) {
  for (int i = 10; i < 300; ++i) {
    log.add(bat, {us(i + later), std::uint64_t{number}, voltage, current});
  }
}

PowerLogReading read(const DataFlashWriter& log, const PowerLogOptions& options = {}) {
  return parse_power_log(log.bytes(), "flight.bin", options);
}

std::string refusal(const DataFlashWriter& log, const PowerLogOptions& options = {}) {
  try {
    (void)read(log, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

bool all_are(const std::vector<double>& values, double expected) {
  return !values.empty() && std::ranges::all_of(values, [expected](double value) {
    return std::abs(value - expected) < 1e-4;
  });
}

bool says(const PowerLogReading& reading, const std::string& words) {
  return std::ranges::any_of(reading.notes, [&](const Warning& note) {
    return note.sentence.find(words) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("power is read at the battery's times, from take-off to landing, height above take-off") {
  DataFlashWriter log = flight();
  add_battery(log, 0, 15.5, 20);
  const PowerLogReading reading = read(log);
  CHECK(reading.source == "BAT 0 and XKF1 of EKF core 0");
  REQUIRE(reading.log.time.size() == 261);
  CHECK(reading.log.time.front() == Approx(20));
  CHECK(reading.log.time.back() == Approx(280));
  CHECK(all_are(reading.log.bus_voltage, 15.5));
  CHECK(all_are(reading.log.bus_current, 20));
  CHECK(all_are(reading.log.airspeed, 5));
  CHECK(reading.log.height.front() == Approx(0).margin(1e-6));
  CHECK(reading.log.height[100] == Approx(30));
  CHECK(reading.log.supply_voltage.empty());
  CHECK(says(reading, "no airspeed and no wind in the log: ground speed is taken as airspeed"));
}

TEST_CASE("the acceleration over ground is read along the airspeed and across it") {
  DataFlashWriter log;
  log.define(xkf1, "XKF1", "QBfffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,PD");
  log.define(bat, "BAT", "QBff", "TimeUS,Inst,Volt,Curr");
  log.define(xkf2, "XKF2", "QBff", "TimeUS,C,VWN,VWE");
  for (int i = 100; i < 1000; ++i) {
    const double t = 0.1 * i;
    // To the north at 2 m/s and ever faster by 0.1 m/s², in a wind of 3 m/s from the east.
    log.add(xkf1, {us(t), std::uint64_t{0}, 0.0, -5.0, 90.0, 2 + 0.1 * (t - 10), 0.0, 0.0, -130.0});
    log.add(xkf2, {us(t), std::uint64_t{0}, 0.0, -3.0});
  }
  add_battery(log, 0, 15.5, 20);
  const PowerLog power = read(log).log;
  REQUIRE(power.acceleration_along.size() == power.time.size());
  const auto at = static_cast<std::size_t>(std::ranges::lower_bound(power.time, 30 - 1e-6) -
                                           power.time.begin());
  CHECK(power.airspeed[at] == Approx(5));  // 4 and 3
  // Less what the chord over 0.4 s leaves out.
  CHECK(power.acceleration_along[at] == Approx(0.1 * 4 / 5).epsilon(1e-3));
  CHECK(power.acceleration_across[at] == Approx(0.1 * 3 / 5).epsilon(1e-3));
}

TEST_CASE("hundredths in a log of 2014 are read as volts and amperes") {
  DataFlashWriter log = flight();
  for (int i = 10; i < 300; ++i) {
    log.add(curr, {std::uint64_t(1000 * i), std::uint64_t{0}, std::int64_t{1574},
                   std::int64_t{1092}, std::int64_t{5000}});
  }
  const PowerLogReading reading = read(log);
  CHECK(all_are(reading.log.bus_voltage, 15.74));
  CHECK(all_are(reading.log.bus_current, 10.92));
}

TEST_CASE("of several monitors those that are chosen add up, and none is chosen silently") {
  DataFlashWriter log = flight();
  add_battery(log, 0, 16, 10);
  add_battery(log, 1, 15, 30, 0.4);  // on a clock of its own
  add_battery(log, 2, 5, 0);         // without a sensor of its current
  CHECK_THAT(refusal(log), Contains("2 battery monitors") && Contains("--battery 0,1") &&
                               Contains("0 is BAT 0 (mean 16.00 V, 10.00 A)") &&
                               Contains("1 is BAT 1 (mean 15.00 V, 30.00 A)"));
  CHECK(all_are(read(log, {.batteries = {1}}).log.bus_current, 30));
  const PowerLogReading both = read(log, {.batteries = {0, 1}});
  CHECK(both.source == "BAT 0 + BAT 1 and XKF1 of EKF core 0");
  CHECK(says(both, "the bus is BAT 0 and BAT 1, their currents added"));
  CHECK(all_are(both.log.bus_current, 40));
  CHECK(all_are(bus_power_of(both.log), 16 * 10 + 15 * 30));
  CHECK_THAT(refusal(log, {.batteries = {2}}),
             Contains("--battery: 2 is no battery monitor") && Contains("allowed are 0, 1"));
}

TEST_CASE("airspeed is measured, else ground speed less the estimator's wind") {
  DataFlashWriter log = flight();
  add_battery(log, 0, 16, 10);
  // Air that moves with 4 m/s to the north: what is left is 3 m/s.
  for (int i = 10; i < 300; ++i) log.add(xkf2, {us(i), std::uint64_t{0}, 4.0, 0.0});
  const PowerLogReading by_wind = read(log);
  CHECK(all_are(by_wind.log.airspeed, 3));
  CHECK(says(by_wind, "the wind that the estimator guesses (XKF2)"));
  for (int i = 100; i < 3000; ++i) log.add(arsp, {us(0.1 * i), i % 2 == 0 ? 7.0 : 7.2});
  const PowerLogReading measured = read(log);
  CHECK(measured.log.airspeed.front() == Approx(7).epsilon(1e-6));
  CHECK(says(measured, "the airspeed is that of ARSP"));
}

TEST_CASE("a log without current, flight or the right vehicle is refused with the reason") {
  CHECK_THAT(refusal(flight()), Contains("no voltage and no current in the log"));
  DataFlashWriter idle = flight();
  add_battery(idle, 0, 16, 0);
  CHECK_THAT(refusal(idle), Contains("no current in BAT 0") && Contains("BATT_MONITOR"));
  DataFlashWriter plane = flight();
  add_battery(plane, 0, 16, 10);
  plane.add(msg, {us(300), std::string("ArduPlane V4.5.7")});
  CHECK_THAT(refusal(plane), Contains("ArduPlane") && Contains("no multirotor"));
  DataFlashWriter before = flight();
  for (int i = 0; i < 5; ++i) before.add(bat, {us(i), std::uint64_t{0}, 16.0, 10.0});
  CHECK_THAT(refusal(before), Contains("tell nothing at the same time"));
}

TEST_CASE("what the log's summary says of the power is what the reader does") {
  DataFlashWriter log = flight();
  const auto use_of = [](const DataFlashWriter& asked) {
    const std::vector<std::byte> bytes(asked.bytes().begin(), asked.bytes().end());
    const LogSummary summary = summarize_log(AutopilotLog(bytes, "flight.bin"));
    return summary.uses.back();
  };
  CHECK(use_of(log).command == "diagnose --power");
  CHECK_FALSE(use_of(log).possible);
  CHECK_THAT(use_of(log).because, Contains("no voltage and no current"));
  DataFlashWriter constant = log;
  add_battery(constant, 0, 16, 10);
  CHECK_FALSE(use_of(constant).possible);
  CHECK_THAT(use_of(constant).because, Contains("the current never changes"));
  for (int i = 10; i < 300; ++i) log.add(bat, {us(i), std::uint64_t{0}, 16.0, 10 + 0.1 * (i % 3)});
  CHECK(use_of(log).possible);
  CHECK(use_of(log).because == "BAT 0 and XKF1 of EKF core 0");
}

TEST_CASE("what measures no battery is told in the words of the autopilot that flew") {
  ULogWriter log;
  log.information("sys_name", "PX4");
  test::define_flight_topics(log);
  for (int i = 0; i < 200; ++i) {
    test::add_local_position(log, us(1 + 0.1 * i), 6, 8, 0);
    test::add_attitude(log, us(1 + 0.1 * i), 1, 0, 0, 0);
  }
  const std::vector<std::byte> bytes(log.bytes().begin(), log.bytes().end());
  CHECK_THROWS_WITH(parse_power_log(bytes, "flight.ulg"),
                    Contains("BAT1_SOURCE") && !Contains("BATT_MONITOR"));
  CHECK_THAT(refusal(flight()), Contains("BATT_MONITOR") && !Contains("BAT1_SOURCE"));
}

TEST_CASE("PX4's battery_status is a bus, a current of -1 is none") {
  ULogWriter log;
  log.information("sys_name", "PX4");
  test::define_flight_topics(log);
  constexpr std::uint16_t battery_number = 7;
  log.format("battery_status:uint64_t timestamp;float voltage_v;float current_a;");
  log.subscribe(battery_number, "battery_status");
  for (int i = 0; i < 2000; ++i) {
    const double t = 1 + 0.1 * i;
    test::add_local_position(log, us(t), 6, 8, 0);
    test::add_attitude(log, us(t), 1, 0, 0, 0);
    if (i % 5 != 0) continue;
    ULogContent content;
    content.put(us(t)).put(22.5F).put(i < 500 ? -1.0F : 18.0F);
    log.data(battery_number, content);
  }
  const std::vector<std::byte> bytes(log.bytes().begin(), log.bytes().end());
  const PowerLogReading reading = parse_power_log(bytes, "flight.ulg", {.free_flight = true});
  CHECK(reading.log.time.size() == 300);
  CHECK(all_are(bus_power_of(reading.log), 22.5 * 18));
  CHECK(all_are(reading.log.airspeed, 10));
  CHECK(reading.log.height.empty());
  CHECK_THROWS_WITH(parse_power_log(bytes, "flight.ulg"), Contains("tells no height"));
}

TEST_CASE("the energy of real logs in flight is no more than that of their whole batteries") {
  for (const char* const name :
       {"data/real/delorean_00000017.bin", "data/real/sitl_delorean_00000002.bin",
        "data/real/dronekit_log171.bin"}) {
    const auto file = test::reference_file(name);
    if (!file) continue;
    INFO(name);
    const PowerLog log = read_power_log(*file).log;
    const std::vector<double> power = bus_power_of(log);
    REQUIRE(power.size() > 1000);
    double energy = 0;  // J, by trapezia
    for (std::size_t i = 1; i < power.size(); ++i) {
      energy += (power[i] + power[i - 1]) / 2 * (log.time[i] - log.time[i - 1]);
    }
    const std::vector<std::byte> bytes = [&] {
      std::ifstream in(*file, std::ios::binary);
      const std::string text((std::istreambuf_iterator<char>(in)), {});
      const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
      return std::vector<std::byte>(begin, begin + text.size());
    }();
    const LogSummary summary = summarize_log(AutopilotLog(bytes, name));
    CHECK(energy < 1.001 * *summary.batteries.front().energy);
    // Little is drawn on the ground.
    CHECK(energy > 0.9 * *summary.batteries.front().energy);
  }
}
