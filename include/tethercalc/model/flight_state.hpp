// Where, how fast and in what air a tethered drone flies, and how much cable is out.
#pragma once

#include <optional>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// The state of a flight at one moment. Together with a design it makes one operating point.
struct FlightState {
  double airspeed = 0;  ///< m/s through the air, forward positive
  double deployed = 0;  ///< m of cable in the air, which is also the height of a straight tether
  double on_drum = 0;   ///< m of cable on the drum: in the circuit, not in the air
  /// °C of the air around the tether. Heats nothing where the design asks for no heat balance.
  double ambient_temperature_C = 20;
};

/// The state in which a design is judged in `condition`: the whole `tether.length` in the air,
/// `tether.spooled_length` on the drum.
[[nodiscard]] FlightState flight_state(const Design& design, Condition condition);

/// The state at `height` m (≥ 0) and `airspeed` m/s, in air of `ambient_temperature_C` where that
/// was measured. A design with cable on the drum has all its cable at every height: what is not in
/// the air is on the drum. Without, its cable is as long as it flies high.
[[nodiscard]] FlightState flight_state_at(
    const Design& design, double height, double airspeed,
    std::optional<double> ambient_temperature_C = std::nullopt);

}  // namespace tethercalc
