// What the instruments of a power log should have read, and what effects change of it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "diagnose/power_chain.hpp"
#include "diagnose/power_screening.hpp"
#include "model/constants.hpp"
#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/operating_point.hpp"

using namespace tethercalc;

namespace {

PowerLog drawn_log(test::Random& random) {
  PowerLog log;
  for (int i = 0; i < 40; ++i) {
    log.time.push_back(4.0 * i);
    log.height.push_back(random.uniform(5, 30));
    log.airspeed.push_back(random.uniform(0, 9));
    log.ambient_temperature_C.push_back(random.uniform(5, 30));
    log.supply_voltage.push_back(random.uniform(74, 76));
    log.supply_current.push_back(random.uniform(5, 7));
    log.drone_voltage.push_back(random.uniform(60, 70));
    log.bus_voltage.push_back(random.uniform(15, 17));
    log.bus_current.push_back(random.uniform(15, 30));
  }
  return log;
}

/// All that the comparisons of the three stages take from the model.
std::vector<double> predictions(const PowerModel& model, const PowerLog& read) {
  ChainMemory memory;
  const PowerLog log = without_errors(read, model.instruments);
  std::vector<double> all = loop_resistance(model, log, memory);
  const std::vector<double> power = motor_power(model, log, memory.loads);
  all.insert(all.end(), power.begin(), power.end());
  for (const double output : bus_power_of(log)) {
    all.push_back(model.design.drone.auxiliary_power +
                  converter_input_power(model.design.supply.converter, output));
  }
  for (const auto* channel : {&log.supply_voltage, &log.supply_current, &log.drone_voltage,
                              &log.bus_voltage, &log.bus_current, &log.height, &log.airspeed}) {
    all.insert(all.end(), channel->begin(), channel->end());
  }
  return all;
}

std::vector<double> neutral_values(const Effect& effect, const Design& design) {
  std::vector<double> values;
  for (const EffectParameter& p : effect.parameters) {
    values.push_back(p.in_design != nullptr ? p.in_design(design) : p.neutral * p.unit_SI);
  }
  return values;
}

/// Relative; infinite where a prediction is none any more, as of a cable that cannot hang.
double largest_change(const std::vector<double>& before, const std::vector<double>& after) {
  REQUIRE(before.size() == after.size());
  double largest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!std::isfinite(before[i]) && !std::isfinite(after[i])) continue;
    const double change = std::abs(after[i] - before[i]) / std::abs(before[i]);
    largest = std::max(largest, std::isfinite(change) ? change : infinity);
  }
  return largest;
}

/// In a design that has some of what effects are about already.
Design drawn_design(test::Random& random) {
  Design design = test::published_design();
  design.tether.cross_section = random.uniform(0.9e-6, 1.5e-6);
  design.tether.conductor.temperature_coefficient = 0.004;
  design.flight.air_density = random.uniform(1, 1.3);
  if (random.chance(0.5)) design.tether.heating = {random.uniform(5, 12), 100, 0.3};
  if (random.chance(0.5)) design.supply.converter.losses = {random.uniform(1, 10), 1e-4};
  if (random.chance(0.5)) design.drone.translational_lift = {random.uniform(0.1, 0.5), 6};
  if (random.chance(0.5)) design.drone.motor_air_density = 1.2;
  if (random.chance(0.5)) design.tether.winch_pull = random.uniform(0, 3);
  if (random.chance(0.5)) design.tether.spooled_length = random.uniform(0, 30);
  if (random.chance(0.5)) design.tether.contact_resistance = random.uniform(0, 0.5);
  if (random.chance(0.3)) {
    design.tether.model = TetherModel::solved;
    design.tether.winch_pull = 0;  // slack hangs in its place
    design.tether.slack = random.uniform(0.02, 0.1);
  }
  return design;
}

}  // namespace

TEST_CASE("a power effect at its neutral values changes no prediction, beyond it every one does") {
  test::each_random(test::draws(6), [](test::Random& random) {
    const PowerLog log = drawn_log(random);
    const PowerModel model{.design = drawn_design(random)};
    const std::vector<double> plain = predictions(model, log);
    const auto exist = std::ranges::count_if(plain, [](double x) { return std::isfinite(x); });
    REQUIRE(static_cast<double>(exist) > 0.8 * static_cast<double>(plain.size()));
    for (const Effect& effect : effect_catalogue(LogKind::power)) {
      INFO(effect.id);
      std::vector<double> values = neutral_values(effect, model.design);
      PowerModel neutral = model;
      effect.on_power(neutral, values);
      CHECK(largest_change(plain, predictions(neutral, log)) < 1e-12);
      // A cable that heats has a temperature of its own.
      if (effect.id == "cable_temperature" && is_heated(model.design.tether)) continue;
      values[0] += effect.parameters[0].scale * effect.parameters[0].unit_SI;
      PowerModel changed = model;
      effect.on_power(changed, values);
      CHECK(largest_change(plain, predictions(changed, log)) > 1e-9);
    }
  });
}

TEST_CASE("without drag a drone that accelerates draws what a heavier one does at rest") {
  test::each_random(20, [](test::Random& random) {
    Design design = test::published_design();
    design.drone.drag.front_area = 0;
    design.drone.drag.top_area = 0;
    PowerLog log;
    log.free_flight = true;
    log.time = {0, 1};
    log.airspeed = {0, random.uniform(0, 9)};
    PowerLog accelerating = log;
    const double along = random.uniform(-5, 5);
    const double across = random.uniform(-5, 5);
    accelerating.acceleration_along = {0, along};
    accelerating.acceleration_across = {0, across};
    const PowerModel light{.design = design};
    PowerModel heavy = light;
    const double gravity = design.flight.gravity;
    heavy.design.drone.mass *= std::hypot(along, across, gravity) / gravity;
    HangingLoads loads;
    const std::vector<double> drawn = motor_power(light, accelerating, loads);
    CHECK(drawn[0] == Approx(motor_power(light, log, loads)[0]).epsilon(1e-12));
    CHECK(drawn[1] == Approx(motor_power(heavy, log, loads)[1]).epsilon(1e-9));
  });
}

TEST_CASE("means over a second keep the mean square of the acceleration, whichever part is told") {
  PowerLog log;
  log.free_flight = true;
  for (int i = 0; i < 40; ++i) {
    log.time.push_back(0.25 * i);
    log.airspeed.push_back(3);
    log.bus_power.push_back(300);
  }
  const std::vector<double> to_and_fro{4, -4, 2, 2};
  const auto averaged = [&](std::vector<double> PowerLog::*part) {
    ScreenedPowerLog screened{log, {{Stage::motors, std::vector<char>(40, 1)}}, {}};
    for (std::size_t i = 0; i < 40; ++i) (screened.log.*part).push_back(to_and_fro[i % 4]);
    average_fast_samples(screened);
    return screened.log;
  };
  const PowerLog along = averaged(&PowerLog::acceleration_along);
  REQUIRE(along.time.size() == 10);
  CHECK(along.acceleration_along[3] == Approx(1));
  CHECK(along.acceleration_across[3] == Approx(3));  // 40/4 less 1, and its root
  const PowerLog across = averaged(&PowerLog::acceleration_across);
  CHECK(across.acceleration_along[3] == 0);
  CHECK(across.acceleration_across[3] == Approx(std::sqrt(10)));
}

TEST_CASE("of flights judged together one that tells no acceleration was steady") {
  PowerLog told;
  told.free_flight = true;
  told.time = {0, 1};
  told.airspeed = {3, 4};
  told.bus_power = {300, 310};
  told.acceleration_along = {1, 2};
  PowerLog untold = told;
  untold.acceleration_along.clear();
  PowerLog first = told;
  append_flight(first, untold);
  CHECK(first.acceleration_along == std::vector<double>{1, 2, 0, 0});
  PowerLog last = untold;
  append_flight(last, told);
  CHECK(last.acceleration_along == std::vector<double>{0, 0, 1, 2});
  CHECK(last.acceleration_across.empty());
}

TEST_CASE("the drum warms as in the simulation with what a hanging cable leaves on it") {
  test::each_random(6, [](test::Random& random) {
    Design design = test::published_design();
    const double area = random.uniform(0.9e-6, 1.5e-6);
    design.tether.cross_section = area;
    design.tether.conductor.temperature_coefficient = 0.004;
    design.tether.ambient_temperature_C = 20;
    design.tether.model = TetherModel::solved;
    design.tether.slack = random.uniform(0.2, 0.4);
    design.tether.spooled_length = random.uniform(15, 30);
    design.tether.drum.core_diameter = 0.1;
    design.tether.drum.width = 0.03;
    design.supply.voltage = 150;
    PowerLog log;
    std::vector<double> resistance;
    for (const double height : {8.0, 15.0, 25.0}) {
      const FlightState state = flight_state_at(design, height, random.uniform(3, 9), {});
      const OperatingPoint point = evaluate(design, area, state);
      REQUIRE(point.total_power > 0);
      resistance.push_back(point.tether_resistance);
      log.time.push_back(height);
      log.height.push_back(height);
      log.airspeed.push_back(state.airspeed);
      log.supply_current.push_back(point.current);
    }
    ChainMemory memory;
    CHECK(largest_change(resistance, loop_resistance({.design = design}, log, memory)) < 1e-5);
  });
}
