#include "diagnose/power_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/constants.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

FlightState state_at(const PowerModel& model, const PowerLog& log, std::size_t i) {
  std::optional<double> ambient;
  if (!log.ambient_temperature_C.empty()) ambient = log.ambient_temperature_C[i];
  // A drone on the ground may be read to be below it.
  const double deployed = log.free_flight ? 0 : (1 + model.slack) * std::max(0.0, log.height[i]);
  return flight_state_at(model.design, deployed, log.airspeed[i], ambient);
}

/// m/s upwards at each sample: the slope of a straight line through the heights nearby, which
/// averages what an altimeter adds.
std::vector<double> climb_speed(const PowerLog& log) {
  constexpr double nearby = 4;  // s, less than lies between flights that are judged together
  const std::vector<double>& time = log.time;
  const std::vector<double>& height = log.height;
  std::vector<double> speed(time.size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    while (time[first] < time[i] - nearby) ++first;
    double n = 0, t = 0, h = 0, tt = 0, th = 0;
    for (std::size_t k = first; k < time.size() && time[k] <= time[i] + nearby; ++k) {
      const double later = time[k] - time[i];
      const double higher = height[k] - height[i];
      n += 1;
      t += later;
      h += higher;
      tt += later * later;
      th += later * higher;
    }
    const double spread = n * tt - t * t;
    if (spread > 0) speed[i] = (n * th - t * h) / spread;
  }
  return speed;
}

/// °C of a cable without heat at each sample, `share` of the way from the spec's temperature to the
/// air's: as the air was over a minute before and after, no faster does a cable follow.
/// Empty where that is the spec's.
std::vector<double> temperature_in_air(const PowerLog& log, double in_spec, double share) {
  constexpr double nearby = 60;  // s
  const std::vector<double>& air = log.ambient_temperature_C;
  if (share == 0 || air.empty()) return {};
  std::vector<double> temperature(log.time.size(), in_spec);
  std::size_t first = 0;
  std::size_t end = 0;
  double sum = 0;
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    while (end < air.size() && log.time[end] <= log.time[i] + nearby) sum += air[end++] - in_spec;
    while (log.time[first] < log.time[i] - nearby) sum -= air[first++] - in_spec;
    temperature[i] += share * sum / static_cast<double>(end - first);
  }
  return temperature;
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

void check_flies_free(const PowerLog& log) {
  if (!log.free_flight || (log.supply_voltage.empty() && log.supply_current.empty())) return;
  throw std::invalid_argument(
      "a drone that flies free has no supply, but the log has supply_voltage_V or "
      "supply_current_A; was it flown on the tether?");
}

void append_flight(PowerLog& all, const PowerLog& flight) {
  if (all.time.empty()) {
    all = flight;
    return;
  }
  for (const PowerChannel& channel : power_channels) {
    if ((all.*channel.values).empty() == (flight.*channel.values).empty() || channel.of_motion) {
      continue;
    }
    throw std::invalid_argument(
        fmt::format("{} {}, unlike the log before: flights that are judged together need the same "
                    "channels",
                    (flight.*channel.values).empty() ? "lacks" : "has", channel.name));
  }
  constexpr double apart = 5;  // s, more than any step within a log
  const double later = all.time.back() + apart - flight.time.front();
  const std::size_t before = all.time.size();
  for (const double time : flight.time) all.time.push_back(time + later);
  for (const PowerChannel& channel : power_channels) {
    auto& values = all.*channel.values;
    const auto& further = flight.*channel.values;
    if (values.empty() && further.empty()) continue;
    values.resize(before);
    values.insert(values.end(), further.begin(), further.end());
    values.resize(all.time.size());
  }
}

Design without_tether(Design design) {
  design.tether.model = TetherModel::straight;
  design.tether.winch_pull = 0;
  design.tether.cross_section = design.tether.cross_section.value_or(0);
  design.supply.converter.specific_mass = 0;
  design.supply.converter.masses.clear();
  design.drone.reserve_battery.specific_energy = 0;
  return design;
}

PowerLog without_errors(PowerLog log, const PowerInstruments& instruments) {
  const auto correct = [](std::vector<double>& readings, double gain, double offset) {
    if (gain == 1 && offset == 0) return;
    for (double& x : readings) x = (x - offset) / gain;
  };
  correct(log.supply_voltage, instruments.supply_voltage_gain, 0);
  correct(log.supply_current, instruments.supply_current_gain, instruments.supply_current_offset);
  correct(log.drone_voltage, 1, instruments.drone_voltage_offset);
  correct(log.bus_current, instruments.bus_current_gain, 0);
  correct(log.height, 1, instruments.height_offset);
  correct(log.airspeed, instruments.airspeed_gain, 0);
  return log;
}

const std::vector<std::optional<TetherTemperatures>>& CableHeat::temperatures(
    const PowerModel& model, const PowerLog& log, HangingLoads& loads) {
  const Design& design = model.design;
  // What a search moves most often and no heat depends on, at the measured current, is left out.
  Tether tether = design.tether;
  tether.contact_resistance = 0;
  if (tether.model == TetherModel::straight) {
    tether.drag_coefficient = tether.winch_pull = tether.slack = 0;
  }
  PowerInstruments instruments = model.instruments;
  instruments.supply_voltage_gain = instruments.bus_current_gain = 1;
  instruments.drone_voltage_offset = 0;
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.tether == tether && known.flight == design.flight &&
           known.supply_voltage == design.supply.voltage && known.instruments == instruments &&
           known.slack == model.slack;
  });
  if (found != known_.end()) {
    std::rotate(known_.begin(), found, found + 1);
    return known_.front().temperatures;
  }
  constexpr std::size_t kept = 8;  // more than a slope by every parameter looks back
  if (known_.size() == kept) known_.pop_back();
  Known& latest = known_.emplace_front(
      Known{std::move(tether), design.flight, design.supply.voltage, instruments, model.slack, {}});
  FlownDesign flown(design, loads);
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const SteadyFlight* hangs = flown.in(state_at(model, log, i));
    auto& warm = latest.temperatures.emplace_back();
    if (hangs == nullptr) continue;
    warm = TetherHeat(*hangs, flown.radius()).temperatures(std::abs(log.supply_current[i]));
  }
  return latest.temperatures;
}

FlownDesign::FlownDesign(const Design& design, HangingLoads& loads)
    : design_(design),
      loads_(loads),
      radius_(conductor_radius(*design.tether.cross_section)),
      wall_(insulation_wall(design.tether.insulation, design.supply.voltage)) {
  if (design.tether.model == TetherModel::straight) return;
  hanging_ = design.tether;
  design_.tether.model = TetherModel::straight;
}

std::optional<FlightState> FlownDesign::laid_straight(const FlightState& state) {
  hanging_drag_.reset();
  // On the ground nothing hangs.
  if (!hanging_ || !(state.deployed > 0)) {
    if (hanging_) design_.tether.winch_pull = hanging_->winch_pull;
    return state;
  }
  const HangingLoad::Parts load =
      loads_.at(hanging_situation(*hanging_, wall_, state, design_.flight), radius_);
  if (!std::isfinite(load.length)) return std::nullopt;
  const FlightState as_long =
      flight_state_at(design_, load.length, state.airspeed, state.ambient_temperature_C);
  design_.tether.winch_pull = 0;
  const StraightTether cable(design_.tether, wall_, as_long, design_.flight.air_density,
                             design_.flight.gravity);
  design_.tether.winch_pull = load.down - cable.mass(radius_) * design_.flight.gravity;
  hanging_drag_ = load.along;
  return as_long;
}

const SteadyFlight* FlownDesign::in(const FlightState& state) {
  const auto flown = laid_straight(state);
  return flown ? &steady_.emplace(design_, *flown) : nullptr;
}

const TetherInFlight* FlownDesign::tether_in(const FlightState& state) {
  const auto flown = laid_straight(state);
  return flown ? &tether_.emplace(design_.tether, wall_, *flown, design_.flight) : nullptr;
}

double FlownDesign::tan_pitch(double limit, double guess) const {
  const double drag = hanging_drag_.value_or(steady_->tether().drag(radius_));
  return steady_->tan_pitch_against(drag, weight(), limit, guess);
}

std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log,
                                    ChainMemory& memory) {
  const Tether& tether = model.design.tether;
  const bool measured = tether.heating.rise_per_loss > 0;
  const auto* warm = is_heated(tether) && !measured
                         ? &memory.heat.temperatures(model, log, memory.loads)
                         : nullptr;
  const std::vector<double> in_air =
      temperature_in_air(log, tether.conductor_temperature_C, model.air_share);
  double rise = 0;  // K over the air, of a cable whose heating was measured
  std::vector<double> resistance(log.time.size());
  FlownDesign flown(model.design, memory.loads);
  const double radius = flown.radius();
  for (std::size_t i = 0; i < resistance.size(); ++i) {
    const FlightState state = state_at(model, log, i);
    const TetherInFlight* hangs = flown.tether_in(state);
    if (hangs == nullptr) {
      resistance[i] = nan;
      continue;
    }
    if (!is_heated(tether)) {
      resistance[i] = in_air.empty() ? hangs->resistance(radius)
                                     : hangs->resistance(radius, in_air[i], in_air[i]);
    } else if (measured) {
      const double temperature = state.ambient_temperature_C + rise;
      resistance[i] = hangs->resistance(radius, temperature, temperature);
      if (i + 1 == resistance.size()) break;
      // What settles is taken constant up to the next sample; the lag then has an exact step.
      const double settled =
          settled_rise(tether, *tether.cross_section, log.supply_current[i], log.airspeed[i]);
      rise += (rise - settled) *
              std::expm1((log.time[i] - log.time[i + 1]) / tether.heating.time_constant);
    } else {
      const auto& t = (*warm)[i];
      resistance[i] =
          t ? hangs->resistance(radius, t->in_air, t->on_drum.value_or(t->in_air)) : nan;
    }
  }
  return resistance;
}

namespace {

/// Tangent of the tilt that also accelerates `mass` kg as the drone was in sample `i`, where it
/// would be `steady` without; `weight` is what the motors carry, N.
double accelerated(double steady, const PowerLog& log, std::size_t i, double mass, double weight) {
  const auto share = [&](const std::vector<double>& acceleration) {
    return acceleration.empty() ? 0 : mass * acceleration[i] / weight;
  };
  return std::hypot(steady + share(log.acceleration_along), share(log.acceleration_across));
}

}  // namespace

std::vector<double> motor_power(const PowerModel& model, const PowerLog& log, HangingLoads& loads) {
  std::optional<Design> freed;
  if (log.free_flight) freed = without_tether(model.design);
  const Design& design = freed ? *freed : model.design;
  const double mass = design.drone.mass;
  const double beside_motors = freed ? design.drone.auxiliary_power : 0;
  // What was flown was flown: the design's limit of the tilt is no physics. At 80° the thrust is
  // six times the weight, which no drone has that also lifts a tether.
  constexpr double tan_limit = 6;

  constexpr double least_part = 0.1;  // of the drone that stays: less would fly no better
  const double lighter = std::max(least_part * mass, mass - model.dropped_mass);
  FlownDesign flown(design, loads);

  std::vector<double> power(log.time.size());
  const double duration = log.time.back() - log.time.front();
  const std::vector<double> climb =
      model.climb_work == 0 ? std::vector<double>{} : climb_speed(log);
  double tan_pitch = 0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    const bool dropped = model.dropped_mass != 0 && log.time[i] >= model.drop_time;
    const double flown_mass = dropped ? lighter : mass;
    flown.set_mass(flown_mass);
    const SteadyFlight* hangs = flown.in(state_at(model, log, i));
    tan_pitch = hangs != nullptr ? flown.tan_pitch(tan_limit, tan_pitch) : infinity;
    if (!std::isfinite(tan_pitch)) {
      power[i] = nan;
      tan_pitch = 0;
      continue;
    }
    const SteadyFlight& steady = *hangs;
    const double weight = flown.weight();
    const double grown = 1 + model.motor_power_growth * (log.time[i] - log.time.front()) / duration;
    const double thrust =
        steady.necessary_thrust(weight, accelerated(tan_pitch, log, i, flown_mass, weight));
    power[i] = grown * steady.output_power(motor_curve_power(steady.motor(), thrust),
                                           steady.power_share(tan_pitch).value) +
               beside_motors;
    if (!climb.empty()) power[i] += model.climb_work * weight * climb[i];
    const double rest = power[i];
    for (const auto& added : model.added_power) power[i] += added(model, log, i, rest);
  }
  return power;
}

}  // namespace tethercalc
