// Files that are written whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace tethercalc {

/// Writes `content` to a temporary file beside `path` and renames it, so that `path` holds either
/// what it held before or all of `content`. Devices and pipes, such as /dev/stdout, are written
/// directly. Throws InputError, naming the file and the system's reason, where that fails.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

/// Writes `content` to an open file. Returns 0 or the system's error; what was not written is left
/// in `content`.
[[nodiscard]] int write_all(int file, std::string_view& content);

}  // namespace tethercalc
