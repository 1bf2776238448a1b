// Where the data lies that this project reads in tests but does not ship.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
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

/// The same, read.
inline std::optional<nlohmann::json> reference_json(const std::string& name) {
  const auto path = reference_file(name);
  if (!path) return std::nullopt;
  std::ifstream file(*path);
  return nlohmann::json::parse(file);
}

}  // namespace tethercalc::test
