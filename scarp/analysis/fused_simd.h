// SPDX-License-Identifier: MIT
// Multiplies and adds with one rounding, on any processor. Compiled once per instruction set.
#if defined(SCARP_ANALYSIS_FUSED_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_ANALYSIS_FUSED_SIMD_H
#undef SCARP_ANALYSIS_FUSED_SIMD_H
#else
#define SCARP_ANALYSIS_FUSED_SIMD_H
#endif

#include <cmath>
#include <cstddef>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// a * b + c of floats.
template <class V>
HWY_INLINE V fused(V a, V b, V c) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_NATIVE_FMA
  return hn::MulAdd(a, b, c);
#else
  const hn::DFromV<V> df;
  constexpr std::size_t kLanes = hn::MaxLanes(hn::DFromV<V>());
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  hn::Store(a, df, x), hn::Store(b, df, y), hn::Store(c, df, z);
  for (std::size_t i = 0; i < kLanes; ++i) x[i] = std::fma(x[i], y[i], z[i]);
  return hn::Load(df, x);
#endif
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
