// Pictures of measured flights: what the log holds, and the drag learned from it.
#pragma once

#include <string>

#include "tethercalc/report/figure.hpp"
#include "tethercalc/study/drag.hpp"

namespace tethercalc {

/// Over time: the forward acceleration expected from the attitude and the one observed; the drag
/// per mass, which is their difference; and the forward speed that it follows. `name` is the log's.
[[nodiscard]] Figure log_figure(const std::string& name, const Observations& flight);

/// Over airspeed: measured drag, the fitted model at every sample, its line in steady flight with
/// the 95 % interval and the line without a linear term; below, what the fit leaves. Long flights
/// are thinned evenly to 700 samples.
[[nodiscard]] Figure drag_figure(const DragStudy& drag);

/// Over airspeed and tilt: the fitted drag as a surface, steady flight as a line in it, and the
/// measured drag as dots, with stalks to the surface where they are farthest from it.
[[nodiscard]] Figure drag_surface_figure(const DragStudy& drag);

}  // namespace tethercalc
