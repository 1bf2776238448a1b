// Stamps that are off, and samples that were taken unevenly: which is which, the velocities say.
#include "diagnose/flight_clock.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"

using namespace tethercalc;

namespace {

struct Stamped {
  double step = 0.1;            ///< s
  double late_stamps = 0;       ///< s at most, of stamps alone
  double late_samples = 0;      ///< s at most, of samples, as their stamps say
  double lost = 0;              ///< part of the rows
  double gap = 0;               ///< s
  std::vector<double> taken{};  ///< s, when each sample really was
};

/// To and fro at up to 8 m/s, known to 4 mm/s.
FlightLog flown(test::Random& random, Stamped& stamped) {
  FlightLog log;
  for (int i = 0; i < 1500; ++i) {
    const double even = 20 + stamped.step * i;
    const double late = stamped.late_samples * random.uniform(-1, 1);
    const double stamp = even + late + stamped.late_stamps * random.uniform(-1, 1);
    const bool in_gap = i > 600 && stamped.step * (i - 600) < stamped.gap;
    if (in_gap || random.chance(stamped.lost)) continue;
    const double taken = even + late;
    stamped.taken.push_back(taken);
    log.time.push_back(stamp);
    const auto speed = [&](double phase) {
      return 8 * std::sin(0.6 * taken + phase) + 0.004 * random.uniform(-1.7, 1.7);
    };
    log.north_velocity.push_back(speed(0));
    log.east_velocity.push_back(speed(1));
  }
  return log;
}

}  // namespace

TEST_CASE("stamps that jitter around even samples are set to when these were taken") {
  test::each_random(10, [](test::Random& random) {
    Stamped stamped;
    stamped.step = random.uniform(0.06, 0.2);
    stamped.late_stamps = random.uniform(0.05, 0.3) * stamped.step;
    stamped.lost = random.chance(0.5) ? 0.05 : 0;
    stamped.gap = random.chance(0.5) ? 3 : 0;
    FlightLog log = flown(random, stamped);
    const auto jitter = clock_jitter(log);
    REQUIRE(jitter);
    CHECK(jitter->rms == Approx(stamped.late_stamps / std::sqrt(3)).epsilon(0.1));
    CHECK(jitter->step == Approx(stamped.step).epsilon(0.02));
    CHECK(std::abs(jitter->shown) < 5 * jitter->shown_se + 0.02);
    REQUIRE(even_out_stamps(log));
    for (std::size_t i = 0; i < log.time.size(); ++i) {
      CHECK(std::abs(log.time[i] - stamped.taken[i]) < 0.25 * stamped.late_stamps);
    }
  });
}

TEST_CASE("samples that were taken when their stamps say keep them") {
  test::each_random(10, [](test::Random& random) {
    Stamped stamped;
    stamped.late_samples = random.uniform(0.05, 0.3) * stamped.step;
    FlightLog log = flown(random, stamped);
    const std::vector<double> stamps = log.time;
    const auto jitter = clock_jitter(log);
    REQUIRE(jitter);
    CHECK(jitter->shown == Approx(1).margin(5 * jitter->shown_se + 0.02));
    CHECK_FALSE(even_out_stamps(log));
    CHECK(log.time == stamps);
  });
}

TEST_CASE("where no velocity changes, or stamps are even, nothing is done to them") {
  test::Random random(test::run_seed());
  Stamped still{.late_stamps = 0.015};
  FlightLog log = flown(random, still);
  for (auto* v : {&log.north_velocity, &log.east_velocity}) {
    for (double& x : *v) x = 0.004 * random.uniform(-1, 1);
  }
  CHECK_FALSE(even_out_stamps(log));
  Stamped even{.late_stamps = 0.001};
  log = flown(random, even);
  CHECK_FALSE(even_out_stamps(log));
  log.time.resize(20);
  CHECK_FALSE(clock_jitter(log));
}
