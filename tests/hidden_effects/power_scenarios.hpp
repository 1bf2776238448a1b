// What the power tests and the detection rates share: the spec of the simulated drone as the
// library sees it, and every effect of the catalogue at strengths from the limit of detection to
// large.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hidden_effects/power_truth_simulator.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"

namespace power_truth {

/// The spec the simulator deviates from.
[[nodiscard]] tethercalc::Design spec(const Rig& rig = {});

[[nodiscard]] tethercalc::PowerLog as_power_log(const Log& log);

/// One effect, hidden at a strength from 0 (about the limit of detection) to 1 (large).
struct HiddenEffect {
  std::string id;  ///< in the library's catalogue
  std::function<void(HiddenEffects&, double strength)> hide;
  std::function<double(const HiddenEffects&)> truth;  ///< of the effect's first parameter
};

[[nodiscard]] const std::vector<HiddenEffect>& hidden_effects();

/// What no effect of the catalogue does, hidden at a strength as above.
struct UnknownEffect {
  std::string words;
  std::string channel;  ///< that it goes with
  std::function<void(HiddenEffects&, double strength)> hide;
};

[[nodiscard]] const std::vector<UnknownEffect>& unknown_effects();

}  // namespace power_truth
