// A flight that hides nothing, another one in each run.
#pragma once

#include <cstdint>
#include <random>

#include "hidden_effects/simulated_flight.hpp"
#include "support/random.hpp"

namespace tethercalc::truth {

/// Of 300 s, to keep the suite quick.
inline HiddenFlight drawn_flight(std::uint64_t draw) {
  HiddenFlight hidden;
  hidden.seed = 1'000'003ULL * test::run_seed() + draw;
  std::mt19937_64 random(hidden.seed);
  draw_drone(hidden, random);
  hidden.duration = 300;
  return hidden;
}

}  // namespace tethercalc::truth
