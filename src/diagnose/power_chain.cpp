#include "diagnose/power_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/constants.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

FlightState state_at(const Design& design, const PowerLog& log, std::size_t i) {
  std::optional<double> ambient;
  if (!log.ambient_temperature_C.empty()) ambient = log.ambient_temperature_C[i];
  return flight_state_at(design, log.height[i], log.airspeed[i], ambient);
}

/// The data sheet's curve, continued straight above its last point.
double motor_curve_power(const MotorCurve& motor, double thrust) {
  if (thrust <= motor.max_thrust()) return motor.power(thrust);
  const auto points = motor.vertices();
  if (points.size() < 2) return nan;
  const MotorPoint& last = points[points.size() - 1];
  const MotorPoint& before = points[points.size() - 2];
  return last.power +
         (thrust - last.thrust) * (last.power - before.power) / (last.thrust - before.thrust);
}

}  // namespace

const std::vector<std::optional<TetherTemperatures>>& CableHeat::temperatures(
    const PowerModel& model, const PowerLog& log) {
  const Design& design = model.design;
  const double radius = conductor_radius(*design.tether.cross_section);
  // What a search moves most often and no heat depends on, at the measured current, is left out.
  Tether tether = design.tether;
  tether.contact_resistance = tether.drag_coefficient = tether.winch_pull = 0;
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.tether == tether && known.flight == design.flight &&
           known.supply_voltage == design.supply.voltage &&
           known.supply_current_gain == model.supply_current_gain;
  });
  if (found != known_.end()) {
    std::rotate(known_.begin(), found, found + 1);
    return known_.front().temperatures;
  }
  constexpr std::size_t kept = 8;  // more than a slope by every parameter looks back
  if (known_.size() == kept) known_.pop_back();
  Known& latest = known_.emplace_front(Known{
      std::move(tether), design.flight, design.supply.voltage, model.supply_current_gain, {}});
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const SteadyFlight flight(design, state_at(design, log, i));
    const double current = log.supply_current[i] / model.supply_current_gain;
    latest.temperatures.push_back(TetherHeat(flight, radius).temperatures(std::abs(current)));
  }
  return latest.temperatures;
}

std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log, CableHeat& heat) {
  const Tether& tether = model.design.tether;
  const double radius = conductor_radius(*tether.cross_section);
  const bool measured = tether.heating.rise_per_loss > 0;
  const auto* warm = is_heated(tether) && !measured ? &heat.temperatures(model, log) : nullptr;
  double rise = 0;  // K over the air, of a cable whose heating was measured
  std::vector<double> resistance(log.time.size());
  for (std::size_t i = 0; i < resistance.size(); ++i) {
    const SteadyFlight flight(model.design, state_at(model.design, log, i));
    const double current = log.supply_current[i] / model.supply_current_gain;
    if (!is_heated(tether)) {
      resistance[i] = flight.tether().resistance(radius);
    } else if (measured) {
      const double temperature = flight.state().ambient_temperature_C + rise;
      resistance[i] = flight.tether().resistance(radius, temperature, temperature);
      if (i + 1 == resistance.size()) break;
      // What settles is taken constant up to the next sample; the lag then has an exact step.
      const double settled = settled_rise(tether, *tether.cross_section, current, log.airspeed[i]);
      rise += (rise - settled) *
              std::expm1((log.time[i] - log.time[i + 1]) / tether.heating.time_constant);
    } else {
      const auto& t = (*warm)[i];
      resistance[i] =
          t ? flight.tether().resistance(radius, t->in_air, t->on_drum.value_or(t->in_air)) : nan;
    }
  }
  return resistance;
}

std::vector<double> motor_power(const PowerModel& model, const PowerLog& log) {
  const Drone& drone = model.design.drone;
  const double radius = conductor_radius(*model.design.tether.cross_section);
  // What was flown was flown: the design's limit of the tilt is no physics. At 80° the thrust is
  // six times the weight, which no drone has that also lifts a tether.
  constexpr double tan_limit = 6;

  std::vector<double> power(log.time.size());
  double tan_pitch = 0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    const SteadyFlight steady(model.design, state_at(model.design, log, i));
    const double weight = steady.weight(radius);
    tan_pitch = steady.tan_pitch(radius, weight, tan_limit, tan_pitch);
    if (!std::isfinite(tan_pitch)) {
      power[i] = nan;
      tan_pitch = 0;
      continue;
    }
    power[i] = steady.output_power(
        motor_curve_power(drone.motor, steady.necessary_thrust(weight, tan_pitch)));
  }
  return power;
}

}  // namespace tethercalc
