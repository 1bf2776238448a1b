#include "tethercalc/study/reference.hpp"

namespace tethercalc {

ReferenceResults reference_results(const Design& design) {
  return {sweep_outcome(design), best_headroom(design, design.requirements.headroom_at),
          optimize(design).minimum_power};
}

}  // namespace tethercalc
