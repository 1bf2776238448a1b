// What a given cable can do at most: how high, how heavy, how fast, in how much wind, how far
// aside.
#pragma once

#include <optional>
#include <vector>

#include "tethercalc/solve/optimize.hpp"
#include "tethercalc/study/cable_shape.hpp"

namespace tethercalc {

/// What is pushed as far as it goes.
enum class Reach {
  height,    ///< `tether.length`, m
  payload,   ///< mass carried beside `drone.mass`, kg
  headwind,  ///< `flight.headwind`, m/s, in hover and in forward flight
  airspeed,  ///< `flight.airspeed`, m/s, in forward flight
  offset,    ///< `flight.horizontal_offset`, m, of a solved tether
};

/// What can be asked of the design, in the order of the enumeration: all of them of a solved
/// tether, while a straight one hangs down from the drone wherever it is.
[[nodiscard]] std::vector<Reach> reaches_of(const Design& design);

/// How far the search goes: for height and offset all the cable there is where some is left on the
/// drum, else 10 km; what the motors' greatest thrust lifts; 100 m/s.
[[nodiscard]] double search_end(const Design& design, Reach reach);

/// The end of one reach.
struct ReachEnd {
  double value = 0;      ///< SI, the greatest that meets all that is required
  double from = 0;       ///< SI, the least above which all up to it do; 0.1 m of height, else 0,
                         ///< where the search begins
  bool bounded = false;  ///< false: even the end of the search does, and nothing limits it
  Limit limit = Limit::available_power;    ///< what is missed just beyond
  Condition condition = Condition::hover;  ///< where
  bool drum_is_empty = false;              ///< all of the cable is in the air there
};

/// `design` with the reach at `value`. With cable left on the drum, height unwinds it; without, the
/// cable is as long as it flies high.
[[nodiscard]] Design at_reach(Design design, Reach reach, double value);

/// Where the search begins.
[[nodiscard]] double search_start(Reach reach);

/// The greatest value at which the cable (`tether.cross_section`, which must be set) meets all that
/// `optimize` demands of one: headroom, tilt and, where asked for, heat, strength and the
/// converter's rating. Nothing where none does. The range is looked through at 400 values (50
/// of a solved tether) and about the design's own before its edges are bisected to 1e-9 relative,
/// so that feasible ranges narrower than their distance may be missed.
[[nodiscard]] std::optional<ReachEnd> greatest_reach(const Design& design, Reach reach);

/// One point of a curve of one reach against another.
struct EnvelopePoint {
  double against = 0;           ///< SI
  std::optional<ReachEnd> end;  ///< nothing where no value meets the demands
};

/// The greatest `of` at `points` (≥ 2) values of `against` from nearly none to its own greatest.
/// Empty where that does not exist.
[[nodiscard]] std::vector<EnvelopePoint> envelope_curve(const Design& design, Reach of,
                                                        Reach against, int points = 11);

/// One reach and its end.
struct ReachResult {
  Reach reach = Reach::height;  ///< which
  std::optional<ReachEnd> end;  ///< nothing: the cable flies at no value of it
};

/// The greatest of one reach against another.
struct EnvelopeCurve {
  Reach of = Reach::payload;          ///< what is pushed as far as it goes
  Reach against = Reach::height;      ///< at values of this
  std::vector<EnvelopePoint> points;  ///< by rising `against`
};

/// That the cable lies on the ground at the end of a reach.
struct GroundAtReach {
  Reach reach = Reach::height;  ///< which
  double value = 0;             ///< its end
  GroundContact contact;        ///< there
};

/// What a cable can do at most.
struct EnvelopeStudy {
  AreaPoints as_given;                ///< the cable in the design itself
  std::vector<ReachResult> greatest;  ///< each with the others as the design has them
  /// Payload and wind against height, payload against wind; of a solved tether also the offset
  /// against height and wind.
  std::vector<EnvelopeCurve> curves;
  /// Of the reach at whose end the cable would hang lowest.
  std::optional<GroundAtReach> ground;
  /// Of the design itself; where it is not aside, at its greatest offset.
  std::optional<WorstSide> side;

  /// Whether the cable flies at all.
  [[nodiscard]] bool any() const;
};

/// For a design with a cross-section.
[[nodiscard]] EnvelopeStudy study_envelope(const Design& design);

}  // namespace tethercalc
