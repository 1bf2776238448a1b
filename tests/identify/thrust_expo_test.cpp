// MOT_THST_EXPO from rows whose curve is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "tethercalc/identify/thrust_expo.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

constexpr SpinRange range{0.1, 0.9};

/// `idle` + `rise`·((1 − e)·a + e·a²) over the whole output, in steps of 0.05.
std::vector<ThrottledThrust> rows_of(double expo, double idle, double rise) {
  std::vector<ThrottledThrust> rows;
  for (int i = 0; i <= 20; ++i) {
    const double output = 0.05 * i;
    const double a = (output - range.least) / (range.most - range.least);
    rows.push_back({output, idle + rise * ((1 - expo) * a + expo * a * a)});
  }
  return rows;
}

/// The output that ArduPilot chooses for a share of thrust: `thrust_to_actuator` of
/// AP_Motors_Thrust_Linearization.cpp, at the battery's full voltage.
double actuator_of(double thrust, double expo) {
  const double root = std::sqrt((1 - expo) * (1 - expo) + 4 * expo * thrust);
  return range.least + (range.most - range.least) * (expo - 1 + root) / (2 * expo);
}

}  // namespace

TEST_CASE("the bend of a curve without noise comes out exactly, whatever the motor idles at") {
  for (const double expo : {-0.4, 0.0, 0.3, 0.65, 1.0}) {
    for (const double idle : {0.0, 0.7}) {
      const ThrustExpo found = fit_thrust_expo(rows_of(expo, idle, 12), range);
      CHECK(found.expo.value == Approx(expo).margin(1e-12));
      CHECK(found.idle_thrust == Approx(idle).margin(1e-12));
      CHECK(found.full_thrust == Approx(idle + 12));
      CHECK(found.scatter < 1e-12);
      CHECK(found.rows == 17);  // from 0.1 to 0.9
    }
  }
}

TEST_CASE("with the value found ArduPilot's outputs make thrust rise in proportion") {
  const double expo = fit_thrust_expo(rows_of(0.45, 0.5, 9), range).expo.value;
  for (const double share : {0.1, 0.35, 0.8, 1.0}) {
    const double a = (actuator_of(share, expo) - range.least) / (range.most - range.least);
    CHECK((1 - 0.45) * a + 0.45 * a * a == Approx(share));
  }
}

TEST_CASE("the interval of the bend holds the truth in 95 of 100 benches with noise") {
  constexpr int benches = 2000;
  std::mt19937 engine(1);
  std::normal_distribution<double> noise(0, 0.2);  // N
  int held = 0;
  for (int i = 0; i < benches; ++i) {
    std::vector<ThrottledThrust> rows = rows_of(0.5, 0.4, 10);
    for (ThrottledThrust& row : rows) row.thrust += noise(engine);
    const Estimate expo = fit_thrust_expo(rows, range).expo;
    if (expo.lower <= 0.5 && 0.5 <= expo.upper) ++held;
  }
  // 3 standard deviations of the count are 1.5 %.
  CHECK(held > 0.935 * benches);
  CHECK(held < 0.965 * benches);
}

TEST_CASE("rows that can show no bend are refused") {
  std::vector<ThrottledThrust> few = rows_of(0.5, 0, 10);
  few.resize(6);  // four within the range
  CHECK_THROWS_WITH(fit_thrust_expo(few, range), Contains("4 rows lie between"));
  std::vector<ThrottledThrust> narrow = rows_of(0.5, 0, 10);
  narrow.resize(9);  // seven, up to an output of 0.4
  CHECK_THROWS_WITH(fit_thrust_expo(narrow, range), Contains("over 38 % of the way"));
  CHECK_THROWS_WITH(fit_thrust_expo(rows_of(0.5, 10, -5), range), Contains("does not rise"));
  CHECK_THROWS_WITH(fit_thrust_expo(rows_of(1.4, 0, 10), range), Contains("would be 1.4"));
  std::vector<ThrottledThrust> scattered = rows_of(0.5, 0, 10);
  for (std::size_t i = 0; i < scattered.size(); ++i) scattered[i].thrust += i % 2 == 0 ? 2 : -2;
  CHECK_THROWS_WITH(fit_thrust_expo(scattered, range), Contains("they scatter too much"));
}
