#include "files/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, int error) {
  throw InputError(path.string(), "cannot be written: " + std::generic_category().message(error));
}

void write_directly(const std::filesystem::path& path, std::string_view content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) refuse(path, errno);
  const int error = write_all(file, content);
  ::close(file);
  if (error != 0) refuse(path, error);
}

}  // namespace

int write_all(int file, std::string_view& content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) refuse(path, EISDIR);
  if (std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status)) {
    return write_directly(path, content);
  }
  // Through a symbolic link, the file it points to is replaced, not the link.
  const std::filesystem::path target =
      std::filesystem::exists(status) ? std::filesystem::canonical(path) : path;
  std::string temporary = target.string() + ".XXXXXX";
  const int file = ::mkstemp(temporary.data());
  if (file < 0) refuse(path, errno);
  int error = write_all(file, content);
  // mkstemp makes files private; give this one the permissions of the file it replaces, or those
  // of any new file.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  const mode_t permissions =
      std::filesystem::exists(status) ? static_cast<mode_t>(status.permissions()) : (0666 & ~mask);
  if (error == 0 && ::fchmod(file, permissions) != 0) error = errno;
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    refuse(path, error);
  }
}

}  // namespace tethercalc
