// A log's file as its bytes, compressed or not.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/input_files.hpp"

namespace tethercalc {

/// The most that a compressed log may unpack to. Logs of hours have some 100 MB; a file of a few
/// bytes that unpacks to more than this was made to fill the memory.
inline constexpr std::size_t unpacked_limit = std::size_t{1} << 30;

/// The content of what is compressed by gzip (RFC 1952) or xz, or of the one file in a zip archive;
/// nothing where it is none of these, by its first bytes. `name` stands for it in messages.
///
/// Throws InputError where it is damaged or cut, an archive holds no or several files or one that
/// is encrypted, or where more than `limit` bytes come out, of which no more is kept.
[[nodiscard]] std::optional<std::vector<std::byte>> unpacked(std::span<const std::byte> content,
                                                             const std::string& name,
                                                             std::size_t limit = unpacked_limit);

/// A file, read in place as MappedFile does, or unpacked in memory.
class LogFile {
 public:
  /// Throws InputError where it cannot be read or unpacked.
  explicit LogFile(const std::filesystem::path& path)
      : file_(path), unpacked_(unpacked(file_.bytes(), path.string())) {}

  /// The whole log.
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return unpacked_ ? std::span<const std::byte>(*unpacked_) : file_.bytes();
  }
  /// The same as characters, whatever their encoding.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes().data()), bytes().size()};
  }

 private:
  MappedFile file_;
  std::optional<std::vector<std::byte>> unpacked_;
};

}  // namespace tethercalc
