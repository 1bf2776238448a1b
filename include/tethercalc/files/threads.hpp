// Work done by several threads whose results come back in order.
#pragma once

#include "tethercalc/solve/ordered_chunks.hpp"

namespace tethercalc {

/// Number of threads that use every core.
[[nodiscard]] unsigned all_cores();

/// Computes chunks on `threads` (≥ 1) threads. At most four results a thread exist at a time:
/// memory does not grow with the number of chunks, and a slow consumer slows the producers.
[[nodiscard]] ChunkRunner several_threads(unsigned threads);

}  // namespace tethercalc
