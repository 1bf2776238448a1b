#include "tethercalc/model/airframe.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/plain_physics.hpp"
#include "support/random.hpp"

using namespace tethercalc;

namespace {

ForceBalance random_balance(test::Random& random) {
  // From a feather in a storm to a brick in still air; narrow and flat airframes.
  return {random.magnitude(0.1, 500), random.magnitude(1e-3, 1e4),
          random.chance(0.8) ? random.magnitude(1e-4, 100) : 0,
          random.chance(0.8) ? random.magnitude(1e-4, 0.3) : 0,
          random.chance(0.8) ? random.magnitude(1e-4, 0.3) : 0};
}

/// θ in which W·sinθ = (q(A_f cosθ + A_t sinθ) + F_t)·cosθ.
double tilt_by_bisection(const ForceBalance& b) {
  return test::plain::bisect(
      [&](double theta) {
        const double drag =
            b.area_force_factor * (b.front_area * std::cos(theta) + b.top_area * std::sin(theta)) +
            b.tether_drag;
        return b.weight * std::sin(theta) - drag * std::cos(theta);
      },
      0, test::plain::pi / 2);
}

}  // namespace

TEST_CASE("the tilt balances weight and drag, as a bisection over the angle finds it") {
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  test::each_random(2000, [no_limit](test::Random& random) {
    const ForceBalance balance = random_balance(random);
    const double tilt = tilt_by_bisection(balance);
    const double guess = random.chance(0.5) ? 0 : random.magnitude(1e-6, 1e6);
    // The bisection's own error is an ulp of π/2; it is all there is of a tiny angle.
    CHECK(std::atan(equilibrium_tan_pitch(balance, no_limit, guess)) ==
          Approx(tilt).epsilon(1e-13).margin(1e-15));
  });
}

TEST_CASE("the thrust of an equilibrium holds up its weight again") {
  test::each_random(2000, [](test::Random& random) {
    ForceBalance balance = random_balance(random);
    const double weight = balance.weight;
    const double tilt = tilt_by_bisection(balance);
    const bool only_from_above = balance.front_area == 0 && balance.tether_drag == 0;
    if (tilt > 1.4 || only_from_above) return;  // the thrust tells little of the weight
    const double thrust = weight / std::cos(tilt);
    balance.weight = 0;
    // A drag that is nearly all from above leaves few digits of the weight.
    CHECK(weight_held(balance, thrust) == Approx(weight).epsilon(1e-8));
  });
}

TEST_CASE("a tilt above its limit is infinite") {
  test::each_random(500, [](test::Random& random) {
    const ForceBalance balance = random_balance(random);
    const double tangent = std::tan(tilt_by_bisection(balance));
    CHECK(equilibrium_tan_pitch(balance, tangent * 1.001) < 1e300);
    if (tangent > 1e-12) {  // else the bisection's error, for there is no drag
      CHECK(equilibrium_tan_pitch(balance, tangent * 0.999) ==
            std::numeric_limits<double>::infinity());
    }
  });
}

TEST_CASE("without drag there is no tilt") {
  CHECK(equilibrium_tan_pitch({10, 0, 0, 0.01, 0.01}, 1) == 0);
  CHECK(equilibrium_tan_pitch({10, 5, 0, 0, 0}, 1) == 0);
}

TEST_CASE("drag of the airframe is the paper's formula and turns with the airspeed") {
  const AirframeDrag drag{0.01451, 0.01361, 19.27, 0};
  const double v = 8;
  const double theta = 0.1;
  const double expected =
      0.5 * 1.293 * (0.01451 * std::cos(theta) + 0.01361 * std::sin(theta)) * (v * v + 19.27 * v);
  CHECK(airframe_drag_force(drag, 1.293, v, std::tan(theta)) == Approx(expected).epsilon(1e-14));
  CHECK(airframe_drag_force(drag, 1.293, -v, -std::tan(theta)) == Approx(-expected).epsilon(1e-14));
  CHECK(airframe_drag_force(drag, 1.293, 0, 0) == 0);
}

TEST_CASE("fore-aft asymmetry adds to forward drag what it takes from backward drag") {
  const AirframeDrag drag{0.02, 0.01, 5, 0.25};
  const AirframeDrag even{0.02, 0.01, 5, 0};
  const double plain = airframe_drag_force(even, 1.2, 6, 0.2);
  CHECK(airframe_drag_force(drag, 1.2, 6, 0.2) == Approx(1.25 * plain));
  CHECK(airframe_drag_force(drag, 1.2, -6, 0.2) == Approx(-0.75 * plain));
}
