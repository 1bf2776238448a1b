#include "solve/thrust_at.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tethercalc {

ThrustAt thrust_at(const SteadyFlight& flight, double radius, double tan_guess) {
  const double tangent =
      flight.tan_pitch(radius, std::numeric_limits<double>::infinity(), tan_guess);
  return {radius, tangent, flight.necessary_thrust_with_slope(radius, tangent)};
}

ThrustAt at_thrust(const SteadyFlight& flight, double thrust, ThrustAt from) {
  for (int step = 0; step < 50; ++step) {
    if (from.thrust.value == thrust) break;
    const double change = (thrust - from.thrust.value) / from.thrust.slope;
    const double radius = std::max(from.radius + change, 0.25 * from.radius);
    // Quadratic convergence: the thrust is then within 1e-16 of the one asked for.
    const bool last = std::abs(change) <= 1e-8 * radius;
    from = thrust_at(flight, radius, from.tan_guess(radius));
    if (last) break;
  }
  return from;
}

}  // namespace tethercalc
