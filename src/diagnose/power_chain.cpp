#include "tethercalc/diagnose/power_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

/// Ω per metre of loop at the spec's conductor temperature with the conductor at `temperature_C`.
double loop_ohm_per_metre(const Tether& tether, double temperature_C) {
  return 2 * resistivity(tether.conductor, temperature_C) / *tether.cross_section;
}

double settled_rise(const ConductorHeating& heating, double watts_per_metre, double airspeed) {
  return heating.rise_per_loss * watts_per_metre /
         (1 + heating.wind_cooling * std::sqrt(std::abs(airspeed)));
}

/// Rise over ambient in K at every sample. Between two samples the settled rise is taken constant,
/// for which the first-order lag has an exact step.
std::vector<double> temperature_rise(const PowerModel& model, const PowerLog& log) {
  const ConductorHeating& heating = *model.heating;
  const double ohm_per_metre = loop_ohm_per_metre(model.design.tether, 20);
  std::vector<double> rise(log.time.size());
  double now = 0;
  double interval = 0;
  double share = 0;
  for (std::size_t i = 0; i + 1 < log.time.size(); ++i) {
    rise[i] = now;
    const double current = log.supply_current[i] / model.supply_current_gain;
    const double settled =
        settled_rise(heating, current * current * ohm_per_metre, log.airspeed[i]);
    const double next_interval = log.time[i + 1] - log.time[i];
    if (next_interval != interval) {
      interval = next_interval;
      share = -std::expm1(-interval / heating.time_constant);
    }
    now += (settled - now) * share;
  }
  if (!rise.empty()) rise.back() = now;
  return rise;
}

/// The data sheet's curve, continued straight above its last point.
double motor_curve_power(const MotorCurve& motor, double thrust) {
  if (thrust <= motor.max_thrust()) return motor.power(thrust);
  const auto points = motor.vertices();
  if (points.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const MotorPoint& last = points[points.size() - 1];
  const MotorPoint& before = points[points.size() - 2];
  return last.power +
         (thrust - last.thrust) * (last.power - before.power) / (last.thrust - before.thrust);
}

}  // namespace

std::vector<double> loop_resistance(const PowerModel& model, const PowerLog& log) {
  const Tether& tether = model.design.tether;
  const bool drum = tether.spooled_length > 0;
  const double cable = tether.length + tether.spooled_length;
  const double cold = loop_ohm_per_metre(tether, 20);
  const double spec = loop_ohm_per_metre(tether, tether.conductor_temperature_C);
  std::vector<double> rise;
  if (model.heating) rise = temperature_rise(model, log);

  std::vector<double> resistance(log.time.size());
  for (std::size_t i = 0; i < resistance.size(); ++i) {
    double ohm_per_metre = spec;
    if (model.heating) {
      const double ambient = log.ambient_temperature_C.empty() ? tether.conductor_temperature_C
                                                               : log.ambient_temperature_C[i];
      ohm_per_metre =
          cold * (1 + tether.conductor.temperature_coefficient * (ambient + rise[i] - 20));
    }
    const double length = drum ? std::max(cable, log.height[i]) : log.height[i];
    resistance[i] = ohm_per_metre * length + tether.contact_resistance;
  }
  return resistance;
}

ConverterInput converter_input(const PowerModel& model, double output_power) {
  if (model.converter_losses) {
    const ConverterLosses& losses = *model.converter_losses;
    return {output_power + losses.fixed + losses.square * output_power * output_power,
            1 + 2 * losses.square * output_power};
  }
  const Converter& converter = model.design.supply.converter;
  const double power = converter_input_power(converter, output_power);
  // The curve is piecewise smooth: a difference over 1 W is its slope wherever it matters.
  return {power, converter_input_power(converter, output_power + 1) - power};
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
    const SteadyFlight steady(model.design,
                              flight_state_at(model.design, log.height[i], log.airspeed[i]));
    tan_pitch = steady.tan_pitch(radius, tan_limit, tan_pitch);
    if (!std::isfinite(tan_pitch)) {
      power[i] = std::numeric_limits<double>::quiet_NaN();
      tan_pitch = 0;
      continue;
    }
    power[i] = steady.output_power(
        motor_curve_power(drone.motor, steady.necessary_thrust(radius, tan_pitch)));
  }
  return power;
}

Design lasting_design(const PowerModel& model, const FlownRange& flown) {
  Design design = model.design;
  // What the payload draws less than nothing is another's error; a spec cannot hold it.
  design.drone.auxiliary_power = std::max(0.0, design.drone.auxiliary_power);
  if (model.heating) {
    const double ohm_per_metre = loop_ohm_per_metre(design.tether, 20);
    constexpr double hottest = 250;  // °C, the spec's limit: no insulation stands more
    design.tether.conductor_temperature_C = std::min(
        hottest, flown.ambient_temperature_C +
                     settled_rise(*model.heating, flown.current * flown.current * ohm_per_metre,
                                  flown.airspeed));
  }
  if (model.converter_losses) {
    // 24 points: linear between them, the efficiency is then within 1e-3 of the formula.
    constexpr int points = 24;
    const double lowest = 0.5 * flown.lowest_output;
    const double highest = 2 * flown.highest_output;
    design.supply.converter.efficiency.clear();
    for (int i = 0; i < points; ++i) {
      const double output = lowest * std::pow(highest / lowest, i / (points - 1.0));
      design.supply.converter.efficiency.push_back(
          {output, output / converter_input(model, output).power});
    }
  }
  return design;
}

}  // namespace tethercalc
