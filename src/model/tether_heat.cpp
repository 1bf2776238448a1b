#include "model/tether_heat.hpp"

#include <algorithm>
#include <cmath>

#include "model/constants.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

/// Relative. Temperatures are exact to 1e-11 K, and a kelvin is 0.4 % of the resistance.
constexpr double same_current = 1e-12;

/// m. A drone on the ground has no cable in the air, and none that convection could be high along.
constexpr double shortest_hanging = 0.1;

/// `width` of what the sun shines on, over that of the cable.
Surroundings around_airborne(const SteadyFlight& flight, double width) {
  const Design& design = flight.design();
  Surroundings around;
  around.temperature_C = flight.state().ambient_temperature_C;
  around.air_density = design.flight.air_density;
  around.wind = std::abs(flight.state().airspeed);
  around.sun = design.tether.sun * width;
  around.gravity = design.flight.gravity;
  around.inclination = design.tether.inclination;
  around.length = std::max(shortest_hanging, flight.state().deployed);
  return around;
}

/// Whether the wound part is cooled as its package is, which a factor of the user's own goes
/// before.
bool is_packed(const Drum& drum) { return is_package_known(drum) && !drum.derating; }

/// m on the drum: the less, the cooler. A winch leaves more or less there by the cable's radius.
double least_wound(const SteadyFlight& flight, double radius, double other) {
  const TetherInFlight& tether = flight.tether();
  return std::min(tether.on_drum_with(radius), tether.on_drum_with(other));
}

/// A conductor of which `length` m lie on the drum, and which is laid out as `in_air` is.
ConductorHeat wound_up(const SteadyFlight& flight, const ConductorHeat& in_air, double radius,
                       double length) {
  const Tether& tether = flight.design().tether;
  Surroundings around = around_airborne(flight, 0);
  around.wind = 0;
  around.inclination.reset();
  if (is_packed(tether.drum)) {
    return in_air.wound(around, drum_package(tether, radius, flight.wall(), length));
  }
  const double derating = drum_derating(tether.drum).value_or(1);
  around.cooling = derating * derating;
  return in_air.in(around);
}

}  // namespace

TetherHeat::TetherHeat(const SteadyFlight& flight, double radius, double sunlit_radius)
    : flight_(flight),
      radius_(radius),
      measured_(flight.design().tether.heating.rise_per_loss > 0),
      wound_(least_wound(flight, radius, sunlit_radius) > 0 &&
             is_cooling_known(flight.design().tether.drum)),
      in_air_(flight.design().tether, radius, flight.wall(),
              around_airborne(flight, (sunlit_radius + flight.wall()) / (radius + flight.wall()))),
      on_drum_(wound_
                   ? wound_up(flight, in_air_, radius, least_wound(flight, radius, sunlit_radius))
                   : in_air_),
      at_zero_(flight.tether().resistance(radius, 0, 0)),
      per_kelvin_in_air_(flight.tether().resistance(radius, 1, 0) - at_zero_),
      per_kelvin_on_drum_(flight.tether().resistance(radius, 0, 1) - at_zero_) {}

std::optional<TetherTemperatures> TetherHeat::temperatures(double current) const {
  const auto warm = warmed(current);
  return warm ? std::optional(warm->temperatures) : std::nullopt;
}

ConductorHeat::Balance TetherHeat::measured(double current) const {
  const Tether& tether = flight_.design().tether;
  const double area = conductor_area(radius_);
  const double rise = settled_rise(tether, area, current, flight_.state().airspeed);
  ConductorHeat::Balance balance;
  balance.surface_C = balance.inside_C = flight_.state().ambient_temperature_C + rise;
  balance.by_current = current > 0 ? 2 * rise / current : 0;
  balance.inside_by_radius = -2 * rise / radius_;
  balance.returns = balance.inside_C <= highest_conductor_temperature_C;
  return balance;
}

TetherHeat::Loop TetherHeat::loop(const ConductorHeat::Balance& in_air,
                                  const ConductorHeat::Balance& on_drum) const {
  const ConductorHeat::Balance& wound = wound_ ? on_drum : in_air;
  const auto of = [this](double air, double drum) {
    return per_kelvin_in_air_ * air + per_kelvin_on_drum_ * drum;
  };
  Loop loop;
  loop.temperatures.in_air = in_air.steady_inside();
  if (wound_) loop.temperatures.on_drum = on_drum.steady_inside();
  loop.resistance = at_zero_ + of(in_air.steady_inside(), wound.steady_inside());
  loop.by_current = of(in_air.inside_per_surface * in_air.by_current,
                       wound.inside_per_surface * wound.by_current);
  // What a winch pays out grows with the radius, too; that it then warms in the air instead of on
  // the drum is left out.
  const TetherInFlight& tether = flight_.tether();
  const double contacts = tether.contact_resistance();
  loop.by_radius = of(in_air.inside_by_radius, wound.inside_by_radius) +
                   (loop.resistance - contacts) / (tether.resistance(radius_) - contacts) *
                       tether.resistance_slope(radius_);
  return loop;
}

std::optional<TetherHeat::Loop> TetherHeat::warmed(double current) const {
  const auto of = [&](const ConductorHeat& part) {
    return measured_ ? std::optional(measured(current)) : part.steady_surface(current);
  };
  const auto in_air = of(in_air_);
  if (!in_air || (measured_ && !in_air->returns)) return std::nullopt;
  const auto on_drum = wound_ ? of(on_drum_) : in_air;
  return on_drum ? std::optional(loop(*in_air, *on_drum)) : std::nullopt;
}

double TetherHeat::resistance(const TetherTemperatures& t) const {
  return flight_.tether().resistance(radius_, t.in_air, t.on_drum.value_or(t.in_air));
}

double TetherHeat::demanded_current(double load_power, double resistance) const {
  const double voltage = flight_.design().supply.voltage;
  const double power = supplied_power(voltage, resistance, load_power);
  return power >= 0 ? power / voltage : infinity;
}

TetherHeatState TetherHeat::carrying(double load_power, const TetherHeatState& near,
                                     double last_step) const {
  if (near.steady) {
    const TetherHeatState state = jointly(load_power, moved_here(near, load_power), last_step);
    if (state.steady) return state;
  }
  TetherHeatState cold;
  cold.current =
      demanded_current(load_power, resistance({flight_.state().ambient_temperature_C, {}}));
  if (!(cold.current < infinity)) return {};
  cold.surface_in_air_C = in_air_.first_surface(cold.current);
  cold.surface_on_drum_C = on_drum_.first_surface(cold.current);
  const TetherHeatState state = jointly(load_power, cold, last_step);
  return state.steady ? state : step_by_step(load_power, cold.current);
}

TetherHeatState TetherHeat::moved_here(const TetherHeatState& near, double load_power) const {
  const double thinner = near.radius / radius_;
  const double thinner_cable = (near.radius + flight_.wall()) / (radius_ + flight_.wall());
  const double contacts = flight_.tether().contact_resistance();
  const double current =
      demanded_current(load_power, contacts + (near.resistance - contacts) * thinner * thinner);
  if (!(current < infinity)) return near;
  // What a cable of diameter D gives off grows about with D^0.5 in wind, and with D^0.7 in still
  // air.
  const double share = current / near.current * thinner;
  const double warming = share * share * std::sqrt(thinner_cable);
  const double ambient = flight_.state().ambient_temperature_C;
  TetherHeatState here = near;
  here.current = current;
  here.surface_in_air_C = ambient + warming * (near.surface_in_air_C - ambient);
  here.surface_on_drum_C = ambient + warming * (near.surface_on_drum_C - ambient);
  return here;
}

TetherHeatState TetherHeat::jointly(double load_power, const TetherHeatState& start,
                                    double last_step) const {
  const double ambient = flight_.state().ambient_temperature_C;
  const double voltage = flight_.design().supply.voltage;
  TetherHeatState state = start;
  double before = 0;  // the step before, relative
  for (int step = 0; step < 12; ++step) {
    const double current = state.current;
    ConductorHeat::Balance in_air =
        measured_ ? measured(current) : in_air_.balance(state.surface_in_air_C, current);
    ConductorHeat::Balance on_drum =
        wound_ && !measured_ ? on_drum_.balance(state.surface_on_drum_C, current) : in_air;
    const Loop at = loop(in_air, on_drum);
    // U·I − R·I² = P, R along its tangent. Beyond where the left side is most, no state lasts.
    const double rate = voltage - current * (2 * at.resistance + current * at.by_current);
    if (!(rate > 0 && in_air.returns && on_drum.returns)) return {};
    const double change =
        (load_power + at.resistance * current * current - voltage * current) / rate;
    in_air.surface_change += in_air.by_current * change;
    on_drum.surface_change += on_drum.by_current * change;
    state.current = current + change;
    state.surface_in_air_C = in_air.surface_C + in_air.surface_change;
    state.surface_on_drum_C = on_drum.surface_C + on_drum.surface_change;
    const double coolest = std::min(state.surface_in_air_C, state.surface_on_drum_C);
    const double warmest = std::max(state.surface_in_air_C, state.surface_on_drum_C);
    if (!(state.current > 0 && coolest > ambient - 1 && warmest < highest_conductor_temperature_C))
      return {};
    double now = std::abs(change) / current;
    if (!measured_) {
      now = std::max({now, in_air.relative_change(ambient), on_drum.relative_change(ambient)});
    }
    // Each step of Newton's method is about the square of the one before times the same factor.
    const double next = now * (step == 0 ? now : now / before * (now / before));
    before = std::min(now, 0.1);  // a long step tells nothing of the next
    if (next <= last_step * last_step) {
      state.temperatures = {in_air.steady_inside(), {}};
      if (wound_) state.temperatures.on_drum = on_drum.steady_inside();
      state.resistance = at.resistance + at.by_current * change;
      state.resistance_slope = at.by_radius;
      state.radius = radius_;
      state.steady = state.hottest() <= highest_conductor_temperature_C;
      return state;
    }
  }
  return {};
}

/// The state that Newton's steps from a cold current lead to, each with the temperatures that are
/// steady at it. Where they overshoot, which the air's properties may make them do, they go back
/// half-way.
TetherHeatState TetherHeat::step_by_step(double load_power, double current) const {
  constexpr int most_retreats = 4;
  const double voltage = flight_.design().supply.voltage;
  double lo = current;
  int retreats = 0;
  for (int step = 0; step < 100; ++step) {
    const auto warm = warmed(current);
    double next = infinity;
    if (warm) {
      const double demanded = demanded_current(load_power, warm->resistance);
      // dI/dR = I²/(U − 2RI) of U·I − R·I² = P.
      const double slope =
          demanded * demanded / (voltage - 2 * warm->resistance * demanded) * warm->by_current;
      if (slope < 1) next = current + (demanded - current) / (1 - slope);
      if (std::abs(next - current) <= same_current * current) {
        const double ambient = flight_.state().ambient_temperature_C;
        return {true,    radius_, demanded, warm->resistance, warm->temperatures, warm->by_radius,
                ambient, ambient};
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
