#include "tethercalc/files/read_files.hpp"

#include <utility>

#include "files/input_files.hpp"

namespace tethercalc {

TextLoader files_in(std::filesystem::path folder) {
  return [folder = std::move(folder)](const std::string& reference) {
    return read_text_file((folder / reference).string());
  };
}

DesignFile read_design(const std::string& path, std::span<const std::string> overrides) {
  const LoadedText file = read_text_file(path);
  return parse_design(file.text, file.name,
                      files_in(path == "-" ? "." : std::filesystem::path(path).parent_path()),
                      overrides);
}

FlightLogReading read_flight_log(const std::filesystem::path& path,
                                 const FlightLogOptions& options) {
  const MappedFile file(path);
  return parse_flight_log(file.bytes(), path.string(), options);
}

PowerLog read_power_log(const std::filesystem::path& path) {
  const MappedFile file(path);
  return parse_power_log(file.text(), path.string());
}

}  // namespace tethercalc
