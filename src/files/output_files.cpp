#include "files/output_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void refuse(const std::filesystem::path& path, int error) {
  throw InputError(path.string(), "cannot be written: " + reason(error));
}

/// Writes `content` to an open file. Returns 0 or the system's error; what was not written is left
/// in `content`.
int write_all(int file, std::string_view& content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

bool is_regular_file(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

int open_or_refuse(const std::string& path, int flags, const char* purpose) {
  const int file = ::open(path.c_str(), flags | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) {
    throw InputError(path, std::string("cannot be opened for ") + purpose + ": " + reason(errno));
  }
  return file;
}

constexpr int most_links = 40;  // as Linux follows

/// What a symbolic link points to; nothing where `path` is none.
std::optional<std::filesystem::path> next_link(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return std::nullopt;
  return path.parent_path() / std::filesystem::read_symlink(path, error);
}

/// Where the links end that `path` may be, whether there is something or not.
std::filesystem::path end_of_links(std::filesystem::path path) {
  for (int k = 0; k < most_links; ++k) {
    const auto next = next_link(path);
    if (!next) break;
    path = *next;
  }
  return path;
}

/// The open file of this process that `path` is another name of, as /dev/stdout and /dev/fd/3 are.
/// Opened by that name a regular file would be written from its beginning, over what others have
/// appended.
std::optional<int> own_descriptor(std::filesystem::path path) {
  std::error_code error;
  const auto descriptors = std::filesystem::canonical("/proc/self/fd", error);
  if (error) return std::nullopt;
  for (int k = 0; k < most_links; ++k) {
    const auto next = next_link(path);
    if (!next) break;
    const std::string name = path.filename().string();
    int number = -1;
    const char* const end = name.data() + name.size();
    if (std::filesystem::canonical(path.parent_path(), error) == descriptors &&
        std::from_chars(name.data(), end, number).ptr == end) {
      return number;
    }
    path = *next;
  }
  return std::nullopt;
}

/// The temporary file of the one WholeFile that is open, for handlers of signals.
std::array<char, PATH_MAX> unfinished{};
volatile std::sig_atomic_t is_unfinished = 0;

void note_unfinished(const std::string& file) {
  if (file.size() >= unfinished.size()) return;
  std::copy(file.c_str(), file.c_str() + file.size() + 1, unfinished.begin());
  is_unfinished = 1;
}

/// mkstemp makes files private; this gives one the permissions of the file that it replaces, or
/// those of any new file.
int give_permissions(int file, const std::filesystem::path& replaced) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  std::error_code ignored;
  const auto status = std::filesystem::status(replaced, ignored);
  const mode_t permissions = std::filesystem::exists(status)
                                 ? static_cast<mode_t>(status.permissions()) & 0777
                                 : 0666 & ~mask;
  return ::fchmod(file, permissions) != 0 ? errno : 0;
}

}  // namespace

void remove_unfinished_file() noexcept {
  if (is_unfinished == 0) return;
  is_unfinished = 0;
  ::unlink(unfinished.data());
}

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)) {
  if (const auto descriptor = own_descriptor(path_)) {
    file_ = *descriptor;
    owned_ = false;
    return;
  }
  std::error_code ignored;
  const auto status = std::filesystem::status(path_, ignored);
  if (std::filesystem::is_directory(status)) refuse(path_, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);  // devices, pipes, sockets
  } else {
    // Through a symbolic link, the file it points to is replaced or made, not the link.
    target_ = end_of_links(path_);
    temporary_ = target_.string() + ".XXXXXX";
    file_ = ::mkstemp(temporary_.data());
    if (file_ >= 0) note_unfinished(temporary_);
  }
  if (file_ < 0) refuse(path_, errno);
}

WholeFile::~WholeFile() {
  if (file_ < 0) return;
  if (owned_) ::close(file_);
  if (!temporary_.empty()) remove_unfinished_file();
}

void WholeFile::append(std::string_view part) {
  if (const int error = write_all(file_, part); error != 0) refuse(path_, error);
}

void WholeFile::commit() {
  const int file = std::exchange(file_, -1);
  int error = 0;
  if (!temporary_.empty()) {
    error = give_permissions(file, path_);
    if (error == 0 && ::fsync(file) != 0 && errno != EINVAL) error = errno;
  }
  if (owned_ && ::close(file) != 0 && error == 0 && errno != EINTR) error = errno;
  if (!temporary_.empty()) {
    if (error == 0 && ::rename(temporary_.c_str(), target_.c_str()) != 0) error = errno;
    if (error == 0) is_unfinished = 0;
    remove_unfinished_file();
  }
  if (error != 0) refuse(path_, error);
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  WholeFile file(path);
  file.append(content);
  file.commit();
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(a, ignored) && std::filesystem::equivalent(a, b, ignored);
}

void check_can_be_written(const std::filesystem::path& path) {
  if (own_descriptor(path)) return;
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) refuse(path, EISDIR);
  const bool replaced = !std::filesystem::is_other(status);
  const std::filesystem::path folder = end_of_links(path).parent_path();
  const std::filesystem::path written = !replaced ? path : folder.empty() ? "." : folder;
  if (::access(written.c_str(), W_OK) != 0) refuse(path, errno);
}

void check_unedited(const std::filesystem::path& path, std::string_view unedited) {
  std::error_code ignored;
  if (own_descriptor(path) || !std::filesystem::is_regular_file(path, ignored)) return;
  std::ostringstream there;
  there << std::ifstream(path, std::ios::binary).rdbuf();
  if (there.str() == unedited) return;
  throw InputError(path.string(), "is there and was edited; --force writes over it");
}

RowFile::RowFile(int file, std::string name, bool owned)
    : file_(file), owned_(owned), regular_(is_regular_file(file)), name_(std::move(name)) {
  // Redirected to a file that others have written to before, as in (a; b) > file.
  const off_t offset = regular_ && !owned ? ::lseek(file, 0, SEEK_CUR) : 0;
  size_ = offset > 0 ? static_cast<std::uint64_t>(offset) : 0;
}

RowFile::RowFile(int file, std::string name) : RowFile(file, std::move(name), true) {
  if (!regular_) throw InputError(name_, "is no regular file, so it cannot be continued");
  read_what_is_there();
  const auto size = static_cast<off_t>(size_);
  if (::lseek(file_, size, SEEK_SET) != size) {
    throw InputError(name_, "cannot be continued: " + reason(errno));
  }
}

RowFile::~RowFile() {
  if (owned_ && file_ >= 0) ::close(file_);
}

RowFile RowFile::standard_output() { return {STDOUT_FILENO, "standard output", false}; }

RowFile RowFile::create(const std::string& path) {
  if (const auto descriptor = own_descriptor(path)) return {*descriptor, path, false};
  return {open_or_refuse(path, O_WRONLY | O_TRUNC, "writing"), path, true};
}

RowFile RowFile::resume(const std::string& path) {
  return {open_or_refuse(path, O_RDWR, "reading and writing"), path};
}

void RowFile::read_what_is_there() {
  std::vector<char> buffer(std::size_t{1} << 20);
  std::string line;  // since the last newline
  while (true) {
    const ssize_t count = ::read(file_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(name_, "cannot be read: " + reason(errno));
    if (count == 0) break;
    std::string_view rest(buffer.data(), static_cast<std::size_t>(count));
    for (std::size_t end = rest.find('\n'); end != rest.npos; end = rest.find('\n')) {
      line += rest.substr(0, end);
      rest.remove_prefix(end + 1);
      size_ += line.size() + 1;
      if (lines_found_++ == 0) first_line_ = line;
      std::swap(last_line_, line);
      line.clear();
    }
    line += rest;
  }
  broken_line_ = std::move(line);
}

void RowFile::append(std::string_view lines) {
  if (!broken_line_.empty() && ::ftruncate(file_, static_cast<off_t>(size_)) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  broken_line_.clear();
  std::string_view rest = lines;
  const int error = write_all(file_, rest);
  const std::string_view written = lines.substr(0, lines.size() - rest.size());
  const std::string_view whole = written.substr(0, written.rfind('\n') + 1);
  size_ += whole.size();
  if (error == 0) return;
  if (regular_ && whole.size() < written.size()) {
    // Nothing better can be done where even this fails; `resume` will find a broken line then.
    [[maybe_unused]] const int ignored = ::ftruncate(file_, static_cast<off_t>(size_));
  }
  throw std::system_error(error, std::generic_category());
}

void RowFile::close() {
  if (!owned_ || file_ < 0) return;
  if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category());
  }
}

}  // namespace tethercalc
