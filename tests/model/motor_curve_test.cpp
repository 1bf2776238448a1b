#include "tethercalc/model/motor_curve.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"

using namespace tethercalc;

TEST_CASE("a motor curve passes through its points and is straight between them") {
  const MotorCurve motor({{2, 10}, {4, 30}, {5, 50}});
  CHECK(motor.power(2) == 10);
  CHECK(motor.power(3) == Approx(20));
  CHECK(motor.power(4.5) == Approx(40));
  CHECK(motor.thrust(30) == 4);
  CHECK(motor.thrust(40) == Approx(4.5));
}

TEST_CASE("a motor curve keeps the first point's efficiency below it") {
  const MotorCurve motor({{2, 10}, {4, 30}});
  CHECK(motor.power(0.5) == Approx(0.5 * 10 / 2));
  CHECK(motor.thrust(1) == Approx(2 * 1.0 / 10));
  CHECK(motor.power(0) == 0);
  CHECK(motor.power(-1) == 0);
  CHECK(motor.thrust(-1) == 0);
}

TEST_CASE("a motor makes no thrust above its last point") {
  const MotorCurve motor({{2, 10}, {4, 30}});
  CHECK(motor.power(4) == 30);
  CHECK(motor.power(4 * (1 + 1e-11)) == std::numeric_limits<double>::infinity());
  CHECK(motor.thrust(1e9) == 4);
}

TEST_CASE("a curve without points makes no thrust") {
  const MotorCurve none;
  CHECK(none.thrust(100) == 0);
  CHECK(none.power(1) == std::numeric_limits<double>::infinity());
  CHECK(none.max_thrust() == 0);
  CHECK(none.max_power() == 0);
}

TEST_CASE("a motor curve refuses points that do not rise") {
  CHECK_THROWS_AS(MotorCurve({{1, 2}}), std::invalid_argument);
  CHECK_THROWS_AS(MotorCurve({{1, 2}, {1, 3}}), std::invalid_argument);
  CHECK_THROWS_AS(MotorCurve({{1, 2}, {2, 2}}), std::invalid_argument);
  CHECK_THROWS_AS(MotorCurve({{0, 0}, {2, 2}}), std::invalid_argument);
  CHECK_THROWS_AS(MotorCurve({{1, 2}, {2, std::nan("")}}), std::invalid_argument);
  CHECK_THROWS_AS(MotorCurve({{1, 2}, {std::numeric_limits<double>::infinity(), 3}}),
                  std::invalid_argument);
}

TEST_CASE("motor power and thrust are each other's inverse and follow the points") {
  test::each_random(200, [](test::Random& random) {
    const MotorCurve motor = test::random_motor(random, 0.9);
    for (int i = 0; i < 20; ++i) {
      const double thrust = random.uniform(0, motor.max_thrust());
      CHECK(motor.thrust(motor.power(thrust)) == Approx(thrust).epsilon(1e-12));
      CHECK(motor.power(thrust) == Approx(test::plain::motor_power(motor, thrust)).epsilon(1e-12));
      const double power = random.uniform(0, motor.max_power());
      CHECK(motor.power(motor.thrust(power)) == Approx(power).epsilon(1e-12));
      CHECK(motor.thrust(power) == Approx(test::plain::motor_thrust(motor, power)).epsilon(1e-12));
    }
  });
}

TEST_CASE("the convex hull lies nowhere above the curve, is convex and meets it at its vertices") {
  test::each_random(200, [](test::Random& random) {
    const MotorCurve motor = test::random_motor(random, random.chance(0.3) ? 0 : 0.9);
    const MotorCurve hull = motor.convex_hull();
    CHECK(hull.max_thrust() == motor.max_thrust());
    CHECK(hull.max_power() == motor.max_power());
    for (const MotorPoint& vertex : hull.vertices()) {
      CHECK(motor.power(vertex.thrust) == Approx(vertex.power).epsilon(1e-14));
    }
    for (std::size_t i = 2; i < hull.vertices().size(); ++i) {
      CHECK(hull.slope(i - 1) > hull.slope(i - 2));
    }
    for (int i = 0; i < 50; ++i) {
      const double thrust = random.uniform(0, motor.max_thrust());
      CHECK(hull.power(thrust) <= motor.power(thrust) * (1 + 1e-12));
    }
  });
}

namespace {

/// A rotor whose power goes with thrust to the 3/2, at many points.
MotorCurve ideal_rotor(double most) {
  std::vector<MotorPoint> points;
  for (int i = 1; i <= 400; ++i) {
    const double thrust = most * i / 400;
    points.push_back({thrust, 5 * std::pow(thrust, 1.5)});
  }
  return MotorCurve(points);
}

}  // namespace

TEST_CASE("in thinner air an ideal rotor needs 1/sqrt(density) times the power for a thrust") {
  // Momentum theory: P = T^1.5/√(2ρA).
  const MotorCurve bench = ideal_rotor(20);
  for (const double ratio : {0.6, 1 / 1.293, 0.9, 1.0, 1.1}) {
    const MotorCurve flown = bench.in_air(ratio);
    for (const double thrust : {3.0, 6.5, 11.0}) {
      CHECK(flown.power(thrust) == Approx(bench.power(thrust) / std::sqrt(ratio)).epsilon(2e-4));
    }
    CHECK(flown.max_thrust() == Approx(20 * ratio).epsilon(1e-14));
    CHECK(flown.max_power() == Approx(bench.max_power() * ratio).epsilon(1e-14));
  }
}

TEST_CASE("a curve in other air is the same curve in thrusts and powers times the ratio") {
  test::each_random(100, [](test::Random& random) {
    MotorCurve bench = test::random_motor(random, 0.9);
    bench.set_measured_in(1.2);
    const double ratio = random.uniform(0.5, 1.5);
    const MotorCurve flown = bench.in_air(ratio);
    CHECK(flown.is_convex() == bench.is_convex());
    CHECK(*flown.measured_in() == Approx(1.2 * ratio).epsilon(1e-15));
    for (int i = 0; i < 20; ++i) {
      const double thrust = random.uniform(0, 0.999) * bench.max_thrust();
      CHECK(flown.power(ratio * thrust) == Approx(ratio * bench.power(thrust)).epsilon(1e-10));
      CHECK(flown.thrust(ratio * bench.power(thrust)) == Approx(ratio * thrust).epsilon(1e-10));
      CHECK(flown.convex_hull().power(ratio * thrust) ==
            Approx(ratio * bench.convex_hull().power(thrust)).epsilon(1e-10));
    }
  });
  CHECK(MotorCurve().in_air(0.5).max_thrust() == 0);
}

TEST_CASE("the air through a leaning disc solves Glauert's equation, and the slope is its own") {
  for (const double mu : {0.01, 0.3, 1.0, -2.5, 8.0, 40.0}) {
    CHECK(inflow_ratio(mu, 0).ratio == Approx(induced_velocity_ratio(mu)).epsilon(1e-14));
    double before = 0;
    for (const double tangent : {0.0, 1e-6, 0.05, 0.3, 1.0, 6.0}) {
      INFO(mu << " " << tangent);
      const double angle = std::atan(tangent);
      const double through = std::abs(mu) * std::sin(angle);
      const Inflow inflow = inflow_ratio(mu, tangent);
      const double induced = inflow.ratio - through;
      CHECK(induced > 0);
      CHECK(induced * std::hypot(mu * std::cos(angle), inflow.ratio) == Approx(1).epsilon(1e-10));
      CHECK(inflow.ratio >= before);  // leaning costs
      before = inflow.ratio;
      constexpr double step = 1e-5;
      const double by_steps =
          (inflow_ratio(mu, tangent + step).ratio - inflow_ratio(mu, tangent).ratio) / step;
      CHECK(inflow.slope == Approx(by_steps).epsilon(1e-3).margin(1e-4 * std::abs(mu)));
    }
  }
}

TEST_CASE(
    "the air through a disc is that of hover at rest, and of a climb where it stands upright") {
  CHECK(inflow_ratio(0, 0.5).ratio == 1);
  // An axial climb of twice the hover's induced speed: v_c/2 + √(v_c²/4 + 1) (Leishman, 2.13).
  CHECK(inflow_ratio(2, 1e9).ratio == Approx(1 + std::sqrt(2.0)));
}

TEST_CASE("motors that lean take the drag's power on top of what level discs take") {
  const TranslationalLift lift{0.6, 7};
  // Fast, little is induced: then s·v·sinα/v_h of the power is the drag times the airspeed.
  const double tangent = 0.25;
  const double sine = tangent / std::sqrt(1 + tangent * tangent);
  const double more = translational_lift_share(lift, 50, tangent).value -
                      translational_lift_share(lift, 50, 0).value;
  CHECK(more == Approx(0.6 * 50 * sine / 7).epsilon(0.03));
  CHECK(translational_lift_share({0, 7}, 20, 0.5).value == 1);  // neutral
  CHECK(translational_lift_share(lift, 0, 0.5).value == 1);
}
