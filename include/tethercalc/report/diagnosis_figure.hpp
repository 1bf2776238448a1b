// The picture of a diagnosis.
#pragma once

#include <string>

#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/report/figure.hpp"

namespace tethercalc {

/// From top to bottom: for every compared quantity, predicted against measured before and after the
/// findings, held out; for every finding, what is left of the measurement without and with it,
/// against the channel that gave it away, as dots and as means over equally many samples; and the
/// error budget, its findings in the order of the chain. `name` is the log's. Needs
/// `diagnosis.compared`, which logs too short to judge do not have: throws std::invalid_argument.
[[nodiscard]] Figure diagnosis_figure(const std::string& name, const Diagnosis& diagnosis);

}  // namespace tethercalc
