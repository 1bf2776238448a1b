#include "model/winched_cable.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "support/random.hpp"

using namespace tethercalc;
using test::each_random;
using test::Random;

namespace {

WinchedCable drawn_on_winch(Random& random) {
  WinchedCable cable{.weight = random.magnitude(0.02, 1), .height = random.uniform(3, 100)};
  const double speed = random.chance(0.1) ? 0 : random.uniform(-20, 20);
  cable.drag = random.magnitude(2e-4, 4e-3) * speed * std::abs(speed);
  cable.aside = random.chance(0.3) ? 0.5 : random.uniform(0, 80);
  cable.tension = std::hypot(cable.weight, cable.drag) * std::hypot(cable.aside, cable.height) *
                  random.magnitude(0.05, 5);
  return cable;
}

/// A point of a cable in its plane.
struct Place {
  double angle = 0;
  double tension = 0;
  double x = 0;
  double z = 0;
};

/// T·dφ/ds = w·cos φ + D·sin φ·|sin φ| and dT/ds = w·sin φ, by ds = T·dσ.
Place change(const WinchedCable& cable, const Place& at) {
  const double sine = std::sin(at.angle);
  const double cosine = std::cos(at.angle);
  return {cable.weight * cosine + cable.drag * sine * std::abs(sine),
          at.tension * cable.weight * sine, at.tension * cosine, at.tension * sine};
}

Place moved(const Place& at, double step, const Place& by) {
  return {at.angle + step * by.angle, at.tension + step * by.tension, at.x + step * by.x,
          at.z + step * by.z};
}

/// A step of order 4 (Runge and Kutta).
Place after_step(const WinchedCable& cable, const Place& at, double step) {
  const Place a = change(cable, at);
  const Place b = change(cable, moved(at, step / 2, a));
  const Place c = change(cable, moved(at, step / 2, b));
  const Place d = change(cable, moved(at, step, c));
  return moved(moved(moved(moved(at, step / 6, a), step / 3, b), step / 3, c), step / 6, d);
}

Place followed(const WinchedCable& cable, Place at, double sigma) {
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) at = after_step(cable, at, sigma / steps);
  return at;
}

/// How far aside a cable that leaves its winch at this angle comes to the drone's height.
double aside_at_height(const WinchedCable& cable, double angle) {
  Place at{angle, cable.tension, 0, 0};
  const double step = 0.02 / std::hypot(cable.weight, cable.drag);
  for (;;) {
    const Place next = after_step(cable, at, step);
    if (next.z >= cable.height && next.z > at.z) {
      return at.x + (cable.height - at.z) / (next.z - at.z) * (next.x - at.x);
    }
    at = next;
  }
}

/// Seen from the side from which the cable turns upward at its chord.
WinchedCable seen_turning_upward(const WinchedCable& cable) {
  const double across = cable.weight * cable.aside * std::hypot(cable.aside, cable.height) +
                        cable.drag * cable.height * cable.height;
  if (across > 0) return cable;
  WinchedCable mirrored = cable;
  mirrored.drag = -cable.drag;
  mirrored.aside = -cable.aside;
  return mirrored;
}

/// The farthest aside that any angle at the winch leads to.
double farthest_aside(const WinchedCable& cable) {
  // The cable turns upward from the angle against that in which load and tension balance.
  const double balanced =
      std::acos(-2 * cable.drag / (cable.weight + std::hypot(cable.weight, 2 * cable.drag)));
  constexpr int angles = 200;
  double farthest = -1e9;
  for (int i = 1; i < angles; ++i) {
    const double angle = balanced - std::numbers::pi * i / angles;
    farthest = std::max(farthest, aside_at_height(cable, angle));
  }
  return farthest;
}

}  // namespace

TEST_CASE("a cable in a plane turns under its load from its winch to its drone") {
  int hung = 0;
  each_random(test::draws(400), [&hung](Random& random) {
    const WinchedCable cable = drawn_on_winch(random);
    const auto found = taut_cable(cable);
    REQUIRE(found);
    if (!found->hangs) return;
    ++hung;
    const Place slackest{std::atan2(found->slackest.along_z, found->slackest.along_x),
                         found->slackest.tension, 0, 0};
    const Place winch = followed(cable, slackest, -found->before * found->sigma);
    const Place drone = followed(cable, slackest, (1 - found->before) * found->sigma);
    const double distance = std::hypot(cable.aside, cable.height);
    CHECK(drone.x - winch.x == Approx(cable.aside).margin(1e-6 * distance));
    CHECK(drone.z - winch.z == Approx(cable.height).margin(1e-6 * distance));
    CHECK(winch.tension == Approx(cable.tension).epsilon(1e-6));
  });
  CHECK(hung > 0);
}

TEST_CASE("a winch holds no cable in a plane where no angle at it leads as far as the drone") {
  each_random(test::draws(60), [](Random& random) {
    const WinchedCable cable = drawn_on_winch(random);
    const auto found = taut_cable(cable);
    REQUIRE(found);
    const WinchedCable seen = seen_turning_upward(cable);
    // Between two angles of the scan the greatest is missed by up to 1e-3 of the way.
    const double margin = 2e-3 * std::hypot(cable.aside, cable.height);
    if (found->hangs) {
      CHECK(farthest_aside(seen) > seen.aside - margin);
    } else {
      CHECK(farthest_aside(seen) < seen.aside);
    }
  });
}

TEST_CASE("a cable in a plane hangs tauter and shorter the harder its winch pulls") {
  each_random(test::draws(100), [](Random& random) {
    WinchedCable cable = drawn_on_winch(random);
    const auto weak = taut_cable(cable);
    cable.tension *= 1.2;
    const auto strong = taut_cable(cable);
    REQUIRE(weak);
    REQUIRE(strong);
    if (!weak->hangs) return;
    REQUIRE(strong->hangs);
    CHECK(strong->slackest.tension > weak->slackest.tension);
    CHECK(strong->length < weak->length);
  });
}

TEST_CASE("a cable above its winch hangs straight in still air, however weak the winch") {
  for (const double tension : {1e-3, 0.1, 5.0, 1e4}) {
    const auto found =
        taut_cable({.weight = 1, .drag = 0, .tension = tension, .aside = 0, .height = 10});
    REQUIRE(found);
    REQUIRE(found->hangs);
    CHECK(found->at_drone.along_z == Approx(1));
    CHECK(found->at_winch.tension == Approx(tension));
    CHECK(found->length == Approx(10));
    CHECK(found->sigma == Approx(std::log1p(10 / tension)));
    CHECK(found->before == 0);
  }
}

TEST_CASE("a cable nearly without weight, or to a drone no higher, is left to who solves any") {
  CHECK_FALSE(taut_cable({.weight = 1e-3, .drag = 1, .tension = 5, .aside = 3, .height = 10}));
  CHECK_FALSE(taut_cable({.weight = 1, .drag = 0, .tension = 5, .aside = 10, .height = 1e-20}));
  CHECK_FALSE(taut_cable({.weight = 1, .drag = 0, .tension = 5, .aside = 5, .height = 0}));
}

TEST_CASE("a tension far beyond the load, or next to none of it, is left to who solves any") {
  CHECK_FALSE(taut_cable({.weight = 1, .drag = 0.3, .tension = 1e9, .aside = 5, .height = 10}));
  CHECK_FALSE(taut_cable({.weight = 1, .drag = 0.5, .tension = 1e-300, .aside = 3, .height = 10}));
}
