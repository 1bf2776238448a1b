// Pictures of measured flights: what the log holds, and the drag learned from it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/identify/drag_identification.hpp"
#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// Over time: the forward acceleration expected from the attitude and the one observed; the drag
/// per mass, which is their difference; and the forward speed that it follows. `name` is the log's.
[[nodiscard]] Figure log_figure(const std::string& name, const Observations& flight);

/// What pictures of drag are drawn from.
struct DragFlights {
  std::string name;                   ///< of the log, or how many there are
  std::vector<Observations> flights;  ///< one a log, as the fit saw them
  DragIdentification identified;      ///< the fit with the linear term, and what it was made of
  /// The same without the linear term, which shows what that is for; empty where there is no such
  /// fit.
  std::optional<DragFit> without_linear;
};

/// Fits the drag of `logs`, with and without the linear term. Throws as `identify_drag` does.
[[nodiscard]] DragFlights fit_drag_flights(std::string name, std::span<const FlightLog> logs,
                                           const DragIdentificationOptions& options);

/// Over airspeed: measured drag, the fitted model at every sample, its line in steady flight with
/// the 95 % interval and the line without a linear term; below, what the fit leaves. Long flights
/// are thinned evenly to 700 samples.
[[nodiscard]] Figure drag_figure(const DragFlights& drag);

/// Over airspeed and tilt: the fitted drag as a surface, steady flight as a line in it, and the
/// measured drag as dots, with stalks to the surface where they are farthest from it.
[[nodiscard]] Figure drag_surface_figure(const DragFlights& drag);

}  // namespace tethercalc
