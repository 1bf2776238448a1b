// Flight logs from DataFlash: which estimator, which core, which samples.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/longest_increasing.hpp"
#include "support/dataflash_writer.hpp"
#include "support/random.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;
using test::DataFlashWriter;

namespace {

FlightLogReading read(const DataFlashWriter& log, int core = 0) {
  return parse_flight_log(log.bytes(), "flight.bin", {.core = core});
}

}  // namespace

TEST_CASE("XKF1 of the wanted core comes out in seconds, radians and metres a second") {
  DataFlashWriter log;
  test::define_xkf1(log);
  for (int core = 0; core < 2; ++core) {
    test::add_xkf1(log, core, {1'500'000, 1234, -4500, 9000, 1.5 + core, -2.5, 0.25});
  }
  const FlightLogReading reading = read(log, 1);
  CHECK(reading.source == "XKF1 of EKF core 1");
  CHECK(reading.log.time == std::vector<double>{1.5});
  CHECK(reading.log.roll == std::vector<double>{12.34 * unit::degree});
  CHECK(reading.log.pitch == std::vector<double>{-45 * unit::degree});
  CHECK(reading.log.yaw == std::vector<double>{90 * unit::degree});
  CHECK(reading.log.north_velocity == std::vector<double>{2.5});
  CHECK(reading.log.east_velocity == std::vector<double>{-2.5});
  CHECK(reading.log.down_velocity == std::vector<double>{0.25});
}

TEST_CASE("a log says what flew by its firmware, where that is no multirotor") {
  const auto flown_by = [](const std::string& firmware) {
    DataFlashWriter log;
    test::define_xkf1(log);
    log.define(7, "MSG", "QZ", "TimeUS,Message");
    log.add(7, {std::uint64_t{1}, std::string("Barometer calibrated")});
    log.add(7, {std::uint64_t{2}, firmware});
    test::add_xkf1(log, 0, {1'500'000, 0, 0, 0, 1, 0, 0});
    return read(log).log.other_vehicle;
  };
  CHECK(flown_by("ArduPlane V3.1.2beta1 (834f90e8)") ==
        "ArduPlane V3.1.2beta1 (834f90e8), an aeroplane");
  CHECK(flown_by("APM:Rover v3.1.0 (a3ae3192)") == "APM:Rover v3.1.0 (a3ae3192), a rover");
  CHECK(flown_by("ArduCopter V4.6.3 (fa4f2044)").empty());
  CHECK(flown_by("APM:Copter V3.3-dev (ae3192b8)").empty());
}

TEST_CASE("older logs are read from NKF1, NKF6 for core 1, and EKF1, in their time base") {
  const std::string old_labels = "Roll,Pitch,Yaw,VN,VE,VD";
  const auto estimate = [](test::LoggedValue time, double vn) {
    return std::vector<test::LoggedValue>{
        time, std::int64_t{0}, std::int64_t{0}, std::int64_t{0}, vn, 0.0, 0.0};
  };
  DataFlashWriter log;
  log.define(30, "EKF1", "IccCfff", "TimeMS," + old_labels);
  log.add(30, estimate(std::uint64_t{2500}, 1));
  CHECK(read(log).source == "EKF1");
  CHECK(read(log).log.time == std::vector<double>{2.5});
  CHECK_THROWS_WITH(read(log, 1), Catch::Contains("no EKF core 1"));

  log.define(31, "NKF1", "QccCfff", "TimeUS," + old_labels);
  log.define(32, "NKF6", "QccCfff", "TimeUS," + old_labels);
  log.add(31, estimate(std::uint64_t{2'500'000}, 2));
  log.add(32, estimate(std::uint64_t{2'500'000}, 3));
  CHECK(read(log).log.north_velocity == std::vector<double>{2});
  CHECK(read(log, 1).log.north_velocity == std::vector<double>{3});
  CHECK(read(log, 1).source == "NKF6");

  test::define_xkf1(log);
  test::add_xkf1(log, 0, {.time_us = 2'500'000, .vn = 4});
  CHECK(read(log).log.north_velocity == std::vector<double>{4});
}

TEST_CASE("a core that is not there is refused with those that are") {
  DataFlashWriter log;
  test::define_xkf1(log);
  for (const int core : {0, 2}) test::add_xkf1(log, core, {.time_us = 1});
  CHECK_THROWS_WITH(read(log, 1), Catch::Contains("no EKF core 1") && Catch::Contains("0, 2"));
  CHECK_THROWS_AS(read(log, -1), InputError);
}

TEST_CASE("a log without an estimator, and bytes that are no log, are refused") {
  DataFlashWriter log;
  log.define(12, "EV", "QB", "TimeUS,Id");
  log.add(12, {std::uint64_t{1}, std::int64_t{10}});
  CHECK_THROWS_WITH(read(log), Catch::Contains("XKF1, NKF1 or EKF1"));
  const std::vector<std::byte> zeros(1000);
  CHECK_THROWS_WITH(
      parse_flight_log(zeros, "x.bin", {}),
      Catch::Contains("is no log: no message of ArduPilot or PX4 was found in its 1000 bytes"));
}

TEST_CASE("yaw turns on through north, both ways, and stays the same direction") {
  std::mt19937_64 random(test::run_seed());
  std::uniform_real_distribution<double> step(-170, 170);
  DataFlashWriter log;
  test::define_xkf1(log);
  double heading = 10;
  std::vector<double> headings;
  for (std::uint64_t i = 0; i < 500; ++i) {
    headings.push_back(std::round(heading * 100) / 100);
    const double wrapped = headings.back() - 360 * std::floor(headings.back() / 360);
    test::add_xkf1(log, 0, {.time_us = i, .yaw_cdeg = std::lround(wrapped * 100)});
    heading += step(random);
  }
  const FlightLog flight = read(log).log;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    REQUIRE(flight.yaw[i] == Approx(headings[i] * unit::degree).margin(1e-10));
  }
}

TEST_CASE("samples whose time is wrong are left out one by one, and counted") {
  DataFlashWriter log;
  test::define_xkf1(log);
  for (std::uint64_t i = 1; i <= 100; ++i) {
    const std::uint64_t time = i == 20 ? 5000 : i == 50 ? 3 : i == 70 ? 69 : i;
    test::add_xkf1(log, 0, {.time_us = time, .vn = static_cast<double>(i)});
  }
  const FlightLogReading reading = read(log);
  CHECK(reading.samples_out_of_order == 3);
  REQUIRE(reading.log.time.size() == 97);
  CHECK(reading.notes.size() == 1);
  for (std::size_t i = 1; i < 97; ++i) REQUIRE(reading.log.time[i] > reading.log.time[i - 1]);
  CHECK(reading.log.north_velocity.back() == 100);
}

TEST_CASE("samples with values that no flight can have are left out, and counted") {
  DataFlashWriter log;
  test::define_xkf1(log);
  test::add_xkf1(log, 0, {.time_us = 1});
  test::add_xkf1(log, 0, {.time_us = 2, .vn = std::nan("")});
  test::add_xkf1(log, 0, {.time_us = 3, .ve = 1e30});
  test::add_xkf1(log, 0, {.time_us = 4, .pitch_cdeg = 9100});
  test::add_xkf1(log, 0, {.time_us = 5});
  const FlightLogReading reading = read(log);
  CHECK(reading.samples_implausible == 3);
  CHECK(reading.log.time == std::vector<double>{1e-6, 5e-6});
}

TEST_CASE("the longest increasing choice is as long as the best of all choices") {
  std::mt19937_64 random(test::run_seed());
  for (int round = 0; round < 500; ++round) {
    std::vector<double> values(std::uniform_int_distribution<std::size_t>(0, 10)(random));
    for (double& value : values) value = std::uniform_int_distribution<int>(0, 12)(random);
    std::size_t best = 0;
    for (unsigned choice = 0; choice < (1U << values.size()); ++choice) {
      std::vector<double> chosen;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if ((choice >> i & 1U) != 0) chosen.push_back(values[i]);
      }
      const bool increasing =
          std::adjacent_find(chosen.begin(), chosen.end(), std::greater_equal<>()) == chosen.end();
      if (increasing) best = std::max(best, chosen.size());
    }
    const auto kept = longest_increasing(values);
    REQUIRE(kept.size() == best);
    for (std::size_t i = 1; i < kept.size(); ++i) {
      REQUIRE(kept[i] > kept[i - 1]);
      REQUIRE(values[kept[i]] > values[kept[i - 1]]);
    }
  }
}
