// What a reference design is held to: its main results.
#pragma once

#include "tethercalc/study/sweep.hpp"

namespace tethercalc {

/// The results of one design that records are made of.
struct ReferenceResults {
  SweepOutcome outcome;        ///< the optimum
  BestHeadroom best_headroom;  ///< at `requirements.headroom_at`
  MinimumPower minimum_power;  ///< at `requirements.power_at`, whatever else is asked for
};

/// Computes them.
[[nodiscard]] ReferenceResults reference_results(const Design& design);

}  // namespace tethercalc
