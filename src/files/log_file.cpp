#include "files/log_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <lzma.h>
#include <zip.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

using Bytes = std::vector<std::byte>;

/// What comes out of a decompressor, part by part.
class Unpacking {
 public:
  Unpacking(const std::string& name, std::size_t limit) : name_(name), limit_(limit) {}

  void add(std::span<const std::byte> part) {
    if (part.size() > limit_ - all_.size()) {
      throw InputError(name_, fmt::format("unpacks to more than {} MiB, the most that a compressed "
                                          "log may have; unpack it, and give the log itself",
                                          limit_ >> 20));
    }
    all_.insert(all_.end(), part.begin(), part.end());
  }
  [[noreturn]] void fail(const char* kind) const {
    throw InputError(name_, fmt::format("is {}, but damaged or cut: only its first {} bytes can be "
                                        "unpacked",
                                        kind, all_.size()));
  }
  Bytes finish() { return std::move(all_); }

 private:
  const std::string& name_;
  std::size_t limit_;
  Bytes all_;
};

bool begins_with(std::span<const std::byte> content, std::string_view magic) {
  return content.size() >= magic.size() &&
         std::string_view(reinterpret_cast<const char*>(content.data()), magic.size()) == magic;
}

using Part = std::array<std::byte, 1 << 16>;

Bytes unpack_gzip(std::span<const std::byte> content, Unpacking unpacking) {
  constexpr const char* kind = "compressed by gzip";
  z_stream stream{};
  constexpr int gzip_only = 16 + MAX_WBITS;
  if (inflateInit2(&stream, gzip_only) != Z_OK) unpacking.fail(kind);
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  Part part;
  int result = Z_OK;
  while (true) {
    if (stream.avail_in == 0) {
      const std::size_t most = std::numeric_limits<uInt>::max();
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(content.data()));
      stream.avail_in = static_cast<uInt>(std::min(content.size(), most));
      content = content.subspan(stream.avail_in);
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    result = inflate(&stream, Z_NO_FLUSH);
    unpacking.add(std::span(part).first(part.size() - stream.avail_out));
    const bool is_all_read = stream.avail_in == 0 && content.empty();
    if (result == Z_STREAM_END) {
      if (is_all_read) break;
      // Files put together are one file (RFC 1952, section 2.2); what else follows is no log.
      constexpr Bytef magic = 0x1F;
      if (stream.avail_in > 0 && *stream.next_in != magic) break;
      if (inflateReset(&stream) != Z_OK) unpacking.fail(kind);
    } else if (result != Z_OK || (is_all_read && stream.avail_out > 0)) {
      unpacking.fail(kind);
    }
  }
  return unpacking.finish();
}

Bytes unpack_xz(std::span<const std::byte> content, Unpacking unpacking) {
  constexpr const char* kind = "compressed by xz";
  constexpr std::uint64_t most_memory = std::uint64_t{256} << 20;  // xz -9 needs 65 MiB
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, most_memory, LZMA_CONCATENATED) != LZMA_OK) unpacking.fail(kind);
  const std::unique_ptr<lzma_stream, void (*)(lzma_stream*)> end(&stream, lzma_end);
  stream.next_in = reinterpret_cast<const std::uint8_t*>(content.data());
  stream.avail_in = content.size();
  Part part;
  lzma_ret result = LZMA_OK;
  while (result == LZMA_OK) {
    stream.next_out = reinterpret_cast<std::uint8_t*>(part.data());
    stream.avail_out = part.size();
    result = lzma_code(&stream, LZMA_FINISH);
    unpacking.add(std::span(part).first(part.size() - stream.avail_out));
  }
  if (result != LZMA_STREAM_END) unpacking.fail(kind);
  return unpacking.finish();
}

Bytes unpack_zip(std::span<const std::byte> content, const std::string& name, Unpacking unpacking) {
  zip_error_t error{};
  zip_source_t* const source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  zip_t* const opened =
      source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error);
  if (opened == nullptr) {
    zip_source_free(source);
    throw InputError(
        name, fmt::format("is a zip archive, but cannot be read: {}", zip_error_strerror(&error)));
  }
  const std::unique_ptr<zip_t, void (*)(zip_t*)> archive(opened, zip_discard);
  std::vector<std::string> files;
  zip_uint64_t index = 0;
  const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t i = 0; i < entries; ++i) {
    const char* const entry =
        zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), ZIP_FL_ENC_GUESS);
    const std::string own = entry == nullptr ? "" : entry;
    // Folders, and what macOS adds of its own.
    if (own.ends_with('/') || own.starts_with("__MACOSX/")) continue;
    files.push_back(own);
    index = static_cast<zip_uint64_t>(i);
  }
  if (files.size() != 1) {
    constexpr std::size_t most_told = 5;
    const std::span told(files.data(), std::min(files.size(), most_told));
    throw InputError(name, files.empty()
                               ? "is a zip archive without a file in it"
                               : fmt::format("is a zip archive of {} files ({}{}); give one with "
                                             "the log alone, or the log itself",
                                             files.size(), fmt::join(told, ", "),
                                             files.size() > most_told ? ", ..." : ""));
  }
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
      zip_fopen_index(archive.get(), index, 0), zip_fclose);
  if (!file) {
    throw InputError(name, fmt::format("is a zip archive whose file {} cannot be unpacked: {}",
                                       files.front(), zip_strerror(archive.get())));
  }
  Part part;
  while (true) {
    const zip_int64_t got = zip_fread(file.get(), part.data(), part.size());
    if (got < 0) unpacking.fail("a zip archive");
    if (got == 0) break;
    unpacking.add(std::span(part).first(static_cast<std::size_t>(got)));
  }
  return unpacking.finish();
}

}  // namespace

std::optional<Bytes> unpacked(std::span<const std::byte> content, const std::string& name,
                              std::size_t limit) {
  Unpacking unpacking(name, limit);
  if (begins_with(content, "\x1F\x8B")) return unpack_gzip(content, std::move(unpacking));
  if (begins_with(content, std::string_view("\xFD"
                                            "7zXZ\0",
                                            6))) {
    return unpack_xz(content, std::move(unpacking));
  }
  if (begins_with(content, "PK\x03\x04") || begins_with(content, "PK\x05\x06")) {
    return unpack_zip(content, name, std::move(unpacking));
  }
  return std::nullopt;
}

}  // namespace tethercalc
