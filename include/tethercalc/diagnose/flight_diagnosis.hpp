// From a flight log to what the simulation of the flight gets wrong, and why.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// A log, and which part of it is meant.
struct MeasuredFlight {
  FlightLog log;                       ///< attitude and speed
  std::optional<SampleRange> range{};  ///< where absent, all in which the drone is seen to fly
};

/// How to look, and what to take for granted.
struct FlightDiagnosisOptions {
  double pitch_offset = 0;         ///< rad, taken off the logged pitch before anything else
  std::vector<std::string> base;   ///< ids of effects that are refitted but not reported
  double speed_window = 5;         ///< s, of the open-loop simulation of the speed
  SelectionOptions selection;      ///< thresholds of the search
  std::vector<Effect> hypotheses;  ///< tried beside those of the catalogue, see `effect_of`
};

/// Compares the forward acceleration of `flights` with what its attitude and speed make us expect
/// of a drone of `design.drone.mass` in air of `design.flight.air_density`, and selects from the
/// catalogue what explains the difference. Drag areas are always refitted; the spec's own drag is
/// only replaced, never assumed.
///
/// The measured acceleration is the central difference of the logged speed over two intervals; the
/// predicted one is averaged over the same two intervals, since a prediction at the middle sample
/// would look like a delay of the attitude.
///
/// `roll` and `down_velocity` of the log may be empty: the roll then counts as level, the flight as
/// level too, and what needs the channel is listed as not testable. Spikes and stretches in which a
/// sensor is stuck are left out and noted. A log with fewer than `fewest_blocks` blocks of 12 s
/// yields no findings: every effect is listed as not testable for want of a longer flight.
///
/// Without a range of its own, of a log those parts are used in which the drone is seen to fly: it
/// speeds up as it leans. What lies between them, stretches in which it stands, and those in which
/// it is tilted too far to be carried, are left out and noted.
///
/// Several flights are of one drone: drag and what else belongs to it is shared; wind, pitch trim
/// and what else belongs to a flight is each one's own, and told with its number (`flight`, from 1
/// on). Each needs three blocks.
///
/// `design_impact` is left empty: it needs a cross-section to be optimised.
///
/// Throws std::invalid_argument where there is no flight, where `options.base` names an effect that
/// is not one of a flight, or where mass or air density is not positive; UnsuitableFlight where the
/// log has no usable flight, and where its pitch is stuck, upside down, or in another unit.
[[nodiscard]] Diagnosis diagnose_flights(const Design& design,
                                         std::span<const MeasuredFlight> flights,
                                         const FlightDiagnosisOptions& options = {},
                                         const SelectionProgress& progress = {});

/// The same of all that is flown in one log.
[[nodiscard]] Diagnosis diagnose_flight(const Design& design, FlightLog log,
                                        const FlightDiagnosisOptions& options = {},
                                        const SelectionProgress& progress = {});

/// s that have to be judged, alone, to tell an effect from chance.
inline constexpr double shortest_flight = 72;

/// s of a log that `diagnose_flight` would judge, of a drone in air of 1.225 kg/m³. Throws
/// UnsuitableFlight where that does.
[[nodiscard]] double judged_time(FlightLog log);

}  // namespace tethercalc
