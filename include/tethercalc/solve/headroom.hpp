// Which conductor cross-sections leave enough thrust in hand, and how much can be had at best.
#pragma once

#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// Every cross-section (m²) at which the tilt is within its limit and the headroom, available over
/// necessary thrust, is at least `required` (> 0). Empty where there is none.
///
/// Available thrust rises with the cross-section until the motors saturate; necessary thrust rises
/// too, without end. The set may therefore have an upper edge (too heavy) as well as a lower one
/// (starved of power), and several parts where the motor curve is uneven. It is found by bisecting
/// over the motor curve's points, using that both thrusts are monotone to discard what cannot hold
/// an edge, which takes time logarithmic in the number of points. Edges are exact to 1e-12
/// relative.
[[nodiscard]] IntervalSet headroom_areas(const SteadyFlight& flight, double required);

/// The largest headroom reachable with any cross-section within the tilt limit.
struct BestHeadroom {
  double value = 0;  ///< available over necessary thrust; 0 where no thrust is available at all
  double area = 0;   ///< m², where it is reached; NaN where value is 0
};

/// The cross-section that leaves the most thrust in hand, whatever it costs in power. A heat
/// balance or a reserve battery of the design is left out of account: the cable has its
/// `conductor_temperature_C`.
[[nodiscard]] BestHeadroom best_headroom(const SteadyFlight& flight);

/// The same with the conductor as warm and the reserve battery as heavy as each cross-section makes
/// them; then the best of a grid around the result without them, refined, to about 1e-8 relative.
[[nodiscard]] BestHeadroom best_headroom(const Design& design, Condition condition);

}  // namespace tethercalc
