#include "tethercalc/model/reserve_battery.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/operating_point.hpp"

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
    // Apart from how the mass was found: energy and power of that pack suffice, one of them barely.
    const double weight_per_motor =
        p.takeoff_mass * design.flight.gravity / design.drone.motor_count;
    const double power = design.drone.motor_count * design.drone.motor_power_factor *
                             design.drone.motor.power(weight_per_motor) +
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
