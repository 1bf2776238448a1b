// Effects of one's own from a JSON file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tethercalc/diagnose/hypothesis.hpp"

namespace tethercalc {

/// Reads the effects in the file at `path`, or on standard input where it is "-": one object, or a
/// list of them, each with
/// - `id`, `title`, `mechanism` and `to_separate` (the last may be missing);
/// - either `force_N`, a formula for the force forward on a drone in flight, or `power_W`, one for
///   the power drawn at the bus beyond the prediction of a power log;
/// - `parameters`: a list of objects with `name`, `lower`, `upper` and, if wanted, `unit` ("1"),
///   `neutral` (0) and `scale`, a change that matters (a hundredth of the range).
///
/// Formulas are muParser's: + − * / ^, comparisons that are 1 or 0, `?:`, sin, exp, abs, sqrt, min
/// and so on, over the channels of `formula_channels` and the parameters.
///
/// Throws InputError with every problem of the file and its line: what is missing, misspelt or of
/// another kind, names that are used twice or hide a channel, formulas that cannot be read, and
/// what `effect_of` refuses.
[[nodiscard]] std::vector<Effect> read_effects(const std::string& path);

/// The effects of several such files, in their order. Throws InputError likewise, and where two
/// files have effects of one id.
[[nodiscard]] std::vector<Effect> read_effect_files(std::span<const std::string> paths);

}  // namespace tethercalc
