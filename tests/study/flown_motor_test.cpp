// A motor out of free flights simulated here, with correlated noise around a known power.
#include "tethercalc/study/flown_motor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/random.hpp"
#include "tethercalc/io/library.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

constexpr double air_density = 1.2;

Design quadrotor() {
  Design design;
  design.drone.mass = 1.6;
  design.drone.motor_count = 4;
  design.drone.drag = {0.015, 0.014, 19, 0};
  design.flight.air_density = air_density;
  return design;
}

constexpr double max_thrust = 12;  // N

/// Hover at `hover_power` W in all, then as long at 10 m/s with `forward_power`; each row's noise
/// is 0.9 of the one before it and a new part.
PowerLog flight_of(double hover_power, double forward_power, double noise, std::mt19937_64& dice) {
  PowerLog out;
  std::normal_distribution<double> fresh;
  double error = 0;
  for (int i = 0; i < 1200; ++i) {
    error = 0.9 * error + noise * fresh(dice);
    const bool hover = i < 600;
    out.time.push_back(0.2 * i);
    out.airspeed.push_back(hover ? 0.2 : 10);
    out.bus_power.push_back((hover ? hover_power : forward_power) * (1 + error));
  }
  return out;
}

/// Thrust of one motor at `airspeed`, by bisection of the balance of forces.
double thrust_flown(const Design& design, double airspeed) {
  const Drone& drone = design.drone;
  const double weight = drone.mass * design.flight.gravity;
  double lo = 0;
  double hi = 1.5;
  for (int i = 0; i < 100; ++i) {
    const double tilt = (lo + hi) / 2;
    const double drag =
        0.5 * air_density *
        (drone.drag.front_area * std::cos(tilt) + drone.drag.top_area * std::sin(tilt)) * airspeed *
        (airspeed + drone.drag.linear_speed);
    (drag > weight * std::tan(tilt) ? lo : hi) = tilt;
  }
  return weight / std::cos(lo) / drone.motor_count;
}

}  // namespace

TEST_CASE("a hover gives its point of the curve, and momentum theory the rest") {
  std::mt19937_64 dice(1);
  const Design design = quadrotor();
  const FlownMotor motor =
      flown_motor(flight_of(400, 400, 0, dice), design, max_thrust, library_motors());
  const double thrust = 1.6 * 9.80665 / 4;
  CHECK(motor.hover_thrust == Approx(thrust));
  CHECK(motor.hover_power == Approx(100));
  CHECK(motor.curve.power(thrust) == Approx(100).epsilon(1e-3));
  CHECK(motor.curve.power(2 * thrust) == Approx(100 * std::pow(2, 1.5)).epsilon(1e-3));
  CHECK(motor.curve.max_thrust() == Approx(max_thrust));
  CHECK(motor.curve.measured_in() == air_density);
  CHECK(motor.hover_interval == Approx(0).margin(1e-12));
  CHECK(motor.band > 0.05);  // the library's motors are no ideal ones
  CHECK(motor.band < 0.3);
}

TEST_CASE("a drone that turns round between passes does not hover there") {
  std::mt19937_64 dice(1);
  const Design design = quadrotor();
  const PowerLog hover = flight_of(260, 200, 0.002, dice);
  PowerLog turning = hover;
  for (int i = 0; i < 400; ++i) {
    turning.time.push_back(turning.time.back() + 0.2);
    const bool turns = i % 50 < 10;  // two seconds
    turning.airspeed.push_back(turns ? 0.5 : 8);
    turning.bus_power.push_back(turns ? 500 : 200);
  }
  const double at_rest = flown_motor(hover, design, max_thrust, {}).hover_power;
  CHECK(flown_motor(turning, design, max_thrust, {}).hover_power == Approx(at_rest));
}

TEST_CASE("forward flight is compared at the thrust that the drag asks for") {
  std::mt19937_64 dice(1);
  const Design design = quadrotor();
  const double ratio = std::pow(thrust_flown(design, 10) / thrust_flown(design, 0), 1.5);
  CHECK(ratio > 1.01);
  const FlownMotor motor = flown_motor(flight_of(400, 0.85 * ratio * 400, 0, dice), design,
                                       max_thrust, library_motors());
  REQUIRE(motor.forward);
  CHECK(motor.forward->rows == 600);
  CHECK(motor.forward->airspeed == Approx(10));
  CHECK(motor.forward->ratio == Approx(0.85).epsilon(1e-6));
}

TEST_CASE("where things weigh less, the same power is that of a motor that lifts less") {
  std::mt19937_64 dice(1);
  Design mars = quadrotor();
  mars.flight.gravity = 3.71;
  const double ratio = std::pow(thrust_flown(mars, 10) / thrust_flown(mars, 0), 1.5);
  const FlownMotor motor = flown_motor(flight_of(400, ratio * 400, 0, dice), mars, max_thrust, {});
  CHECK(motor.hover_thrust == Approx(1.6 * 3.71 / 4));
  CHECK(motor.curve.power(1.6 * 3.71 / 4) == Approx(100).epsilon(1e-3));
  REQUIRE(motor.forward);
  CHECK(motor.forward->ratio == Approx(1).epsilon(1e-6));
}

TEST_CASE("the hover's interval holds the true power about as often as it says") {
  const unsigned seed = test::run_seed();
  CAPTURE(seed);
  std::mt19937_64 dice(seed);
  constexpr int flights = 400;
  int held = 0;
  for (int i = 0; i < flights; ++i) {
    const FlownMotor motor =
        flown_motor(flight_of(400, 400, 0.02, dice), quadrotor(), max_thrust, {});
    if (std::abs(motor.hover_power / 100 - 1) <= motor.hover_interval) ++held;
  }
  // 95 % of 400 is 380 ± 4.4; neighbouring stretches still resemble each other a little.
  CHECK(held >= 355);
  CHECK(held <= 397);
}

TEST_CASE("flights that tell no motor are refused with what is missing") {
  std::mt19937_64 dice(1);
  const PowerLog flight = flight_of(400, 400, 0.02, dice);
  PowerLog brief = flight;
  brief.time.resize(40);
  brief.airspeed.resize(40);
  brief.bus_power.resize(40);
  CHECK_THROWS_WITH(flown_motor(brief, quadrotor(), max_thrust, {}),
                    Contains("at least 50 rows and 20 s"));
  CHECK_THROWS_WITH(flown_motor(flight, quadrotor(), 3.9, {}), Contains("400 g a motor"));
  PowerLog reversed = flight;
  for (double& power : reversed.bus_power) power = -power;
  CHECK_THROWS_WITH(flown_motor(reversed, quadrotor(), max_thrust, {}), Contains("sign reversed"));
}
