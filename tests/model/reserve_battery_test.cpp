#include "tethercalc/model/reserve_battery.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/plain_physics.hpp"
#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/steady_flight.hpp"

using namespace tethercalc;

namespace {

constexpr double watt_hour = 3600;

Design design_with_battery() {
  Design design = test::published_design();
  design.drone.reserve_battery.specific_energy = 150 * watt_hour;
  return design;
}

}  // namespace

TEST_CASE("energy sizes the battery of a long landing, the discharge rate that of a short one") {
  ReserveBattery battery;
  battery.specific_energy = 150 * watt_hour;
  battery.usable_share = 0.8;
  battery.discharge_rate = 10 / watt_hour;
  battery.descent_speed = 2;
  // 30 m in 15 s: 1 kg gives 1500 W at 10C, and would give 150·0.8·3600/15 = 28800 W by its energy.
  CHECK(landing_time(battery, 30) == 15);
  CHECK(battery_mass_per_watt(battery, 30) == Approx(1 / 1500.0));
  // 1000 m in 500 s: 150·0.8·3600/500 = 864 W.
  CHECK(battery_mass_per_watt(battery, 1000) == Approx(1 / 864.0));
  battery.specific_energy = 0;
  CHECK(battery_mass_per_watt(battery, 1000) == 0);
}

TEST_CASE("the battery holds up the drone, the whole tether and itself, for as long as it takes") {
  test::each_random(200, [](test::Random& random) {
    Design design = test::random_design(random);
    ReserveBattery& battery = design.drone.reserve_battery;
    battery.specific_energy = random.uniform(80, 250) * watt_hour;
    battery.usable_share = random.uniform(0.5, 1);
    battery.discharge_rate = random.magnitude(2, 60) / watt_hour;
    battery.descent_speed = random.uniform(0.5, 5);
    const OperatingPoint p = evaluate(design, random.magnitude(0.2e-6, 3e-6), Condition::hover);
    if (!std::isfinite(p.battery_mass)) return;
    // Apart from how the mass was found: energy and power of that pack suffice, one of them barely,
    // at the tilt that the wind asks for.
    const double weight = p.takeoff_mass * design.flight.gravity;
    const double wind = design.flight.headwind;
    const AirframeDrag& airframe = design.drone.drag;
    const double pressure = 0.5 * design.flight.air_density;
    const double factor = pressure * std::abs(wind) * (std::abs(wind) + airframe.linear_speed) *
                          (1 + (wind < 0 ? -1 : 1) * airframe.fore_aft_asymmetry);
    const double radius = std::sqrt(p.cross_section / test::plain::pi);
    const double cable = pressure * 0.75 * wind * wind * 4 * design.tether.length *
                         (radius + design.tether.insulation.thickness);
    const double tilt = test::plain::bisect(
        [&](double angle) {
          const double drag = factor * (airframe.front_area * std::cos(angle) +
                                        airframe.top_area * std::sin(angle)) +
                              cable;
          return weight * std::sin(angle) - drag * std::cos(angle);
        },
        0, test::plain::pi / 2);
    const double power =
        design.drone.motor_count * design.drone.motor_power_factor *
            translational_lift_share(design.drone.translational_lift, wind, std::tan(tilt)).value *
            design.drone.motor.power(weight / std::cos(tilt) / design.drone.motor_count) +
        design.drone.auxiliary_power;
    const double energy = p.battery_mass * battery.specific_energy;
    const double by_energy =
        energy * battery.usable_share / (power * design.tether.length / battery.descent_speed);
    const double by_rate = energy * battery.discharge_rate / power;
    CHECK(std::min(by_energy, by_rate) == Approx(1).epsilon(1e-9));
    CHECK(p.takeoff_mass == Approx(design.drone.mass + converter_mass(design.supply.converter) +
                                   p.tether_mass + p.battery_mass)
                                .epsilon(1e-12));
  });
}

TEST_CASE("a drone that no battery lands does not fly, and is told by an infinite mass") {
  Design design = design_with_battery();
  design.drone.reserve_battery.specific_energy = 5 * watt_hour;  // 50 W/kg at 10C
  const OperatingPoint p = evaluate(design, 1e-6, Condition::forward);
  CHECK(std::isinf(p.battery_mass));
  CHECK_FALSE(p.headroom >= 1);
  CHECK(std::isnan(p.total_power));
  CHECK(std::isnan(p.takeoff_mass));
}

TEST_CASE("a battery flies in every number that its mass reaches") {
  const Design design = design_with_battery();
  const OperatingPoint p = evaluate(design, 1.2e-6, Condition::forward);
  Design heavier = test::published_design();
  heavier.drone.mass += p.battery_mass;
  const OperatingPoint same = evaluate(heavier, 1.2e-6, Condition::forward);
  CHECK(p.battery_mass > 0.1);
  CHECK(p.total_power == Approx(same.total_power).epsilon(1e-12));
  CHECK(p.pitch == Approx(same.pitch).epsilon(1e-12));
  CHECK(p.headroom == Approx(same.headroom).epsilon(1e-12));
}

TEST_CASE("the battery sees the headwind as the flight does") {
  // Without losses of a converter and a winch that pulls, hovering takes the same power from the
  // line as from the battery.
  test::each_random(500, [](test::Random& random) {
    Design design = test::random_design(random);
    design.supply.converter.efficiency = {{0, 1}};
    design.flight.headwind = random.uniform(-8, 12);
    design.requirements.max_pitch = 89 * unit::degree;
    ReserveBattery& battery = design.drone.reserve_battery;
    battery.specific_energy = random.uniform(80, 250) * watt_hour;
    const OperatingPoint p = evaluate(design, random.magnitude(0.2e-6, 3e-6), Condition::hover);
    if (!std::isfinite(p.drone_power)) return;
    const double per_watt = battery_mass_per_watt(battery, design.tether.length);
    CHECK(p.battery_mass == Approx(per_watt * p.drone_power).epsilon(1e-9));
  });
}

TEST_CASE(
    "the battery in wind is the lightest that carries itself, whatever the tilt and the motors") {
  // Tried over take-off masses one by one, with the tilt from the balance of forces by bisection.
  int carried = 0;
  test::each_random(1000, [&carried](test::Random& random) {
    Drone drone;
    drone.motor_count = 4;
    drone.motor = test::random_jagged_motor(random, 20);
    drone.drag.front_area = random.magnitude(0.001, 0.3);
    if (random.chance(0.7)) {
      drone.translational_lift = {random.uniform(0.3, 0.9), random.magnitude(2, 10)};
    }
    drone.reserve_battery.specific_energy = random.magnitude(3, 300) * watt_hour;
    const double mass = random.magnitude(0.1, 4);
    Landing landing{random.magnitude(10, 1000), 9.8, 0, random.uniform(0, 5), 0};
    landing.airspeed = random.uniform(1, 20);
    landing.area_force_factor = 0.6 * landing.airspeed * landing.airspeed;

    const double per_watt = battery_mass_per_watt(drone.reserve_battery, landing.height);
    const auto missing = [&](double takeoff) {
      const double weight = takeoff * landing.gravity;
      double level = 0;
      double upright = test::plain::pi / 2;
      for (int i = 0; i < 60; ++i) {
        const double tilt = 0.5 * (level + upright);
        const double drag = landing.area_force_factor * drone.drag.front_area * std::cos(tilt) +
                            landing.tether_drag;
        (weight * std::tan(tilt) < drag ? level : upright) = tilt;
      }
      const double thrust = weight / std::cos(level) / drone.motor_count;
      if (thrust > drone.motor.max_thrust()) return test::plain::infinity;
      const double share =
          translational_lift_share(drone.translational_lift, landing.airspeed, std::tan(level))
              .value;
      return per_watt * drone.motor_count * share * drone.motor.power(thrust) - (takeoff - mass);
    };
    const double battery = reserve_battery_mass(drone, mass, landing);
    const bool carries = std::isfinite(battery);
    const double most = drone.motor_count * drone.motor.max_thrust() / landing.gravity;
    const double found = carries ? mass + battery : std::max(most, mass);
    // Two roots within a thousandth of the mass may be taken for none.
    for (int i = 0; i < 1000; ++i) {
      const double takeoff = mass + i * (found - mass) / 1000;
      if (!(missing(takeoff) > -1e-5 * takeoff)) FAIL_CHECK(takeoff << " kg lands, not " << found);
    }
    if (carries) CHECK(missing(found * (1 + 1e-9)) <= 1e-12 * found);
    carried += carries;
  });
  CHECK(carried > 300);
  CHECK(carried < 900);
}

TEST_CASE("a battery against a constant drag is the root of a quadratic") {
  // Motors of 10 W/N without end, and a cable that makes all the drag F: m = c(10·√(W² + F²) + P)
  // with W = (M + m)g.
  Design design = design_with_battery();
  design.drone.drag = {};
  design.drone.motor = MotorCurve(std::vector<MotorPoint>{{50, 500}, {100, 1000}});
  design.flight.headwind = 15;
  design.flight.air_density = 1.2;
  const double area = 1e-6;
  const double drag = 0.5 * 1.2 * 0.75 * 15 * 15 * 4 * 30 *
                      (std::sqrt(area / test::plain::pi) + design.tether.insulation.thickness);
  const OperatingPoint p = evaluate(design, area, Condition::hover);
  const double c = 10.0 / 1500;  // kg/N
  const double g = design.flight.gravity;
  const double bare = p.takeoff_mass - p.battery_mass;
  // (m − c·P/10)² = c²·((M + m)²g² + F²)
  const double fixed = 15.0 / 1500;
  const double two_a = 2 * (1 - c * c * g * g);
  const double half_b = -fixed - c * c * g * g * bare;
  const double rest = fixed * fixed - c * c * (bare * bare * g * g + drag * drag);
  const double root = (-2 * half_b + std::sqrt(4 * half_b * half_b - 2 * two_a * rest)) / two_a;
  CHECK(drag > 0.1 * bare * g);
  CHECK(p.battery_mass == Approx(root).epsilon(1e-9));
}

TEST_CASE("the battery is that of the wind, not of the flight, and grows with it") {
  Design design = design_with_battery();
  double before = 0;
  for (const double headwind : {0.0, 3.0, 6.0, 9.0}) {
    design.flight.headwind = headwind;
    const double hover = evaluate(design, 1.2e-6, Condition::hover).battery_mass;
    CHECK(hover > before);
    CHECK(evaluate(design, 1.2e-6, Condition::forward).battery_mass == hover);
    const FlightState low = flight_state_at(design, 5, 2);
    CHECK(SteadyFlight(design, low).battery_mass(std::sqrt(1.2e-6 / test::plain::pi)) ==
          Approx(hover).epsilon(1e-12));
    design.flight.headwind = -headwind;
    CHECK(evaluate(design, 1.2e-6, Condition::hover).battery_mass == hover);
    before = hover;
  }
}

TEST_CASE("thrust with a battery changes with the radius as its derivative says, in wind too") {
  test::each_random(300, [](test::Random& random) {
    Design design = test::random_design(random);
    design.drone.reserve_battery.specific_energy = random.uniform(80, 250) * watt_hour;
    design.flight.headwind = random.uniform(-8, 12);
    const SteadyFlight flight(design, Condition::forward);
    const double radius = random.magnitude(0.2e-3, 1e-3);
    const double step = 1e-5 * radius;
    const auto piece = [&](double r) { return flight.battery_piece(r); };
    if (!std::isfinite(flight.weight(radius + step)) ||
        piece(radius - step) != piece(radius + step))
      return;
    const auto thrust = [&](double r) { return flight.balance(r, 0).thrust.value; };
    const double slope = (thrust(radius + step) - thrust(radius - step)) / (2 * step);
    CHECK(flight.balance(radius, 0).thrust.slope == Approx(slope).epsilon(1e-5));
  });
}
