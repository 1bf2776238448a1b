// The logs that options name, read from their files.
#pragma once

#include "io/log_questions.hpp"

namespace tethercalc {

/// Reads logs from files, compressed or not.
[[nodiscard]] LogReaders logs_in_files();

}  // namespace tethercalc
