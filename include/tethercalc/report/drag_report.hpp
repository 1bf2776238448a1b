// The answer of `drag` for people, programs and spreadsheets.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/identify/autopilot_drag.hpp"
#include "tethercalc/identify/drag_identification.hpp"
#include "tethercalc/model/warning.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// Steady flight at round airspeeds up to the largest flown: about ten, in steps of 1, 2, 5, …
/// (m/s). Speeds that would need a tilt beyond 60° are left out.
[[nodiscard]] std::vector<SteadyDrag> steady_drag_table(const DragFit& fit);

/// What makes the fit doubtful: parameters at a bound, drag that may be none, no
/// convergence. Empty for a sound fit.
[[nodiscard]] std::vector<Warning> drag_warnings(const DragFit& fit);

/// All results. `front_area_m2`, `top_area_m2`, `linear_m_s` and the list `wind_m_s` hold {`value`,
/// `standard_error_independent`, `standard_error`, `ci95`}, null where the parameter is held at its
/// bound, which `at_bound` then names; `warnings` and `warning_codes` those of `drag_warnings`;
/// `notes` and `note_codes` what was noticed in the logs and what was assumed;
/// `drone.drag` is the block for a spec; `table` lists steady flight with the same objects;
/// `autopilot` has, of `ardupilot` and `px4`, each of their parameters with its unit, or null as
/// its value and why it is left out.
[[nodiscard]] nlohmann::ordered_json drag_json(const DragIdentification& result,
                                               std::span<const Warning> notes = {});

/// What is said of a fit beside its tables.
struct DragSentences {
  std::vector<std::string> made_of;  ///< which samples, and what was taken as known
  std::vector<std::string> quality;  ///< what is well and what is badly known, and the residuals
};

/// The fit in sentences.
[[nodiscard]] DragSentences drag_sentences(const DragIdentification& result);

/// The fitted parameters with both kinds of errors.
[[nodiscard]] TitledTable drag_parameter_table(const DragFit& fit);

/// `steady_drag_table` for people.
[[nodiscard]] TitledTable steady_flight_table(const DragFit& fit);

/// Parameters, what is well and what is badly known, quality, and the table of steady flight.
[[nodiscard]] std::string drag_text(const DragIdentification& result, const TextStyle& style);

/// The table of steady flight, one row a speed.
[[nodiscard]] std::string drag_csv(const DragIdentification& result);

/// The fit as a parameter file of an autopilot: NAME,VALUE a line for ArduPilot, the five columns
/// of QGroundControl for PX4. Intervals, what is left out and why, and how to load it are comments.
[[nodiscard]] std::string autopilot_parameter_file(const DragIdentification& result,
                                                   Autopilot autopilot);

}  // namespace tethercalc
