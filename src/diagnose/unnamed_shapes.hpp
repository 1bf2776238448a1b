// Shapes that a log may follow without any effect of the catalogue.
#pragma once

#include <vector>

#include "diagnose/flight_prediction.hpp"
#include "diagnose/power_residuals.hpp"
#include "diagnose/selection.hpp"
#include "identify/flight_units.hpp"
#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// Functions of each channel of the flight (roll, pitch, yaw and its rate, speeds, height, time),
/// alone and times the forward airspeed and its powers, since a force of the air grows with it. No
/// acceleration is a channel. `wind` in m/s: airspeed is forward speed − wind. Only forward there
/// are steps in time as well, and formulas, whose force acts there.
[[nodiscard]] std::vector<UnnamedRegressor> flight_shapes(const Observations& observations,
                                                          const FlightRecord& record, double wind,
                                                          Axis axis);

/// Unnamed regressors over the rows of `residuals`, each in one stage and of one channel: steps,
/// drift and waves in time; bends in height, airspeed, current and ambient temperature. In the
/// tether they change its resistance, at the motors their relative power. Memory is taken out as
/// from the residuals. Channels bear the names of their CSV columns.
[[nodiscard]] std::vector<UnnamedRegressor> power_shapes(const PowerResiduals& residuals);

/// Adds steps in time close to those among `found` (indices into `shapes`), one every row. False
/// where there is no step among them.
bool add_finer_steps(const PowerResiduals& residuals, const std::vector<std::size_t>& found,
                     std::vector<UnnamedRegressor>& shapes);

}  // namespace tethercalc
