// Which samples of a flight log are taken for impossible ones.
#include "diagnose/flight_log_faults.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "support/random.hpp"

using namespace tethercalc;

namespace {

constexpr double rate = 10;  // Hz
constexpr int samples = 2000;
constexpr double noise = 0.02;

/// Slow motion with white noise, in every channel.
FlightLog noisy_flight(test::Random& random) {
  FlightLog log;
  const auto near = [&random](double value) {
    double sum = 0;  // of uniform ones about a normal one
    for (int i = 0; i < 12; ++i) sum += random.uniform(-0.5, 0.5);
    return value + noise * sum;
  };
  for (int i = 0; i < samples; ++i) {
    const double t = i / rate;
    log.time.push_back(t);
    log.roll.push_back(near(0.1 * std::sin(t)));
    log.pitch.push_back(near(-0.2 * std::cos(0.7 * t)));
    log.yaw.push_back(0);
    log.north_velocity.push_back(near(5 * std::sin(0.3 * t)));
    log.east_velocity.push_back(near(std::cos(0.3 * t)));
    log.down_velocity.push_back(near(0.5 * std::sin(0.1 * t)));
  }
  return log;
}

/// On straight lines between its samples, `faster` Hz.
FlightLog interpolated(const FlightLog& log, double faster) {
  FlightLog result;
  for (double t = 0; t < log.time.back(); t += 1 / faster) result.time.push_back(t);
  for (auto channel :
       {&FlightLog::roll, &FlightLog::pitch, &FlightLog::yaw, &FlightLog::north_velocity,
        &FlightLog::east_velocity, &FlightLog::down_velocity}) {
    for (const double t : result.time) {
      const auto i = std::min(static_cast<std::size_t>(t * rate), log.time.size() - 2);
      const double part = (t - log.time[i]) * rate;
      (result.*channel).push_back((1 - part) * (log.*channel)[i] + part * (log.*channel)[i + 1]);
    }
  }
  return result;
}

std::vector<std::size_t> spikes_in(FlightLog log) {
  const LogFaults faults = repair_flight_log(log, {0, log.time.size()});
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < faults.sample.size(); ++i) {
    if (faults.sample[i]) found.push_back(i);
  }
  return found;
}

}  // namespace

TEST_CASE("noise has no spikes as it was logged, and next to none interpolated to any rate") {
  test::each_random(3, [](test::Random& random) {
    const FlightLog log = noisy_flight(random);
    CHECK(spikes_in(log).empty());
    for (const double faster : {13.0, 20.0, 25.0, 50.0, 400.0, 1000.0}) {
      INFO(faster << " Hz");
      // At 13 Hz some samples lie on a line and others at its corners: the median that spikes are
      // held against is of both, and one of 25 logs of 2600 samples has a corner above it.
      CHECK(spikes_in(interpolated(log, faster)).size() <= (faster == 13 ? 1 : 0));
    }
  });
}

TEST_CASE("single wrong readings are found, where they are, up to one in forty") {
  test::each_random(10, [](test::Random& random) {
    FlightLog log = noisy_flight(random);
    std::set<std::size_t> wrong;
    for (std::size_t i = 10; i + 10 < log.time.size(); i += 40) {
      const auto at = i + static_cast<std::size_t>(random.integer(0, 9));
      wrong.insert(at);
      log.roll[at] += (random.chance(0.5) ? 1 : -1) * random.uniform(1, 3);
    }
    const std::vector<std::size_t> found = spikes_in(log);
    CHECK(std::set(found.begin(), found.end()) == wrong);
  });
}
