// Motors, conductors and insulation materials out of JSON objects, files and library names.
#pragma once

#include <optional>
#include <string_view>

#include "io/checked_values.hpp"
#include "tethercalc/io/library.hpp"

namespace tethercalc {

// Of an `Entry` that is a MotorEntry, a ConductorEntry or an InsulationEntry:

/// All of the library, by id.
template <typename Entry>
std::vector<Entry> library_entries();

/// Whether a spec's text names a file rather than an entry of the library.
[[nodiscard]] bool names_a_file(std::string_view reference);

/// The one that `reference` names, see `find_motor`.
template <typename Entry>
Entry find_entry(const std::string& reference, const TextLoader& load, const std::string& where);

/// The one that a spec has at `place`: an object, or a text that names one. Nothing, with the
/// reasons among the problems, where that fails.
template <typename Entry>
std::optional<Entry> entry_at(const JsonPlace& place, const TextLoader& load, Problems& problems);

/// A motor from the text of a test-bench CSV; `name` is the file's. See `find_motor`.
std::optional<MotorEntry> motor_from_bench_csv(const std::string& text, const std::string& name,
                                               Problems& problems);

}  // namespace tethercalc
