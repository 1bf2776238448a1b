// The shortest further flight that settles what a diagnosis leaves open: manoeuvres, chosen by what
// each is expected to tell.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/diagnose/flight_diagnosis.hpp"

namespace tethercalc {

/// What a further flight keeps to. All of it was flown in the logs, or is demanded by the design.
struct FlightLimits {
  double speed = 0;         ///< m/s over ground, > 0
  double acceleration = 0;  ///< m/s² along the track, speeding up and braking, > 0
  double height = 0;        ///< m over home at which passes are flown, > 0
  double ceiling = 0;       ///< m over home, not below `height`
  double reach = 0;         ///< m from home over ground, > 0
  double duration = 900;    ///< s of manoeuvres, at most
};

/// Fly there along a straight line, the nose at a heading, and hover.
struct Waypoint {
  double north = 0;    ///< m from home
  double east = 0;     ///< m from home
  double height = 0;   ///< m over home
  double speed = 0;    ///< m/s over ground on the way, > 0
  double heading = 0;  ///< rad, of the nose, clockwise from north
  double hold = 0;     ///< s of hover there
};

/// What is flown from a hover above home back to it.
struct Manoeuvre {
  std::string words;                ///< for a person
  std::vector<Waypoint> waypoints;  ///< the last one above home
  /// s: turning the nose, the way, and the hovers.
  double duration = 0;
};

/// An effect that the flight settles.
struct Decision {
  std::string effect;      ///< id in the catalogue
  std::size_t flight = 0;  ///< of the log that it was seen in, as in `Finding`; 0 for all
  /// Whether each flight has its own of it. Then the further flight tells whether it has it, too;
  /// what the logged one had stays with that.
  bool own_in_each_flight = false;
  std::vector<std::string> told_from;  ///< what it could not be told from so far, by name
};

/// An effect that it does not settle.
struct Undecided {
  std::string effect;      ///< id in the catalogue
  std::size_t flight = 0;  ///< as in `Decision`
  std::string because;     ///< a clause
};

/// An effect of the base model of which a flight that turns needs the finer description.
struct FinerBase {
  std::string coarse;  ///< id
  std::string fine;    ///< id of the one to take in its place
};

/// The plan.
struct NextFlight {
  FlightLimits limits;                ///< that it keeps to
  std::vector<Manoeuvre> manoeuvres;  ///< in the order they are flown; none where nothing is open
  double duration = 0;                ///< s, of all manoeuvres
  std::vector<Decision> decides;      ///< what for
  std::vector<Undecided> undecided;   ///< what it leaves open, and why
  std::vector<FinerBase> finer_base;  ///< for the diagnosis of all flights, where this one turns
  /// Whether every shorter choice of the manoeuvres was tried and found too short; else the plan
  /// was found by adding the most telling manoeuvre a second, one after the other.
  bool shortest = false;
};

/// What the logs flew: the speed that 99 % of the samples stay below, but no less than the design's
/// airspeed in forward flight; accelerations that take half of the tilt seen, between 0.5 and
/// 2.5 m/s²; the median height above the first sample, but 10 m at least, with 15 m more for
/// climbs; and how far the drone went, 8 m at least. Places are integrated velocities. A drone that
/// stayed within the design's tether keeps within 95 % of it, heights included.
[[nodiscard]] FlightLimits flown_limits(const Design& design,
                                        std::span<const MeasuredFlight> flights);

/// What there is to choose from: passes at three speeds and four headings, out ahead and back
/// backward; a pass to the side, one that climbs, one higher up, quick reversals, and a hover at
/// four headings. `heading` in rad is the first.
[[nodiscard]] std::vector<Manoeuvre> candidate_manoeuvres(const FlightLimits& limits,
                                                          double heading);

/// Chooses manoeuvres so that each effect which `diagnosis`, of `flights` with `options`, calls
/// suspected or indistinguishable would be named in a joint diagnosis of `flights` and the further
/// one, were it as large as the log has it, and would not be indistinguishable from any other
/// effect; nine times in ten each, by the thresholds of `options.selection`. Were it not there, it
/// would then be ruled out.
///
/// What a manoeuvre tells is what the model's prediction of it, linear in all parameters, knows of
/// the effect beside everything that is fitted (its Fisher information); noise is what the
/// diagnosis left, as correlated as it was there.
///
/// Throws as `diagnose_flights` does.
[[nodiscard]] NextFlight plan_next_flight(const Design& design,
                                          std::span<const MeasuredFlight> flights,
                                          const FlightDiagnosisOptions& options,
                                          const Diagnosis& diagnosis, const FlightLimits& limits);

}  // namespace tethercalc
