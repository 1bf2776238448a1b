#include "files/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

std::vector<std::byte> read_to_end(int descriptor, const std::filesystem::path& path) {
  std::vector<std::byte> all;
  std::array<std::byte, 1 << 16> part;
  for (;;) {
    const ssize_t got = ::read(descriptor, part.data(), part.size());
    if (got == 0) return all;
    if (got > 0) {
      all.insert(all.end(), part.begin(), part.begin() + got);
    } else if (errno != EINTR) {
      throw InputError(path.string(), std::string("cannot be read: ") + std::strerror(errno));
    }
  }
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat status {};
  if (file.number < 0 || ::fstat(file.number, &status) != 0) {
    throw InputError(path.string(), std::string("cannot be opened: ") + std::strerror(errno));
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError(path.string(), "is a directory, expected a file");
  }
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (start != MAP_FAILED) {
      bytes_ = {static_cast<const std::byte*>(start), size};
      return;
    }
  }
  // Pipes, devices, and files whose size is not known beforehand (those under /proc say 0).
  copy_ = read_to_end(file.number, path);
  bytes_ = copy_;
}

MappedFile::~MappedFile() {
  if (copy_.empty() && !bytes_.empty()) {
    ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  }
}

}  // namespace tethercalc
