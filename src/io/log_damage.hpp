// What an autopilot's log lost, in words.
#pragma once

#include <vector>

#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// Adds what could not be read of the log; nothing where it is whole.
void note_damage(const LogContents& contents, std::vector<Warning>& notes);

}  // namespace tethercalc
