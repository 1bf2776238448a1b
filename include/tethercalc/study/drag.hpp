// The drag that flights show, and what its linear term is for.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tethercalc/identify/drag_identification.hpp"

namespace tethercalc {

/// What flights say of the drag.
struct DragStudy {
  std::string name;               ///< of the log, or how many there are
  DragIdentification identified;  ///< the fit with the linear term, and what it was made of
  /// The same without the linear term, which shows what that is for; empty where there is no such
  /// fit.
  std::optional<DragFit> without_linear;
};

/// Fits the drag of `logs`, with and without the linear term. Throws as `identify_drag` does.
[[nodiscard]] DragStudy study_drag(std::string name, std::span<const FlightLog> logs,
                                   const DragIdentificationOptions& options);

}  // namespace tethercalc
