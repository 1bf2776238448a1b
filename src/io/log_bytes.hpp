// Numbers and texts in the bytes of a log.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace tethercalc::log_bytes {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied out of the log, which is little-endian");

/// The number that the log holds at `at`.
template <class T>
T read(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// The text at `at`, which ends with the first zero byte or with `size` characters.
inline std::string_view text_at(const std::byte* at, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(at), size);
  return all.substr(0, all.find('\0'));
}

}  // namespace tethercalc::log_bytes
