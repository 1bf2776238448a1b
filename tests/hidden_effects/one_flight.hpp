// One flight of a tethered drone with both logs of it: how it leaned, and what it drew. Both come
// from the same equations of motion, with the drone's and the cable's mass and drag.
#pragma once

#include <cstdint>

#include "hidden_effects/power_truth_simulator.hpp"
#include "tethercalc/study/diagnosis.hpp"

namespace tethercalc::truth {

/// What is hidden: mass, drag, and what motors and instruments do.
struct HiddenDrone {
  power_truth::HiddenEffects effects{};  ///< of the cable's load only what both logs can have
  double height = 15;                    ///< m, throughout
  int passes = 20;                       ///< there and back at 3 to 9 m/s, with pauses
  double acceleration = 0.8;             ///< m/s², speeding up and braking
  bool whole_chain = false;              ///< else the motors' bus is all that was measured
  std::uint64_t seed = 1;
};

/// Both logs, held against the spec of `power_truth`.
[[nodiscard]] DiagnosisQuestion one_flight_of(const HiddenDrone& hidden);

}  // namespace tethercalc::truth
