// SPDX-License-Identifier: MIT
// Four floats that are processed together: one register with GCC and clang; with other compilers (MSVC) an array, which
// they may vectorise.
#pragma once

#include <array>
#include <cstddef>

namespace scarp {

#if defined(__GNUC__)

using FourFloats = float __attribute__((vector_size(16)));

inline FourFloats greater_of(const FourFloats& a, const FourFloats& b) { return a > b ? a : b; }
inline FourFloats lesser_of(const FourFloats& a, const FourFloats& b) { return a < b ? a : b; }
/// Per element: non-zero where a <= b.
inline auto not_above(const FourFloats& a, const FourFloats& b) { return a <= b; }

#else

struct alignas(16) FourFloats {
  float v[4];

  float& operator[](std::size_t i) { return v[i]; }
  float operator[](std::size_t i) const { return v[i]; }
};

template <class Operation>
FourFloats of_each(const FourFloats& a, const FourFloats& b, const Operation& operation) {
  return {operation(a.v[0], b.v[0]), operation(a.v[1], b.v[1]), operation(a.v[2], b.v[2]), operation(a.v[3], b.v[3])};
}
inline FourFloats same(float f) { return {f, f, f, f}; }
inline FourFloats operator+(const FourFloats& a, float b) {
  return of_each(a, same(b), [](float x, float y) { return x + y; });
}
inline FourFloats operator-(const FourFloats& a, float b) {
  return of_each(a, same(b), [](float x, float y) { return x - y; });
}
inline FourFloats operator-(float a, const FourFloats& b) {
  return of_each(same(a), b, [](float x, float y) { return x - y; });
}
inline FourFloats operator*(const FourFloats& a, float b) {
  return of_each(a, same(b), [](float x, float y) { return x * y; });
}
inline FourFloats greater_of(const FourFloats& a, const FourFloats& b) {
  return of_each(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline FourFloats lesser_of(const FourFloats& a, const FourFloats& b) {
  return of_each(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline std::array<bool, 4> not_above(const FourFloats& a, const FourFloats& b) {
  return {a.v[0] <= b.v[0], a.v[1] <= b.v[1], a.v[2] <= b.v[2], a.v[3] <= b.v[3]};
}

#endif

}  // namespace scarp
