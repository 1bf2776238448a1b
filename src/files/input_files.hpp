// The whole content of a file to read: a small text, or any number of bytes without a copy of them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "tethercalc/io/library.hpp"

namespace tethercalc {

/// Specs, motors and materials are a few kilobytes; a file larger than this was named by mistake.
inline constexpr std::size_t text_file_limit = std::size_t{1} << 20;

/// Reads `path`, or standard input where it is "-". Throws InputError where there is no such file
/// (naming the closest one in that folder), where it is a directory, unreadable, empty, or larger
/// than `text_file_limit` bytes, of which no more is read.
LoadedText read_text_file(const std::string& path);

/// Whether `path` is a file that `read_text_file` has read in this process.
[[nodiscard]] bool has_been_read(const std::filesystem::path& path);

/// A whole file, read in place: a regular file is memory-mapped, so that only the pages looked at
/// are loaded and none counts as memory of this process; a pipe or device is read into memory.
/// The bytes stay valid as long as this object lives. The file must not be shortened meanwhile:
/// the operating system answers a read beyond a mapped file's end with a signal (SIGBUS), of which
/// the command line makes a message.
class MappedFile {
 public:
  /// Throws InputError, naming the file and the system's reason, where it cannot be opened or read,
  /// or is a directory.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// The whole file.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  /// The same as characters, whatever their encoding.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

 private:
  std::span<const std::byte> bytes_;
  std::string copy_;  // holds the bytes where the file could not be mapped
  std::string name_;
};

/// The name of the file that is mapped where `address` lies, or nullptr where none is known to be:
/// for the handler of SIGBUS, in which little else may be called.
[[nodiscard]] const char* mapped_file_at(const void* address) noexcept;

}  // namespace tethercalc
