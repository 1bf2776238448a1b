#include "tethercalc/model/tether_heat.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Relative. Temperatures are exact to 1e-11 K, and a kelvin is 0.4 % of the resistance.
constexpr double same_current = 1e-12;

Surroundings around_airborne(const SteadyFlight& flight) {
  const Design& design = flight.design();
  Surroundings around;
  around.temperature_C = flight.state().ambient_temperature_C;
  around.air_density = design.flight.air_density;
  around.wind = std::abs(flight.state().airspeed);
  around.sun = design.tether.sun;
  around.gravity = design.flight.gravity;
  return around;
}

Surroundings around_wound(const SteadyFlight& flight) {
  Surroundings around = around_airborne(flight);
  const double derating = drum_derating(flight.design().tether.drum).value_or(1);
  around.wind = 0;
  around.sun = 0;
  around.cooling = derating * derating;
  return around;
}

}  // namespace

TetherHeat::TetherHeat(const SteadyFlight& flight, double radius)
    : flight_(flight),
      radius_(radius),
      measured_(flight.design().tether.heating.rise_per_loss > 0),
      wound_(flight.state().on_drum > 0 && drum_derating(flight.design().tether.drum).has_value()),
      in_air_(flight.design().tether, radius, flight.wall(), around_airborne(flight)),
      on_drum_(flight.design().tether, radius, flight.wall(), around_wound(flight)) {}

std::optional<TetherTemperatures> TetherHeat::temperatures(double current) const {
  const double ambient = flight_.state().ambient_temperature_C;
  Surfaces surfaces{ambient, ambient};
  return temperatures(current, surfaces);
}

std::optional<TetherTemperatures> TetherHeat::temperatures(double current,
                                                           Surfaces& surfaces) const {
  const Tether& tether = flight_.design().tether;
  if (measured_) {
    const double area = std::numbers::pi * radius_ * radius_;
    const double temperature = flight_.state().ambient_temperature_C +
                               settled_rise(tether, area, current, flight_.state().airspeed);
    if (!(temperature <= highest_conductor_temperature_C)) return std::nullopt;
    return TetherTemperatures{temperature, std::nullopt};
  }
  TetherTemperatures steady;
  const auto in_air = in_air_.temperature(current, surfaces.in_air_C);
  if (!in_air) return std::nullopt;
  steady.in_air = *in_air;
  if (!wound_) return steady;
  steady.on_drum = on_drum_.temperature(current, surfaces.on_drum_C);
  return steady.on_drum ? std::optional(steady) : std::nullopt;
}

double TetherHeat::resistance(const TetherTemperatures& t) const {
  return flight_.tether().resistance(radius_, t.in_air, t.on_drum.value_or(t.in_air));
}

TetherHeatState TetherHeat::carrying(double load_power) const {
  const double voltage = flight_.design().supply.voltage;
  const double ambient = flight_.state().ambient_temperature_C;
  TetherHeatState state;
  Surfaces surfaces{ambient, ambient};
  const auto demanded_current = [&](double resistance) {
    const double power = supplied_power(voltage, resistance, load_power);
    return power >= 0 ? power / voltage : infinity;
  };
  /// Current that the power asks for over the cable as warm as `current` makes it.
  const auto next = [&](double current) {
    const auto warm = temperatures(current, surfaces);
    if (!warm) return infinity;
    state.temperatures = *warm;
    state.resistance = resistance(*warm);
    return demanded_current(state.resistance);
  };

  double current = demanded_current(resistance({ambient, std::nullopt}));
  for (int step = 0; step < 100 && current < infinity; ++step) {
    const double after = next(current);
    state.current = after;
    if (std::abs(after - current) <= same_current * current) {
      state.steady = true;
      return state;
    }
    if (!(after < infinity)) break;
    const double beyond = next(after);
    const double slope = (beyond - after) / (after - current);
    if (!(slope < 1)) break;
    current = after + (beyond - after) / (1 - slope);
    // A secant is blind where rounding is all that is left of the differences.
    if (std::abs(beyond - after) <= same_current * after) current = beyond;
  }
  return {};
}

}  // namespace tethercalc
