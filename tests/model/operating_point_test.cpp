#include "tethercalc/model/operating_point.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"

using namespace tethercalc;

namespace {

/// A design, an area and a condition, of which about half can be flown.
template <typename Visit>
void each_random_point(int count, Visit visit) {
  test::each_random(count, [&](test::Random& random) {
    const Design design = test::random_design(random);
    const double area = random.magnitude(1e-8, 1e-4);
    visit(design, area, random.chance(0.5) ? Condition::hover : Condition::forward);
  });
}

}  // namespace

TEST_CASE("an operating point follows the paper's equations") {
  each_random_point(2000, [](const Design& design, double area, Condition condition) {
    const OperatingPoint ours = evaluate(design, area, condition);
    const test::plain::Point plain = test::plain::evaluate(design, area, condition);
    CHECK(ours.tether_resistance == Approx(plain.resistance).epsilon(1e-12));
    CHECK(ours.tether_mass == Approx(plain.tether_mass).epsilon(1e-12));
    CHECK(ours.available_power == Approx(plain.available_power).epsilon(1e-12));
    CHECK(ours.available_thrust == Approx(plain.available_thrust).epsilon(1e-11).margin(1e-12));
    if (plain.tilts_too_far) {
      CHECK(std::isnan(ours.pitch));
      CHECK(std::isnan(ours.necessary_thrust));
      CHECK(std::isnan(ours.total_power));
      CHECK_FALSE((ours.headroom >= 1));
      return;
    }
    CHECK(ours.pitch == Approx(plain.pitch).epsilon(1e-12).margin(1e-14));
    CHECK(ours.necessary_thrust == Approx(plain.necessary_thrust).epsilon(1e-12));
    CHECK(ours.headroom == Approx(plain.headroom).epsilon(1e-11).margin(1e-12));
    CHECK((ours.headroom >= 1) == (plain.headroom >= 1));
    if (plain.drone_power < test::plain::infinity) {
      CHECK(ours.drone_power == Approx(plain.drone_power).epsilon(1e-11));
    } else {
      CHECK(std::isnan(ours.drone_power));
    }
    if (plain.total_power < test::plain::infinity) {
      // The textbook's smaller root cancels: it has fewer digits the smaller the loss is.
      CHECK(ours.total_power == Approx(plain.total_power).epsilon(1e-8));
    } else {
      CHECK(std::isnan(ours.total_power));
    }
  });
}

TEST_CASE("what the supply gives arrives at the drone or heats the tether") {
  each_random_point(2000, [](const Design& design, double area, Condition condition) {
    const OperatingPoint p = evaluate(design, area, condition);
    if (std::isnan(p.total_power)) return;
    const double heat = p.current * p.current * p.tether_resistance;
    CHECK(design.supply.voltage * p.current == Approx(p.drone_power + heat).epsilon(1e-9));
    CHECK(p.tether_loss == Approx(heat).epsilon(1e-9).margin(1e-9 * p.total_power));
    CHECK(p.received_voltage * p.current == Approx(p.drone_power).epsilon(1e-9));
    CHECK(p.received_voltage >= design.supply.voltage / 2 * (1 - 1e-9));
  });
}

TEST_CASE("a flyable point receives no less than the lowest allowed voltage") {
  each_random_point(2000, [](const Design& design, double area, Condition condition) {
    const OperatingPoint p = evaluate(design, area, condition);
    if (!(p.headroom >= 1)) return;
    CHECK(p.received_voltage >= design.supply.converter.min_input_voltage * (1 - 1e-9));
    CHECK(p.drone_power <= p.available_power * (1 + 1e-9));
  });
}

TEST_CASE("more voltage never needs more power and never takes away headroom") {
  test::each_random(1000, [](test::Random& random) {
    Design design = test::random_design(random);
    const double area = random.magnitude(1e-8, 1e-4);
    const OperatingPoint low = evaluate(design, area, Condition::forward);
    design.supply.voltage *= random.uniform(1, 3);
    const OperatingPoint high = evaluate(design, area, Condition::forward);
    if (std::isnan(low.headroom)) return;
    CHECK(high.headroom >= low.headroom * (1 - 1e-12));
    if (!std::isnan(low.total_power)) CHECK(high.total_power <= low.total_power * (1 + 1e-12));
  });
}

TEST_CASE("a heavier or hotter or longer-spooled design never needs less power") {
  test::each_random(1000, [](test::Random& random) {
    const Design design = test::random_design(random);
    const double area = random.magnitude(1e-8, 1e-4);
    Design worse = design;
    switch (random.integer(0, 3)) {
      case 0:
        worse.tether.conductor_temperature_C += random.uniform(0, 50);
        break;
      case 1:
        worse.tether.spooled_length += random.uniform(0, 50);
        break;
      case 2:
        worse.tether.contact_resistance += random.uniform(0, 1);
        break;
      default:
        worse.drone.auxiliary_power += random.uniform(0, 50);
    }
    const double before = evaluate(design, area, Condition::hover).total_power;
    const double after = evaluate(worse, area, Condition::hover).total_power;
    if (std::isnan(before)) {
      CHECK(std::isnan(after));
    } else if (!std::isnan(after)) {
      CHECK(after >= before * (1 - 1e-12));
    }
  });
}

TEST_CASE("flying backward through the air leans backward by the same tilt") {
  Design design = test::published_design();
  const double forward = evaluate(design, 1e-6, Condition::forward).pitch;
  design.flight.headwind = -2 * design.flight.airspeed;
  CHECK(forward > 0);
  CHECK(evaluate(design, 1e-6, Condition::forward).pitch == Approx(-forward));
}

TEST_CASE("the range beyond the tilt limit is where a bisection over the angle tilts further") {
  test::each_random(500, [](test::Random& random) {
    Design design = test::random_design(random);
    design.flight.airspeed = random.uniform(5, 60);
    const SteadyFlight flight(design, Condition::forward);
    const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
    for (int i = 0; i < 20; ++i) {
      const double radius = random.magnitude(1e-5, 1e-1);
      const double edge_distance =
          std::min(std::abs(radius / beyond.lo - 1), std::abs(radius / beyond.hi - 1));
      if (edge_distance < 1e-9) continue;
      const double area = test::plain::pi * radius * radius;
      CHECK(test::plain::evaluate(design, area, Condition::forward).tilts_too_far ==
            (beyond.lo < radius && radius < beyond.hi));
    }
  });
}

TEST_CASE("radii of a weight and of a resistance are the inverses of both") {
  test::each_random(500, [](test::Random& random) {
    const Design design = test::random_design(random);
    const SteadyFlight flight(design, Condition::hover);
    const double radius = random.magnitude(1e-5, 1e-2);
    const StraightTether& tether = flight.tether().straight();
    CHECK(flight.radius_of_weight(flight.weight(radius)) == Approx(radius).epsilon(1e-6));
    CHECK(tether.radius_of_resistance(tether.resistance(radius)) == Approx(radius).epsilon(1e-6));
    CHECK(flight.radius_of_weight(flight.weight(0) * 0.999) < 0);
  });
}

TEST_CASE("the slope of the necessary thrust is that of its secant") {
  test::each_random(500, [](test::Random& random) {
    const Design design = test::random_design(random);
    const SteadyFlight flight(design, Condition::forward);
    const double radius = random.magnitude(1e-4, 1e-2);
    const auto thrust = [&](double r) { return flight.balance(r, 0).thrust.value; };
    const double step = 1e-4 * radius;
    const double secant = (thrust(radius + step) - thrust(radius - step)) / (2 * step);
    const auto tangent = flight.balance(radius, 0).thrust;
    CHECK(tangent.slope == Approx(secant).epsilon(1e-5).margin(1e-9 * tangent.value / step));
  });
}

TEST_CASE("a bench in the air of the flight, or in an unknown one, changes no digit") {
  test::each_random(200, [](test::Random& random) {
    Design design = test::random_design(random);
    const double area = random.magnitude(0.1e-6, 10e-6);
    const OperatingPoint plain = evaluate(design, area, Condition::forward);
    design.drone.motor_air_density = design.flight.air_density;
    const OperatingPoint stated = evaluate(design, area, Condition::forward);
    for (const auto member : {&OperatingPoint::available_thrust, &OperatingPoint::headroom,
                              &OperatingPoint::total_power}) {
      const bool same = plain.*member == stated.*member ||
                        (std::isnan(plain.*member) && std::isnan(stated.*member));
      CHECK(same);
    }
  });
}

TEST_CASE("where the bench's air is known, thinner air asks for more power and makes less thrust") {
  test::each_random(200, [](test::Random& random) {
    Design design = test::random_design(random);
    design.drone.motor = test::random_motor(random, 0);
    design.drone.mass =
        design.drone.motor.max_thrust() * design.drone.motor_count / standard_gravity / 5;
    design.drone.motor_air_density = 1.225;
    design.flight.headwind = 0;
    const double area = random.magnitude(0.1e-6, 10e-6);
    design.flight.air_density = random.uniform(0.8, 1.3);
    const OperatingPoint thick = evaluate(design, area, Condition::hover);
    design.flight.air_density *= random.uniform(0.7, 1);
    const OperatingPoint thin = evaluate(design, area, Condition::hover);
    CHECK(thin.necessary_thrust == thick.necessary_thrust);
    if (std::isnan(thin.drone_power)) return;
    CHECK(thin.drone_power >= thick.drone_power * (1 - 1e-12));
    CHECK(thin.available_thrust <= thick.available_thrust * (1 + 1e-12));
  });
}

TEST_CASE("what air changes of motors that count in any is what it changes of an ideal rotor") {
  test::each_random(100, [](test::Random& random) {
    std::vector<MotorPoint> ideal;
    const double factor = random.magnitude(1, 100);
    for (int i = 1; i <= 20; ++i) ideal.push_back({0.5 * i, factor * std::pow(0.5 * i, 1.5)});
    Design design = test::published_design();
    design.drone.motor = MotorCurve(ideal);
    design.flight.air_density = random.uniform(0.5, 1.15);
    const auto told = unscaled_motors(design);
    REQUIRE(told);
    design.drone.motor_air_density = 1.225;
    CHECK(!unscaled_motors(design));
    const MotorCurve scaled = motor_in_flight(design);
    CHECK(told->thrust_ratio == Approx(scaled.max_thrust() / 10).epsilon(1e-12));
    const MotorPoint point = scaled.vertices()[static_cast<std::size_t>(random.integer(1, 20))];
    CHECK(told->power_ratio ==
          Approx(point.power / (factor * std::pow(point.thrust, 1.5))).epsilon(1e-12));
  });
}

TEST_CASE(
    "the published drone hovers at the power that its curve has at thrust over density ratio") {
  Design design = test::published_design();
  design.drone.motor_air_density = 1.225;
  design.flight.air_density = 1.0;
  const double ratio = 1 / 1.225;
  const OperatingPoint point = evaluate(design, 1.0886e-6, Condition::hover);
  const double motors = 4 * ratio * design.drone.motor.power(point.necessary_thrust / ratio);
  CHECK(point.drone_power == Approx(motors / 0.9 + 15).epsilon(1e-12));
  // The motor's own density counts where the design states none.
  design.drone.motor_air_density.reset();
  design.drone.motor.set_measured_in(1.225);
  CHECK(evaluate(design, 1.0886e-6, Condition::hover).drone_power ==
        Approx(point.drone_power).epsilon(1e-14));
  // And a drone already put into the air of its flight stays there.
  Design put = design;
  put.drone = drone_in_flight(design);
  CHECK(evaluate(put, 1.0886e-6, Condition::hover).drone_power == Approx(point.drone_power));
}
