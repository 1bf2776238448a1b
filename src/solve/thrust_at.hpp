// The necessary thrust along the conductor's radius, with what makes the next one cheap.
#pragma once

#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {

/// Necessary thrust at a radius.
struct ThrustAt {
  double radius = 0;
  double tan_pitch = 0;
  SteadyFlight::Thrust thrust;

  /// Where to look for the tangent of the tilt at a radius nearby.
  [[nodiscard]] double tan_guess(double at_radius) const {
    return tan_pitch + thrust.tan_slope * (at_radius - radius);
  }
};

[[nodiscard]] ThrustAt thrust_at(const SteadyFlight& flight, double radius, double tan_guess);

/// The radius at which `thrust` is necessary; `from` starts Newton's method. The necessary thrust
/// rises ever more steeply with the radius, so that it converges from either side.
[[nodiscard]] ThrustAt at_thrust(const SteadyFlight& flight, double thrust, ThrustAt from);

}  // namespace tethercalc
