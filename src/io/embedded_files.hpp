// The data folder as compiled into the program.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tethercalc {

struct EmbeddedFile {
  std::string_view name;  ///< path below `data/`, e.g. "motors/holybro-air2216-920kv-10in.json"
  std::string_view content;
};

/// Every file of `data/` in alphabetical order of its path.
std::span<const EmbeddedFile> embedded_files();

/// The one of that name; null where the program was built without it.
inline const EmbeddedFile* find_embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.name == name) return &file;
  }
  return nullptr;
}

/// The content of one of them, which must exist.
inline std::string_view embedded_file(std::string_view name) {
  if (const EmbeddedFile* file = find_embedded_file(name)) return file->content;
  throw std::logic_error(std::string(name) + " is not part of the program");
}

}  // namespace tethercalc
