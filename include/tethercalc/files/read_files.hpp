// Specs and logs from files; what they hold is told where their texts are read.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/log_readers.hpp"

namespace tethercalc {

/// Reads the files that a spec refers to, relative to `folder`.
[[nodiscard]] TextLoader files_in(std::filesystem::path folder);

/// Reads the spec at `path`, or on standard input where it is "-", as `parse_design` does. Files
/// that it or an override refers to are relative to the spec. Throws InputError as well where there
/// is no such file (naming the closest one in that folder), and where it is unreadable, empty or no
/// spec by its size.
[[nodiscard]] DesignFile read_design(const std::string& path,
                                     std::span<const std::string> overrides = {});

/// `spec`, read at `path`, as it has to stand in a file in `folder`: relative paths of motors and
/// materials lead to the same files from there. Nothing else changes.
[[nodiscard]] nlohmann::ordered_json spec_for_folder(nlohmann::ordered_json spec,
                                                     const std::string& path,
                                                     const std::filesystem::path& folder);

/// Reads the flight log at `path`, as `parse_flight_log` does; one that is compressed by gzip, xz
/// or in a zip archive of its own is unpacked in memory. Throws InputError as well where it cannot
/// be read or unpacked.
[[nodiscard]] FlightLogReading read_flight_log(const std::filesystem::path& path,
                                               const FlightLogOptions& options = {});

/// Reads the power log at `path`, as `parse_power_log` does, compressed or not. Throws InputError
/// as well where it cannot be read or unpacked.
[[nodiscard]] PowerLogReading read_power_log(const std::filesystem::path& path,
                                             const PowerLogOptions& options = {});

}  // namespace tethercalc
