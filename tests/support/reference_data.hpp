// Where the data lies that this project reads in tests but does not ship.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

namespace tethercalc::test {

/// Path of a reference file, or nothing, with a line that reports the test as skipped.
inline std::optional<std::filesystem::path> reference_file(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(TETHERCALC_REFERENCE_DATA) / name;
  if (std::filesystem::exists(path)) return path;
  std::printf("SKIPPED: %s is not there\n", path.c_str());
  return std::nullopt;
}

}  // namespace tethercalc::test
