// Motors, conductors and insulation materials out of JSON objects, files and library names.
#pragma once

#include <optional>

#include "io/checked_values.hpp"
#include "tethercalc/io/library.hpp"

namespace tethercalc {

/// Reads what a spec has at `place`: an object, or a text that names a library entry or a file
/// that `load` reads. Nothing, with the reasons among the problems, where that fails.
std::optional<MotorEntry> read_motor(const JsonPlace& place, const TextLoader& load,
                                     Problems& problems);
std::optional<ConductorEntry> read_conductor(const JsonPlace& place, const TextLoader& load,
                                             Problems& problems);
std::optional<InsulationEntry> read_insulation(const JsonPlace& place, const TextLoader& load,
                                               Problems& problems);

/// A motor from the text of a test-bench CSV; `name` is the file's. See `find_motor`.
std::optional<MotorEntry> motor_from_bench_csv(const std::string& text, const std::string& name,
                                               Problems& problems);

}  // namespace tethercalc
