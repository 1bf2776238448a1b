// What the calculation of a flight's power gets wrong, and why.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// A diagnosis and the design that flies as the log shows.
struct PowerDiagnosis {
  Diagnosis diagnosis;  ///< what was found
  Design extended;      ///< the design with every finding that outlives the flight in its field
};

/// A power log shorter than this, s, is not judged: it holds too few independent stretches.
inline constexpr double shortest_power_log = 180;

/// s since the first sample, one a sample: a time without samples, longer than 30 s and
/// `shortest_gap`, does not count. What two flights with hours between them have, in one log.
[[nodiscard]] std::vector<double> time_without_gaps(const PowerLog& log);

/// Diagnoses a power log against the design as it stands: nothing is fitted but the effects named
/// in `base_effects` (catalogue ids), which are taken as part of the base model and not reported.
///
/// Readings of all stages are compared together, each over the standard deviation of its noise with
/// the noise's memory taken out; held-out errors are in that unit, 1 being nothing but noise. The
/// findings' errors in volts and watts stand in `Diagnosis::further`.
///
/// `hypotheses` are tried beside the effects of the catalogue, see `effect_of`.
///
/// `tilt` is what the attitude of the same flight, judged by the same design, says of drag over
/// mass. It is then one more comparison, of the stage "airframe": a heavier drone leans less, one
/// with hungrier motors as before. `Diagnosis::drag_by_tilt` is what was compared, and the drag of
/// the extended design what it comes to for a drone of that design's mass. A flight that tells its
/// drag from none no better than that stays out, with a note. A design whose drag is an estimate is
/// given that of the tilt at its mass, and judged with it, and nothing is compared.
///
/// Compared are the stages whose channels there are:
///
///     tether     supply_voltage_V, supply_current_A, drone_voltage_V, height_m
///     converter  supply_current_A, drone_voltage_V, the bus
///     motors     the bus, airspeed_m_s, height_m (not in free flight)
///
/// the bus being its voltage and current, or its power. A log that is too short, or lacks channels,
/// has the effects that it cannot show under `not_testable`; that is an answer, not an error.
///
/// In a free flight (`PowerLog::free_flight`) the design flies without tether, winch, converter and
/// reserve battery, and its auxiliary power comes out of the same battery as that of its motors.
///
/// Throws std::invalid_argument where no stage was measured, the design
/// has no cable cross-section but flew on its tether, a base effect is unknown or belongs to
/// flights, the channels differ in length, or their values cannot be in the units their names say.
[[nodiscard]] PowerDiagnosis diagnose_power(const Design& design, const PowerLog& log,
                                            std::span<const std::string> base_effects = {},
                                            const SelectionProgress& progress = {},
                                            std::span<const Effect> hypotheses = {},
                                            const std::optional<DragByTilt>& tilt = {});

}  // namespace tethercalc
