// The whole text of a small input file, or the reason why there is none.
#pragma once

#include <cstddef>
#include <string>

#include "tethercalc/io/library.hpp"

namespace tethercalc {

/// Specs, motors and materials are a few kilobytes; a file larger than this was named by mistake.
inline constexpr std::size_t text_file_limit = std::size_t{1} << 20;

/// Reads `path`, or standard input where it is "-". Throws InputError where there is no such file
/// (naming the closest one in that folder), where it is a directory, unreadable, empty, or larger
/// than `text_file_limit` bytes, of which no more is read.
LoadedText read_text_file(const std::string& path);

}  // namespace tethercalc
