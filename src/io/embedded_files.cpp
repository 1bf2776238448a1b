#include "io/embedded_files.hpp"

#include <stdexcept>
#include <string>

namespace tethercalc {

std::string_view embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.name == name) return file.content;
  }
  throw std::logic_error(std::string(name) + " is not part of the program");
}

}  // namespace tethercalc
