#include "tethercalc/study/envelope.hpp"

#include <algorithm>
#include <utility>

namespace tethercalc {

bool EnvelopeStudy::any() const {
  return std::any_of(greatest.begin(), greatest.end(),
                     [](const ReachResult& r) { return r.end.has_value(); });
}

EnvelopeStudy study_envelope(const Design& design) {
  EnvelopeStudy study;
  for (const Reach reach : all_reaches) {
    study.greatest.push_back({reach, greatest_reach(design, reach)});
  }
  for (const auto& [of, against] :
       {std::pair{Reach::payload, Reach::height}, std::pair{Reach::headwind, Reach::height},
        std::pair{Reach::payload, Reach::headwind}}) {
    study.curves.push_back({of, against, envelope_curve(design, of, against)});
  }
  return study;
}

}  // namespace tethercalc
