// What would bring the streams and locales of the C++ library into the page's program, without
// them. Force-included where that is compiled.
#pragma once

#include <string>

// fmt separates thousands by this instead of asking a locale; nothing here asks it for separators.
#define FMT_STATIC_THOUSANDS_SEPARATOR ','
#include <fmt/format.h>

namespace boost::math::policies::detail {

/// The number in the message of an error, which Boost writes by a stream.
template <class T>
std::string prec_format(const T& val);
template <>
inline std::string prec_format(const double& val) {
  return fmt::format("{}", val);
}
template <>
inline std::string prec_format(const long double& val) {
  return fmt::format("{}", double(val));
}

}  // namespace boost::math::policies::detail
