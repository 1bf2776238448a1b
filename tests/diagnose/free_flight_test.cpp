// Power logs of drones that fly without their tether. The truth is made here: momentum theory's
// P = k·T^1.5 a motor, the balance of weight and drag by bisection, and noise that lasts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

constexpr double factor = 11;  // W/N^1.5
constexpr double front_area = 0.03;
constexpr double gravity = 9.80665;

double curve_power(double thrust) { return factor * std::pow(thrust, 1.5); }

/// As specified: 2 kg, four motors, 20 W beside them.
Design battery_drone() {
  std::vector<MotorPoint> points;
  for (int i = 1; i <= 60; ++i) points.push_back({0.25 * i, curve_power(0.25 * i)});
  Design design;
  design.drone.mass = 2;
  design.drone.motor_count = 4;
  design.drone.motor = MotorCurve(points);
  design.drone.auxiliary_power = 20;
  design.drone.drag = {front_area, 0, 0, 0};
  design.tether.length = 50;
  design.tether.conductor = {0.0278e-6, 0.00403, 2700};
  design.tether.insulation = {1360, 0.75e-3};
  design.supply.voltage = 75;
  design.supply.converter = {{{0.0, 0.9}}, 20};
  design.flight.airspeed = 8;
  design.flight.air_density = 1.2;
  return design;
}

/// W of all motors at an airspeed.
double flown_power(double mass, double airspeed) {
  double low = 0;
  double high = 1.4;
  for (int i = 0; i < 60; ++i) {
    const double tilt = (low + high) / 2;
    const double drag = 0.5 * 1.2 * front_area * std::cos(tilt) * airspeed * airspeed;
    (drag > mass * gravity * std::tan(tilt) ? low : high) = tilt;
  }
  return 4 * curve_power(mass * gravity / std::cos(low) / 4);
}

/// Airspeeds in steps of a minute from 0 to 12 m/s and back, 15 minutes, once a second.
PowerLog log_of(double mass, std::uint64_t seed) {
  std::mt19937_64 dice(seed);
  std::normal_distribution<double> fresh;
  PowerLog log;
  log.free_flight = true;
  double lasting = 0;
  for (int i = 0; i < 900; ++i) {
    const int step = i / 60;
    const double airspeed = 1.7 * std::min(step, 14 - step);
    lasting = 0.8 * lasting + 0.006 * fresh(dice);
    const double power = (flown_power(mass, airspeed) + 20) * std::exp(lasting);
    log.time.push_back(i);
    log.airspeed.push_back(std::abs(airspeed + 0.1 * fresh(dice)));
    const double voltage = 16.8 - 0.002 * i;
    log.bus_voltage.push_back(voltage);
    log.bus_current.push_back(power / voltage);
  }
  return log;
}

}  // namespace

TEST_CASE("a free flight as specified has nothing to find, whatever the tether") {
  const PowerLog log = log_of(2, test::run_seed());
  Design design = battery_drone();
  const Diagnosis bare = diagnose_power(design, log).diagnosis;
  CHECK(bare.findings.empty());
  REQUIRE(bare.further.size() == 1);
  CHECK(bare.further.front().base_rmse < 1.6);  // %, the noise put in is 1 %

  // What stays on the ground neither weighs nor drags: not a digit changes.
  design.tether.length = 300;
  design.tether.cross_section = 4e-6;
  design.tether.winch_pull = 15;
  design.supply.converter.specific_mass = 0.5e-3;
  design.supply.converter.rated_output_power = 1000;
  const Diagnosis beside = diagnose_power(design, log).diagnosis;
  CHECK(beside.findings.empty());
  CHECK(beside.further.front().base_rmse == bare.further.front().base_rmse);
}

TEST_CASE("a free flight shows a payload, and what it cannot show of the tether") {
  int named = 0;
  int held = 0;
  constexpr int logs = 10;
  for (std::uint64_t k = 0; k < logs; ++k) {
    const Diagnosis d =
        diagnose_power(battery_drone(), log_of(2.3, 100 * test::run_seed() + k)).diagnosis;
    REQUIRE_FALSE(d.findings.empty());
    const Finding& first = d.findings.front();
    named += first.effect == "extra_mass" ||
             std::ranges::count(first.indistinguishable_from, "extra_mass") > 0;
    if (first.effect != "extra_mass") {
      ++held;  // told with its likes, its size is theirs
    } else {
      const ParameterEstimate& mass = first.parameters.front();
      if (mass.ci95_lower <= 0.3 && 0.3 <= mass.ci95_upper) ++held;
    }
    for (const char* id : {"tether_drag", "height_bias", "tether_sag", "winch_tension",
                           "contact_resistance", "converter_efficiency_curve"}) {
      const auto told = std::ranges::find(d.not_testable, id, &NotTestable::effect);
      REQUIRE(told != d.not_testable.end());
      CHECK(told->needs == "a flight on the tether");
    }
  }
  CHECK(named >= 8);
  CHECK(held >= 7);  // of 10 at 95 %: fewer once in 1000
}

TEST_CASE("ten samples a second tell what one a second tells") {
  const PowerLog slow = log_of(2.3, test::run_seed());
  PowerLog fast;
  fast.free_flight = true;
  for (std::size_t i = 0; i < slow.time.size(); ++i) {
    for (int k = 0; k < 10; ++k) {
      fast.time.push_back(slow.time[i] + 0.1 * k);
      // Odd parts cancel in the mean of ten.
      const double ripple = 1 + (k % 2 == 0 ? 1e-3 : -1e-3) * (1 + k / 2);
      fast.airspeed.push_back(slow.airspeed[i]);
      fast.bus_power.push_back(slow.bus_voltage[i] * slow.bus_current[i] * ripple);
    }
  }
  const Diagnosis of_slow = diagnose_power(battery_drone(), slow).diagnosis;
  const Diagnosis of_fast = diagnose_power(battery_drone(), fast).diagnosis;
  CHECK(of_fast.samples == 10 * of_slow.samples);
  REQUIRE(of_fast.findings.size() == of_slow.findings.size());
  CHECK(of_fast.findings.front().effect == of_slow.findings.front().effect);
  CHECK(of_fast.findings.front().parameters.front().value ==
        Approx(of_slow.findings.front().parameters.front().value).epsilon(0.02));
}

TEST_CASE("a free flight with a supply is a contradiction, and one without a bus shows nothing") {
  PowerLog log = log_of(2, 1);
  log.supply_voltage.assign(log.time.size(), 75);
  CHECK_THROWS_WITH(diagnose_power(battery_drone(), log), Contains("flies free has no supply"));
  log.supply_voltage.clear();
  log.bus_current.clear();
  CHECK_THROWS_WITH(diagnose_power(battery_drone(), log),
                    Contains("a free flight needs airspeed_m_s, bus_voltage_V, bus_current_A"));
}
