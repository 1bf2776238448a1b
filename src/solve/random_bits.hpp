// Random bits by position instead of by order.
#pragma once

#include <cstdint>

namespace tethercalc {

/// A bijective mix of 64 bits: the output function of SplitMix64 (Steele, Lea and Flood 2014).
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Bits that depend on both numbers.
constexpr std::uint64_t mixed_bits(std::uint64_t a, std::uint64_t b) {
  return mixed_bits(mixed_bits(a) + b);
}

/// A number in (0, 1), never an end of it: the middle of one of 2^52 equal cells. (With 2^53 the
/// last middle would round to 1.)
constexpr double unit_number(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

}  // namespace tethercalc
