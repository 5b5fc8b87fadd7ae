// SPDX-License-Identifier: MIT
// Converts rays to arrays of their numbers, for vector code. Compiled once per instruction set.
#if defined(SCARP_MARCH_RAY_NUMBERS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_RAY_NUMBERS_SIMD_H
#undef SCARP_MARCH_RAY_NUMBERS_SIMD_H
#else
#define SCARP_MARCH_RAY_NUMBERS_SIMD_H
#endif

#include <cstddef>

#include "hwy/highway.h"
#include "scarp/base/ray.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// The first eight numbers of a ray.
constexpr std::size_t kRayNumbers = 8;
static_assert(offsetof(Ray, origin) == 0 && offsetof(Ray, direction) == 3 * sizeof(double) &&
              offsetof(Ray, t_min) == 6 * sizeof(double) && offsetof(Ray, t_max) == 7 * sizeof(double));

// Stores the numbers of ray(0) to ray(count - 1), each in a separate array. Reads vectors of four doubles per ray and
// transposes them.
template <class RayAt>
HWY_INLINE void load_ray_numbers(const RayAt& ray, std::size_t count, double* const (&to)[kRayNumbers]) {
  const auto numbers_of = [&](std::size_t i) { return reinterpret_cast<const double*>(&ray(i)); };
  std::size_t i = 0;
#if HWY_CAP_GE256
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr hn::CappedTag<double, 4> d4;
  for (; i + 4 <= count; i += 4) {
    const double* const from[4] = {numbers_of(i), numbers_of(i + 1), numbers_of(i + 2), numbers_of(i + 3)};
    for (std::size_t half = 0; half < kRayNumbers; half += 4) {
      const auto a = hn::LoadU(d4, from[0] + half), b = hn::LoadU(d4, from[1] + half);
      const auto c = hn::LoadU(d4, from[2] + half), d = hn::LoadU(d4, from[3] + half);
      const auto ab02 = hn::InterleaveLower(d4, a, b), ab13 = hn::InterleaveUpper(d4, a, b);
      const auto cd02 = hn::InterleaveLower(d4, c, d), cd13 = hn::InterleaveUpper(d4, c, d);
      hn::StoreU(hn::ConcatLowerLower(d4, cd02, ab02), d4, to[half] + i);
      hn::StoreU(hn::ConcatLowerLower(d4, cd13, ab13), d4, to[half + 1] + i);
      hn::StoreU(hn::ConcatUpperUpper(d4, cd02, ab02), d4, to[half + 2] + i);
      hn::StoreU(hn::ConcatUpperUpper(d4, cd13, ab13), d4, to[half + 3] + i);
    }
  }
  if (count % 4 == 0) return;  // known to compilers if the count is a constant
#endif
  for (; i < count; ++i) {
    for (std::size_t number = 0; number < kRayNumbers; ++number) to[number][i] = numbers_of(i)[number];
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
