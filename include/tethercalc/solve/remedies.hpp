// Which single change would make an infeasible design feasible.
#pragma once

#include <vector>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// What a remedy changes, everything else staying as it is.
enum class Quantity {
  supply_voltage,  ///< `design.supply.voltage`, V, raised
  drone_mass,      ///< `design.drone.mass`, kg, lowered
  tether_length,   ///< `design.tether.length`, m, lowered
  airspeed,        ///< `design.flight.airspeed`, m/s, lowered
};

/// One change that makes the design feasible.
struct Remedy {
  Quantity quantity = Quantity::supply_voltage;  ///< what to change
  double value = 0;  ///< SI: what the quantity must become for the design to be feasible
};

/// How far `remedies` looks: voltage up to this many volts, ...
inline constexpr double highest_remedy_voltage = 1000;
/// ... mass, length and airspeed down to this fraction of what they are, the first two no further
/// than `least_drone_mass` and `least_tether_length`.
inline constexpr double smallest_remedy_fraction = 0.01;

/// For each quantity the smallest change that, alone, makes the design feasible (`is_feasible`), in
/// the order of `Quantity`; no entry where no value within the bounds does. Empty for a design that
/// is feasible already.
///
/// The value is rounded away from the present one to 3 significant digits, in SI and therefore also
/// in grams; to more digits where 3 would overshoot a narrow range. Every value returned has been
/// found feasible. Values are tried 2 % apart, 10 % with a solved tether, before the threshold is
/// bisected, so that a feasible range narrower than that may be missed: ranges are wide except for
/// the mass, where a lighter drone also tilts further. The threshold is found to 1e-6, with a
/// solved tether to 1e-4, by which its third digit may be one too far. Tries about 1000 values,
/// with a solved tether 200.
[[nodiscard]] std::vector<Remedy> remedies(const Design& design);

/// `design` with the remedy applied.
[[nodiscard]] Design remedied(Design design, const Remedy& remedy);

}  // namespace tethercalc
