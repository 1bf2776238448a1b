// How high, how heavy, how fast and in how much wind a given cable flies.
#pragma once

#include <optional>
#include <vector>

#include "tethercalc/solve/envelope.hpp"

namespace tethercalc {

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

/// What a cable can do at most.
struct EnvelopeStudy {
  std::vector<ReachResult> greatest;  ///< each with the others as the design has them
  std::vector<EnvelopeCurve> curves;  ///< payload and wind against height, payload against wind

  /// Whether the cable flies at all.
  [[nodiscard]] bool any() const;
};

/// For a design with a cross-section.
[[nodiscard]] EnvelopeStudy study_envelope(const Design& design);

}  // namespace tethercalc
