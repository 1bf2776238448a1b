// From a log to the stabilised frame: signs, derivatives, gaps and the choice of a range.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "support/random.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/identify/observations.hpp"

using namespace tethercalc;

namespace {

constexpr double rounding = 1e-9;  // of differences of numbers near 1 over steps of 0.1 s

/// Level, still, heading north, 10 Hz.
FlightLog still_log(std::size_t size) {
  FlightLog log;
  for (std::size_t i = 0; i < size; ++i) log.time.push_back(100 + 0.1 * static_cast<double>(i));
  const std::vector<double> zeros(size, 0.0);
  log.roll = log.pitch = log.yaw = zeros;
  log.north_velocity = log.east_velocity = log.down_velocity = zeros;
  return log;
}

SampleRange whole(const FlightLog& log) { return {0, log.time.size()}; }

template <typename Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const UnsuitableFlight& error) {
    return error.what();
  }
  return "no exception";
}

}  // namespace

TEST_CASE("a nose-down drone is expected to accelerate forward") {
  FlightLog log = still_log(20);
  for (double& pitch : log.pitch) pitch = -0.2;
  const Observations o = observe(log, whole(log), 0, 9.81);
  CHECK(o.tilt[7] == Approx(0.2));
  CHECK(o.expected_acceleration[7] == Approx(9.81 * std::tan(0.2)));
}

TEST_CASE("climbing harder raises the thrust and with it the expected acceleration, rolling not") {
  FlightLog log = still_log(20);
  for (std::size_t i = 0; i < 20; ++i) {
    log.pitch[i] = 0.1;
    log.roll[i] = -0.3;
    log.down_velocity[i] = -2 * (log.time[i] - log.time[0]);  // accelerating upward
  }
  const Observations o = observe(log, whole(log), 0, 9.81);
  CHECK(o.down_acceleration[3] == Approx(-2));
  // For yaw, pitch, roll in this order the thrust's direction is (tan θ, tan φ/cos θ, 1) up to its
  // size; the published formula has 1/cos φ beside.
  CHECK(o.expected_acceleration[3] == Approx(-(9.81 + 2) * std::tan(0.1)));
  const Observations published = observe(log, whole(log), 0, 9.81, Kinematics::published);
  CHECK(published.expected_acceleration[3] == Approx(-(9.81 + 2) * std::tan(0.1) / std::cos(0.3)));
}

TEST_CASE("what a turning frame carries from one speed into the other is no drag") {
  // Straight north at 5 m/s while the yaw turns: no force acts.
  FlightLog log = still_log(40);
  for (std::size_t i = 0; i < 40; ++i) {
    log.yaw[i] = 0.4 * (log.time[i] - log.time[0]);
    log.north_velocity[i] = 5;
  }
  const Observations exact = observe(log, whole(log), 0);
  const std::vector<double> drag = forward_drag_over_mass(exact);
  // Second differences of a sine at 0.1 s: (0.04)²/6 of the 2 m/s² of the turn, 5e-4.
  for (std::size_t i = 1; i + 1 < drag.size(); ++i) CHECK(drag[i] == Approx(0).margin(1e-3));
  const Observations published = observe(log, whole(log), 0, 9.81, Kinematics::published);
  CHECK(std::abs(forward_drag_over_mass(published)[30]) > 0.5);
}

TEST_CASE("the pitch offset is what a level drone reads") {
  FlightLog log = still_log(20);
  for (double& pitch : log.pitch) pitch = 0.026;
  const Observations o = observe(log, whole(log), pitch_offset_from_hover(log));
  for (double tilt : o.tilt) CHECK(tilt == Approx(0).margin(rounding));
}

TEST_CASE("a drag flight is no hover to take the pitch offset from") {
  FlightLog log = still_log(100);
  for (std::size_t i = 0; i < 15; ++i) log.north_velocity[i] = 6;  // on the way to its place
  CHECK(pitch_offset_from_hover(log) == 0);
  for (std::size_t i = 0; i < 30; ++i) log.north_velocity[i] = -6;
  CHECK(refusal_of([&] { (void)pitch_offset_from_hover(log); }).find("more than 6.0 m/s") !=
        std::string::npos);
}

TEST_CASE("speeds turn with the yaw") {
  FlightLog log = still_log(20);
  for (std::size_t i = 0; i < 20; ++i) {
    log.yaw[i] = 0.3 * static_cast<double>(i);
    log.north_velocity[i] = 5 * std::cos(log.yaw[i]) - 2 * std::sin(log.yaw[i]);
    log.east_velocity[i] = 5 * std::sin(log.yaw[i]) + 2 * std::cos(log.yaw[i]);
  }
  const Observations o = observe(log, whole(log), 0);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(o.forward_speed[i] == Approx(5));
    CHECK(o.right_speed[i] == Approx(2));
  }
  // Of the published kinematics the acceleration is that of the forward speed, turned or not.
  const Observations published =
      observe(log, whole(log), 0, standard_gravity, Kinematics::published);
  for (const double a : published.forward_acceleration) CHECK(a == Approx(0).margin(rounding));
}

TEST_CASE("what goes on straight accelerates nowhere, however its nose turns") {
  FlightLog log = still_log(20);
  std::mt19937_64 random(test::run_seed());
  for (std::size_t i = 0; i < 20; ++i) {
    log.yaw[i] = std::uniform_real_distribution<double>(-3, 3)(random);
    log.north_velocity[i] = 5;
    log.east_velocity[i] = -2;
  }
  const Observations o = observe(log, whole(log), 0);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(o.forward_acceleration[i] == Approx(0).margin(rounding));
    CHECK(o.right_acceleration[i] == Approx(0).margin(rounding));
  }
}

TEST_CASE("accelerations of a parabola are exact at uneven times, and one-sided at the ends") {
  std::mt19937_64 random(test::run_seed());
  std::uniform_real_distribution<double> jitter(-0.03, 0.03);
  FlightLog log = still_log(50);
  for (double& t : log.time) t += jitter(random);
  for (std::size_t i = 0; i < 50; ++i) {
    log.north_velocity[i] = 3 * (log.time[i] - 102) * (log.time[i] - 102);
  }
  const Observations o = observe(log, whole(log), 0);
  for (std::size_t i = 1; i + 1 < 50; ++i) {
    CHECK(o.forward_acceleration[i] == Approx(6 * (log.time[i] - 102)).margin(rounding));
  }
  const double first_slope =
      (log.north_velocity[1] - log.north_velocity[0]) / (log.time[1] - log.time[0]);
  CHECK(o.forward_acceleration[0] == Approx(first_slope));
}

TEST_CASE("a bound of the range is not an edge for the derivative") {
  const FlightLog log = test::simulate({});
  const Observations all = observe(log, whole(log), 0);
  const SampleRange part{700, 900};
  const Observations some = observe(log, part, 0);
  REQUIRE(some.size() == part.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    CHECK(some.forward_acceleration[i] == all.forward_acceleration[part.first + i]);
    CHECK(some.expected_acceleration[i] == all.expected_acceleration[part.first + i]);
  }
}

TEST_CASE("nothing is differentiated across a gap") {
  FlightLog log = still_log(30);
  for (std::size_t i = 0; i < 30; ++i) {
    if (i >= 15) log.time[i] += 5;
    // Faster by 8 m/s after the gap, at the same acceleration of 1 m/s².
    log.north_velocity[i] = 0.1 * static_cast<double>(i) + (i >= 15 ? 8 : 0);
  }
  const Observations o = observe(log, whole(log), 0);
  REQUIRE(o.size() == 30);
  for (double a : o.forward_acceleration) CHECK(a == Approx(1));

  // A sample alone between two gaps has no derivative.
  for (std::size_t i = 16; i < 30; ++i) log.time[i] += 5;
  CHECK(observe(log, whole(log), 0).size() == 29);
}

TEST_CASE("ranges are half-open in samples and closed in seconds") {
  const FlightLog log = still_log(101);  // 100.0 s to 110.0 s
  CHECK(range_in_seconds(log, 101.95, 103.05) == SampleRange{20, 31});
  CHECK(range_in_seconds(log, -std::numeric_limits<double>::infinity(), 100.05) ==
        SampleRange{0, 1});
  CHECK(range_in_percent(log, 25, 90) == SampleRange{25, 90});
  CHECK(range_in_percent(log, 0, 100) == whole(log));
  CHECK_THROWS_AS(range_in_seconds(log, 111, 120), UnsuitableFlight);
  CHECK_THROWS_AS(range_in_seconds(log, 105, 103), UnsuitableFlight);
  CHECK_THROWS_AS(range_in_percent(log, 90, 25), UnsuitableFlight);
  CHECK_THROWS_AS(range_in_percent(log, 10, 101), UnsuitableFlight);
  CHECK_THROWS_AS(range_in_percent(log, std::nan(""), 50), UnsuitableFlight);
}

TEST_CASE("bounds in different units, or only one, select a range too") {
  const FlightLog log = still_log(101);
  CHECK(select_range(log, LogPosition{25, true}, LogPosition{103.05, false}) ==
        SampleRange{25, 31});
  CHECK(select_range(log, LogPosition{104.95, false}, std::nullopt) == SampleRange{50, 101});
  CHECK(select_range(log, std::nullopt, LogPosition{10, true}) == SampleRange{0, 10});
  CHECK_THROWS_AS(select_range(log, LogPosition{50, true}, LogPosition{101, false}),
                  UnsuitableFlight);
}

TEST_CASE("the moving part leaves out the time on the ground") {
  test::SimulatedFlight flown;
  flown.idle = 60;
  flown.duration = 120;
  const FlightLog log = test::simulate(flown);
  const SampleRange part = moving_part(log);
  CHECK(log.time[part.first] == Approx(65).margin(2));
  CHECK(log.time[part.last - 1] == Approx(179).margin(6));  // comes to rest from 173 s on
}

TEST_CASE("a drone that flies to the side moves") {
  FlightLog log = still_log(2000);
  for (std::size_t i = 300; i < 1500; ++i) {
    log.yaw[i] = 0.01 * static_cast<double>(i);
    log.north_velocity[i] = 5 * std::sin(log.yaw[i]);
    log.east_velocity[i] = -5 * std::cos(log.yaw[i]);
  }
  CHECK(moving_part(log) == SampleRange{300, 1500});
}

TEST_CASE("a long pause splits the flight and the longer part is taken") {
  FlightLog log = still_log(2000);
  const auto fly = [&log](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) log.north_velocity[i] = (i / 50) % 2 == 0 ? 5 : -5;
  };
  fly(100, 400);
  fly(800, 1000);   // 40 s later: another part
  fly(1200, 1500);  // 20 s later: the same part
  CHECK(moving_part(log) == SampleRange{800, 1500});
}

TEST_CASE("a drone that only hovers has no moving part") {
  CHECK(refusal_of([] { (void)moving_part(still_log(500)); }).find("never flies at") !=
        std::string::npos);
}

TEST_CASE("an invalid log is named with its sample") {
  FlightLog log = still_log(20);
  log.time[12] = log.time[11];
  CHECK(refusal_of([&] { validate(log); }).find("sample 13") != std::string::npos);
  log = still_log(20);
  log.yaw[4] = std::nan("");
  CHECK(refusal_of([&] { validate(log); }) ==
        "sample 5 of the flight log has a yaw that is not a number");
  log = still_log(20);
  log.pitch.pop_back();
  CHECK(refusal_of([&] { validate(log); }) == "the flight log has 19 values of pitch for 20 times");
  CHECK_THROWS_AS(validate(still_log(2)), UnsuitableFlight);
  CHECK_THROWS_AS(observe(still_log(20), SampleRange{5, 21}, 0), UnsuitableFlight);
  CHECK_THROWS_AS(observe(still_log(20), SampleRange{5, 5}, 0), UnsuitableFlight);
}

TEST_CASE("a tumbling drone is told apart from flight, with its time") {
  FlightLog log = still_log(20);
  log.roll[10] = 2.8;
  CHECK(refusal_of([&] { (void)observe(log, whole(log), 0); }).find("at 101.000 s") !=
        std::string::npos);
  CHECK(observe(log, {0, 10}, 0).size() == 10);
}

TEST_CASE("a log of something else than a multirotor is refused by its name") {
  FlightLog log = still_log(20);
  log.other_vehicle = "ArduPlane V3.1.2, an aeroplane";
  CHECK(refusal_of([&] { validate(log); }).find("ArduPlane V3.1.2, an aeroplane") !=
        std::string::npos);
}

TEST_CASE("velocities that no multirotor flies are refused, one flipped bit among many is not") {
  FlightLog log = still_log(200);
  log.down_velocity[150] = 400;
  CHECK_NOTHROW(observe(log, whole(log), 0));
  for (std::size_t i = 150; i < 200; ++i) log.down_velocity[i] = 201 + static_cast<double>(i);
  CHECK(refusal_of([&] { (void)observe(log, whole(log), 0); }).find("400 m/s of it downward") !=
        std::string::npos);
  CHECK_NOTHROW(observe(log, {0, 149}, 0));
}
