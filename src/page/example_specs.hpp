// Specs to start from, as compiled into the page's program.
#pragma once

#include <span>

#include "io/embedded_files.hpp"

namespace tethercalc {

/// Those of `examples/`, the published design first.
std::span<const EmbeddedFile> example_specs();

}  // namespace tethercalc
