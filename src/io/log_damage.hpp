// What an autopilot's log lost, in words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/model/warning.hpp"

namespace tethercalc {

/// "1 sample left out", "2 samples left out".
[[nodiscard]] std::string samples_left_out(std::size_t count);

/// Adds what could not be read of the log; nothing where it is whole.
void note_damage(const LogContents& contents, std::vector<Warning>& notes);

}  // namespace tethercalc
