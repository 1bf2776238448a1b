// The conductor cross-section that draws the least power from the ground supply.
#pragma once

#include <limits>

#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// The least power and the cross-section that draws it.
struct MinimumPower {
  double area = 0;   ///< m²; NaN where no area in the range can be flown on this line
  double power = 0;  ///< W from the ground supply; NaN likewise
};

/// The one with less power; one that exists before one that does not.
[[nodiscard]] MinimumPower lesser(const MinimumPower& a, const MinimumPower& b);

/// The least power over every cross-section in `within` (m²; hi may be +infinity) whose tilt is
/// within its limit, whose thrust the motors can make and whose power the line can deliver. No
/// headroom and no converter cut-off is asked for here.
///
/// Why it cannot be fooled: for a supplied power y the line obeys P_drone(r) + R(r)·(y/U)² ≤ y
/// exactly where the total power is at most y. Where P_drone is convex in the conductor's radius r,
/// the left side is, so the power has one valley. The lower convex hull of the motor curve makes it
/// convex, and bounds the power from below everywhere; so the valley of the hull is found first,
/// and where the measured curve lies above its hull there, only those pieces of the curve are
/// searched on which the bound is below the best power known. Kinks are compared exactly, as
/// vertices. With a converter curve, which need not be convex, every piece is searched.
///
/// The power is the minimum to 1e-12 relative, the area to 1e-8 (the minimum is flat) or exact at a
/// kink.
[[nodiscard]] MinimumPower minimum_power(const SteadyFlight& flight,
                                         Interval within = {
                                             0, std::numeric_limits<double>::infinity()});

/// Whether the power over the convex hull of the motor curve is one valley, all along the radius:
/// the efficiency is constant, and neither heat nor a reserve battery bends the curve.
[[nodiscard]] bool hull_is_one_valley(const Design& design);

/// Whether `area` (m²) is certain to draw the least power of all areas on its side of the one that
/// draws the least of all: no area is beyond the tilt limit, the efficiency is constant, and the
/// motor curve is at its convex hull there, with which the power would be one valley and is nowhere
/// less.
[[nodiscard]] bool is_cheapest_beyond(const SteadyFlight& flight, double area);

}  // namespace tethercalc
