// Whatever a file to be resumed holds, its whole lines stay, what follows them goes, and rows are
// appended behind.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "files/output_files.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

std::string content_of(int file) {
  std::string text(static_cast<std::size_t>(::lseek(file, 0, SEEK_END)), '\0');
  require(::pread(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()));
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int memory = ::memfd_create("rows", 0);
  require(memory >= 0 && ::write(memory, data, size) == static_cast<ssize_t>(size));
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string_view whole = text.substr(0, text.find_last_of('\n') + 1);
  {
    auto file = tethercalc::RowFile::resume("/proc/self/fd/" + std::to_string(memory));
    require(file.lines_found() ==
            static_cast<std::uint64_t>(std::count(whole.begin(), whole.end(), '\n')));
    if (!whole.empty()) {
      const std::string_view lines = whole.substr(0, whole.size() - 1);
      require(file.first_line() == lines.substr(0, lines.find('\n')));
      const std::size_t before_last = lines.find_last_of('\n');
      require(file.last_line() ==
              lines.substr(before_last == std::string_view::npos ? 0 : before_last + 1));
    }
    file.append("one,more\nrow\n");
    file.close();
  }
  require(content_of(memory) == std::string(whole) + "one,more\nrow\n");
  ::close(memory);
  return 0;
}
