// Decimal numbers in texts, whatever the language's locale.
#pragma once

#include <charconv>
#include <version>

#ifndef __cpp_lib_to_chars
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#endif

namespace tethercalc {

/// As std::from_chars, which the library of LLVM lacks for double up to version 19: there strtod
/// reads, of what from_chars would take and no more (no space, plus sign or hexadecimal digits).
inline std::from_chars_result read_number(const char* begin, const char* end, double& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(begin, end, value);
#else
  const char* const digits = begin != end && *begin == '-' ? begin + 1 : begin;
  const bool is_number =
      digits != end && ((*digits >= '0' && *digits <= '9') || *digits == '.' || *digits == 'i' ||
                        *digits == 'I' || *digits == 'n' || *digits == 'N');
  if (!is_number) return {begin, std::errc::invalid_argument};
  // "0x" is a zero with a letter behind it.
  const bool hexadecimal = end - digits > 1 && digits[0] == '0' && (digits[1] | 0x20) == 'x';
  const std::string text(begin, hexadecimal ? digits + 1 : end);
  char* stopped = nullptr;
  const double read = std::strtod(text.c_str(), &stopped);
  if (stopped == text.c_str()) return {begin, std::errc::invalid_argument};
  const char* const after = begin + (stopped - text.c_str());
  const bool infinite_by_name =
      std::any_of(digits, after, [](char c) { return (c | 0x20) == 'n'; });
  const char* const exponent =
      std::find_if(digits, after, [](char c) { return (c | 0x20) == 'e'; });
  const bool some_digit =
      std::any_of(digits, exponent, [](char c) { return c >= '1' && c <= '9'; });
  const bool out_of_range = (std::isinf(read) && !infinite_by_name) || (read == 0 && some_digit);
  if (out_of_range) return {after, std::errc::result_out_of_range};
  value = read;
  return {after, {}};
#endif
}

/// Whole numbers as std::from_chars.
template <typename Whole>
std::from_chars_result read_number(const char* begin, const char* end, Whole& value) {
  return std::from_chars(begin, end, value);
}

}  // namespace tethercalc
