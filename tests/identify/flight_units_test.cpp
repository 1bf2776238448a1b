#include "identify/flight_units.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "support/random.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;

namespace {

constexpr double gravity = 9.80665;
constexpr double quarter = std::numbers::pi / 2;

/// What a drone of the simplest kind does: 150 s of leaning about in both axes, in wind.
struct Flown {
  double yaw_rate = 0.05;       ///< rad/s
  double mean_lean = 0;         ///< rad forward
  double carried_by_wings = 0;  ///< rad of lean that needs no thrust forward
  double wind_north = 0;        ///< m/s
  double drag = 0.3;            ///< 1/s, over airspeed
  double heave = 0;             ///< m/s up and down
};

FlightLog flown(test::Random& random, const Flown& how) {
  FlightLog log;
  const double phase = random.uniform(0, 6);
  double north = 0;
  double east = 0;
  constexpr double step = 0.01;
  for (int k = 0; k < 15000; ++k) {
    const double t = k * step;
    const double yaw = 0.4 + how.yaw_rate * t;
    const double ahead = how.mean_lean + 0.1 * std::sin(0.9 * t + phase);
    const double aside = 0.1 * std::sin(0.7 * t + 2 * phase);
    if (k % 10 == 0) {
      log.time.push_back(t);
      log.pitch.push_back(-ahead);
      log.roll.push_back(aside);
      log.yaw.push_back(yaw);
      log.north_velocity.push_back(north);
      log.east_velocity.push_back(east);
      log.down_velocity.push_back(0.1 * std::sin(0.2 * t) + how.heave * std::sin(1.3 * t));
    }
    const double lift = gravity - how.heave * 1.3 * std::cos(1.3 * t);
    const double forward = lift * std::tan(ahead + how.carried_by_wings);
    const double right = lift * std::tan(aside) / std::cos(ahead);
    north += step * (forward * std::cos(yaw) - right * std::sin(yaw) -
                     how.drag * (north - how.wind_north));
    east += step * (forward * std::sin(yaw) + right * std::cos(yaw) - how.drag * east);
  }
  return log;
}

std::string refusal(const FlightLog& log) {
  try {
    check_flight_units(observe(log, {0, log.time.size()}, 0, gravity), gravity);
  } catch (const UnsuitableFlight& refused) {
    return refused.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a flight whose north and east or yaw mean something else is refused by that name") {
  test::Random random(test::run_seed());
  for (const double yaw_rate : {0.05, -0.1, 0.3}) {
    const FlightLog right = flown(random, {.yaw_rate = yaw_rate});
    CHECK(refusal(right).empty());
    FlightLog wrong = right;
    std::swap(wrong.north_velocity, wrong.east_velocity);
    CHECK_THAT(refusal(wrong), Catch::Contains("north and east velocities were exchanged"));
    const auto with_yaw = [&](auto change) {
      FlightLog log = right;
      for (double& yaw : log.yaw) yaw = change(yaw);
      return refusal(log);
    };
    CHECK_THAT(with_yaw([](double yaw) { return -yaw; }),
               Catch::Contains("counted the other way round"));
    CHECK_THAT(with_yaw([](double yaw) { return quarter - yaw; }),
               Catch::Contains("counted from east, counterclockwise"));
    CHECK_THAT(with_yaw([](double yaw) { return yaw - quarter; }),
               Catch::Contains("a quarter turn more"));
    CHECK_THAT(with_yaw([](double yaw) { return yaw + quarter; }),
               Catch::Contains("a quarter turn less"));
    CHECK_THAT(with_yaw([](double yaw) { return yaw + 2 * quarter; }),
               Catch::Contains("half a turn off"));
    CHECK_THAT(with_yaw([](double yaw) { return yaw * unit::degree; }),
               Catch::Contains("the yaw were in radians"));
    CHECK(with_yaw([](double yaw) { return yaw + 0.3; }).empty());
  }
}

TEST_CASE("a drone on the ground is asked whether it flies, one that flies for its angles' unit") {
  test::Random random(test::run_seed());
  FlightLog log = flown(random, {.yaw_rate = 0.1});
  for (double& pitch : log.pitch) pitch *= unit::degree;
  CHECK_THAT(refusal(log), Catch::Contains("are the angles in radians?"));
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    log.pitch[i] = log.roll[i] = 0.001 * random.uniform(-1, 1);
    for (auto* velocity : {&log.north_velocity, &log.east_velocity}) {
      (*velocity)[i] = 0.1 * random.uniform(-1, 1);
    }
  }
  CHECK_THAT(refusal(log), Catch::Contains("is it in the air here?"));
}

TEST_CASE("a down velocity that is positive upwards is refused where the drone goes up and down") {
  test::Random random(test::run_seed());
  FlightLog log = flown(random, {.heave = 1});
  CHECK(refusal(log).empty());
  for (double& down : log.down_velocity) down = -down;
  CHECK_THAT(refusal(log), Catch::Contains("down velocity must be positive downwards"));
}

TEST_CASE("a flight whose roll, angles or axes mean something else is refused by that name") {
  test::Random random(test::run_seed());
  for (const double yaw_rate : {0.05, -0.1, 0.3}) {
    const FlightLog right = flown(random, {.yaw_rate = yaw_rate});
    FlightLog exchanged = right;
    std::swap(exchanged.pitch, exchanged.roll);
    CHECK_THAT(refusal(exchanged), Catch::Contains("pitch and roll were exchanged"));
    FlightLog mirrored = right;
    for (double& roll : mirrored.roll) roll = -roll;
    CHECK_THAT(refusal(mirrored), Catch::Contains("the roll were positive left side down"));
    // x east, y north, yaw from east: forward stays forward, and right is left.
    FlightLog east_north_up = right;
    std::swap(east_north_up.north_velocity, east_north_up.east_velocity);
    for (double& yaw : east_north_up.yaw) yaw = quarter - yaw;
    CHECK_THAT(refusal(east_north_up), Catch::Contains("the axes were east and north"));
    FlightLog of_body = right;
    for (std::size_t i = 0; i < right.time.size(); ++i) {
      const double c = std::cos(right.yaw[i]);
      const double s = std::sin(right.yaw[i]);
      of_body.north_velocity[i] = right.north_velocity[i] * c + right.east_velocity[i] * s;
      of_body.east_velocity[i] = right.east_velocity[i] * c - right.north_velocity[i] * s;
    }
    CHECK_THAT(refusal(of_body), Catch::Contains("along the drone's own axes"));
  }
}

TEST_CASE("a heading is off from where a drone leans by what its yaw is off") {
  test::Random random(test::run_seed());
  for (const double off : {-0.9, -0.3, 0.0, 0.5, 1.1}) {
    FlightLog log = flown(random, {});
    for (double& yaw : log.yaw) yaw += off;
    // 125.7 s are one turn and four beats of the two leans, which else do not average out.
    const Observations flight = observe(log, {0, 1257}, 0, gravity);
    // Drag lags behind the lean, half a degree here.
    CHECK(heading_from_leaning(flight, gravity) == Approx(off).margin(0.03));
  }
}

TEST_CASE("what keeps its speed nose-up on all headings is refused, a drone in wind is not") {
  test::Random random(test::run_seed());
  const Flown fast{.yaw_rate = 0.15, .mean_lean = 0.35};
  CHECK(refusal(flown(random, fast)).empty());
  for (const double wind : {4.0, 8.0}) {
    Flown windy = fast;
    windy.wind_north = wind;
    CHECK(refusal(flown(random, windy)).empty());
  }
  Flown wings = fast;
  wings.mean_lean = -0.06;
  wings.carried_by_wings = 0.45;
  CHECK_THAT(refusal(flown(random, wings)), Catch::Contains("did wings carry it?"));
}
