#include "hidden_effects/one_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "hidden_effects/power_scenarios.hpp"
#include "hidden_effects/simulated_flight.hpp"

namespace tethercalc::truth {

DiagnosisQuestion one_flight_of(const HiddenDrone& hidden) {
  std::mt19937_64 random(hidden.seed);
  const auto between = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  power_truth::Scenario scenario;
  scenario.hidden = hidden.effects;
  scenario.seed = hidden.seed;
  const power_truth::Rig& rig = scenario.rig;
  const power_truth::Cable cable = power_truth::cable_at(rig, hidden.height);
  const double drag = rig.drag_scale * hidden.effects.airframe_drag_factor;

  HiddenFlight flight;
  flight.seed = hidden.seed;
  flight.mass = rig.mass + hidden.effects.extra_mass + cable.mass;
  flight.air_density = rig.air_density;
  flight.front_area = flight.side_area = 0.01451 * drag;
  flight.top_area = 0.01361 * drag;
  flight.linear = 19.27;
  flight.tether_area = cable.drag_area * hidden.effects.tether_drag_factor;
  flight.wind = between(-1.5, 1.5);
  flight.crosswind = between(-0.5, 0.5);
  flight.course_acceleration = hidden.acceleration;
  flight.steps_per_sample = 40;
  constexpr std::array<double, 3> speeds{3, 6, 9};
  for (int pass = 0; pass < hidden.passes; ++pass) {
    const double speed = speeds[static_cast<std::size_t>(pass / 2) % speeds.size()];
    const double way = pass % 2 == 0 ? 1 : -1;
    flight.course.push_back({.ahead = way * 12 * speed, .speed = speed, .hold = between(4, 16)});
  }

  Flown flown;
  DiagnosisQuestion question{power_truth::spec(rig)};
  question.flight = LoggedFlight{{MeasuredFlight{fly(flight, &flown)}}};
  question.one_flight = true;

  scenario.track.height.assign(flown.airspeed.size(), hidden.height);
  scenario.track.airspeed = std::move(flown.airspeed);
  for (const double lift : flown.specific_lift) {
    scenario.track.thrust.push_back(flight.mass * lift);
    scenario.track.tilt.push_back(std::acos(std::min(1.0, 9.80665 / lift)));
  }
  question.power = LoggedPower{power_truth::as_power_log(power_truth::simulate(scenario))};
  question.power->log.acceleration_along = std::move(flown.speeding_up);
  question.power->log.acceleration_across = std::move(flown.turning_off);
  if (!hidden.whole_chain) question.power->log.drone_voltage.clear();
  return question;
}

}  // namespace tethercalc::truth
