// Which conductor cross-sections leave enough thrust in hand, and how much can be had at best.
#pragma once

#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// Every cross-section (m²) at which the tilt is within its limit and the headroom, available over
/// necessary thrust, is at least `required` (> 0), with all that the design has on: a cable as warm
/// and a reserve battery as heavy as the cross-section makes them, and a converter that gives no
/// more than its rated output. Empty where there is none.
///
/// Available thrust rises with the cross-section until the motors saturate; necessary thrust rises
/// too, without end. The set may therefore have an upper edge (too heavy) as well as a lower one
/// (starved of power), and several parts where a curve is uneven. What is asked for and what there
/// is both rise with the conductor's radius, which bounds the margin between two radii from both
/// sides; stretches are split until the bounds decide, or until nothing but one edge can lie in
/// them, which is closed in on to 1e-12 relative.
[[nodiscard]] IntervalSet headroom_areas(const SteadyFlight& flight, double required);

/// Those of them at which the strength and the rated temperatures that the design asks for are kept
/// in this flight, too: where all demands on it are met, but for the range of the input voltage.
[[nodiscard]] IntervalSet areas_meeting_demands(const SteadyFlight& flight, double required);

/// The largest headroom reachable with any cross-section within the tilt limit.
struct BestHeadroom {
  double value = 0;  ///< available over necessary thrust; 0 where no thrust is available at all
  double area = 0;   ///< m², where it is reached; NaN where value is 0
};

/// The cross-section that leaves the most thrust in hand, whatever it costs in power, with all that
/// the design has on; the value is what `evaluate` says of it. To about 1e-15 in the value.
[[nodiscard]] BestHeadroom best_headroom(const SteadyFlight& flight);

/// The same in one of a design's conditions.
[[nodiscard]] BestHeadroom best_headroom(const Design& design, Condition condition);

}  // namespace tethercalc
