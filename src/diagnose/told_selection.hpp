// What a selection says of the effects that it found, whatever the log.
#pragma once

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/diagnose/selection.hpp"

namespace tethercalc {

/// What is told of `effect`, which was `selected`: all but its parameters and its rivals.
Finding finding_of(const Effect& effect, const SelectedGroup& selected);

/// Parts of the base model's held-out squared error, which sum to the whole.
ErrorBudget error_budget(const Selection& selection);

}  // namespace tethercalc
