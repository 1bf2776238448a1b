// What one does with vectors.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "tethercalc/model/moving_air.hpp"

namespace tethercalc {

inline double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }
inline Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3 operator*(double k, const Vector3& a) { return {k * a.x, k * a.y, k * a.z}; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector3 direction_of(const Vector3& a) { return (1 / norm(a)) * a; }

inline Vector3 axis_direction(std::size_t axis) {
  return {axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
}

/// Two directions across `t` and each other.
inline std::array<Vector3, 2> across(const Vector3& t) {
  const Vector3 other = std::abs(t.z) < 0.7 ? Vector3{0, 0, 1} : Vector3{1, 0, 0};
  const Vector3 first = direction_of(cross(other, t));
  return {first, cross(t, first)};
}

}  // namespace tethercalc
