// `--set path=value`: a spec edited from the command line.
#pragma once

#include <span>
#include <string>

#include "io/checked_values.hpp"
#include "io/json_document.hpp"

namespace tethercalc {

/// Edits `document` as each of `overrides` says; later ones win. Reports a missing "=", a path that
/// no spec has, with the closest that one may have, and a path below something that is no object or
/// list. The values themselves are left to the reader.
void apply_overrides(JsonDocument& document, std::span<const std::string> overrides,
                     Problems& problems);

}  // namespace tethercalc
