// Shapes that an effect without a name may have in a flight.
#pragma once

#include <vector>

#include "diagnose/selection.hpp"
#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// Functions of each channel of the flight (roll, pitch, yaw, speeds, height, time, with steps in
/// time), alone and times the airspeed and its powers, since a force of the air grows with it. The
/// forward acceleration is no channel. `wind` in m/s: airspeed is forward speed − wind.
[[nodiscard]] std::vector<UnnamedRegressor> flight_structure(const Observations& observations,
                                                             double wind);

}  // namespace tethercalc
