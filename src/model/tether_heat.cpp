#include "tethercalc/model/tether_heat.hpp"

#include <cmath>

#include "model/constants.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

/// Relative. Temperatures are exact to 1e-11 K, and a kelvin is 0.4 % of the resistance.
constexpr double same_current = 1e-12;

/// `width` of what the sun shines on, over that of the cable.
Surroundings around_airborne(const SteadyFlight& flight, double width) {
  const Design& design = flight.design();
  Surroundings around;
  around.temperature_C = flight.state().ambient_temperature_C;
  around.air_density = design.flight.air_density;
  around.wind = std::abs(flight.state().airspeed);
  around.sun = design.tether.sun * width;
  around.gravity = design.flight.gravity;
  return around;
}

Surroundings around_wound(const SteadyFlight& flight) {
  Surroundings around = around_airborne(flight, 0);
  const double derating = drum_derating(flight.design().tether.drum).value_or(1);
  around.wind = 0;
  around.cooling = derating * derating;
  return around;
}

}  // namespace

TetherHeat::TetherHeat(const SteadyFlight& flight, double radius, double sunlit_radius)
    : flight_(flight),
      radius_(radius),
      measured_(flight.design().tether.heating.rise_per_loss > 0),
      wound_(flight.state().on_drum > 0 && drum_derating(flight.design().tether.drum).has_value()),
      in_air_(flight.design().tether, radius, flight.wall(),
              around_airborne(flight, (sunlit_radius + flight.wall()) / (radius + flight.wall()))),
      on_drum_(flight.design().tether, radius, flight.wall(), around_wound(flight)) {}

TetherHeat::Surfaces TetherHeat::cold_surfaces() const {
  Surfaces surfaces;
  if (measured_) return surfaces;
  surfaces.in_air = in_air_.cold_surface();
  if (wound_) surfaces.on_drum = on_drum_.cold_surface();
  return surfaces;
}

TetherHeat::Surfaces TetherHeat::surfaces_like(const Surfaces& others) const {
  Surfaces surfaces;
  if (measured_) return surfaces;
  surfaces.in_air = in_air_.surface_like(others.in_air);
  if (wound_) surfaces.on_drum = on_drum_.surface_like(others.on_drum);
  return surfaces;
}

std::optional<TetherTemperatures> TetherHeat::temperatures(double current) const {
  Surfaces surfaces = cold_surfaces();
  const auto warm = warmed(current, surfaces);
  return warm ? std::optional(warm->temperatures) : std::nullopt;
}

std::optional<TetherHeat::Warm> TetherHeat::warmed(double current, Surfaces& surfaces) const {
  const Tether& tether = flight_.design().tether;
  Warm warm;
  double growth_on_drum = 0;
  double growth_in_air = 0;
  if (measured_) {
    const double area = conductor_area(radius_);
    const double rise = settled_rise(tether, area, current, flight_.state().airspeed);
    warm.temperatures.in_air = flight_.state().ambient_temperature_C + rise;
    if (!(warm.temperatures.in_air <= highest_conductor_temperature_C)) return std::nullopt;
    growth_in_air = 2 * rise / current;
  } else {
    const auto in_air = in_air_.steady_surface(current, surfaces.in_air);
    if (!in_air) return std::nullopt;
    surfaces.in_air = *in_air;
    warm.temperatures.in_air = in_air->inside_C;
    growth_in_air = in_air->warming;
  }
  growth_on_drum = growth_in_air;
  if (wound_ && !measured_) {
    const auto on_drum = on_drum_.steady_surface(current, surfaces.on_drum);
    if (!on_drum) return std::nullopt;
    surfaces.on_drum = *on_drum;
    warm.temperatures.on_drum = on_drum->inside_C;
    growth_on_drum = on_drum->warming;
  }
  // The resistance is linear in both temperatures.
  const StraightTether& loop = flight_.tether();
  warm.resistance_growth =
      loop.resistance(radius_, growth_in_air, growth_on_drum) - loop.resistance(radius_, 0, 0);
  return warm;
}

double TetherHeat::resistance(const TetherTemperatures& t) const {
  return flight_.tether().resistance(radius_, t.in_air, t.on_drum.value_or(t.in_air));
}

double TetherHeat::resistance_slope(const TetherHeatState& state) const {
  // The conductors' resistance goes about with a power of the radius.
  constexpr double step = 2e-6;
  const double contacts = flight_.tether().contact_resistance();
  const TetherHeat thicker(flight_, radius_ * (1 + step));
  Surfaces surfaces = thicker.surfaces_like(state.surfaces);
  const auto cooler = thicker.warmed(state.current, surfaces);
  if (!cooler) return flight_.tether().resistance_slope(radius_);
  const double line = state.resistance - contacts;
  const double power =
      std::log((thicker.resistance(cooler->temperatures) - contacts) / line) / std::log1p(step);
  return power * line / radius_;
}

double TetherHeat::demanded_current(double load_power, double resistance) const {
  const double voltage = flight_.design().supply.voltage;
  const double power = supplied_power(voltage, resistance, load_power);
  return power >= 0 ? power / voltage : infinity;
}

TetherHeatState TetherHeat::carrying(double load_power) const {
  const double current =
      demanded_current(load_power, resistance({flight_.state().ambient_temperature_C, {}}));
  return current < infinity ? settled(load_power, current, cold_surfaces()) : TetherHeatState{};
}

TetherHeatState TetherHeat::carrying(double load_power, const TetherHeatState& near) const {
  if (near.steady) {
    const TetherHeatState state = settled(load_power, near.current, surfaces_like(near.surfaces));
    if (state.steady) return state;
  }
  return carrying(load_power);
}

/// The state that Newton's steps from a current lead to. Where they overshoot it, which the air's
/// properties may make them do, they go back half-way.
TetherHeatState TetherHeat::settled(double load_power, double current,
                                    const Surfaces& surfaces) const {
  constexpr int most_retreats = 4;
  const double voltage = flight_.design().supply.voltage;
  TetherHeatState state;
  state.surfaces = surfaces;
  double lo = current;
  int retreats = 0;
  for (int step = 0; step < 100; ++step) {
    const auto warm = warmed(current, state.surfaces);
    double next = infinity;
    if (warm) {
      state.temperatures = warm->temperatures;
      state.resistance = resistance(warm->temperatures);
      state.current = demanded_current(load_power, state.resistance);
      const double change = state.current - current;
      // dI/dR = I²/(U − 2RI) of U·I − R·I² = P.
      const double slope = state.current * state.current /
                           (voltage - 2 * state.resistance * state.current) *
                           warm->resistance_growth;
      if (slope < 1) next = current + change / (1 - slope);
      if (std::abs(next - current) <= same_current * current) {
        state.steady = true;
        return state;
      }
      if (next > current) lo = current;
    }
    if (!(next > 0 && next < infinity)) {
      if (lo == current || ++retreats > most_retreats) return {};
      next = 0.5 * (lo + current);
    }
    current = next;
  }
  return {};
}

}  // namespace tethercalc
