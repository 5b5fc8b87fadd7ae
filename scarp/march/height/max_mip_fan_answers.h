// SPDX-License-Identifier: MIT
// Answers of a fan's strip: the range of its rays, and where they go. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_FAN_ANSWERS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_FAN_ANSWERS_H
#undef SCARP_MARCH_MAX_MIP_FAN_ANSWERS_H
#else
#define SCARP_MARCH_MAX_MIP_FAN_ANSWERS_H
#endif

#include <algorithm>
#include <limits>

#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/max_mip_fan_rays.h"
#include "scarp/march/height/max_mip_fan_walk.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

constexpr float kNoTime = std::numeric_limits<float>::infinity();

// Turns hits outside the range of the rays into misses, and doubtful ones into unknown times.
HWY_NOINLINE VF limit(const Fan& fan, VF T, VF per_major) {
  const VF never = hn::Set(df, kNoTime), zero = hn::Zero(df);
  const auto time = [](double t) { return static_cast<float>(std::clamp(t, -0x1p126, 0x1p126)); };
  const VF near = hn::Div(hn::Set(df, time(fan.t_min)), per_major);
  const VF far = hn::Div(hn::Set(df, time(fan.t_max)), per_major);
  const MF hit = hn::And(hn::Ge(T, zero), hn::Lt(T, never));
  // A hit is within its step, floats are off by less than another one.
  const VF slack = hn::MulAdd(hn::Set(df, 0x1p-20f), hn::Add(hn::Abs(T), hn::Max(hn::Abs(near), zero)), hn::Set(df, 3));
  const MF late = hn::And(hit, hn::Gt(hn::Sub(T, slack), far));
  // No hit is before the origin.
  const VF begin = fan.t_min > 0 ? near : hn::Set(df, -kNoTime);
  const MF early = hn::And(hit, hn::Lt(hn::Sub(T, slack), begin));
  const MF at_end = hn::And(hit, hn::Ge(hn::Add(T, slack), far));
  const VF unknown = hn::Set(df, -kNoTime);
  // Above the ground to the end; not if nothing is known, where both sides are infinite.
  const VF until = hn::Sub(hn::Set(df, -1), T), rounded = hn::MulAdd(hn::Set(df, 0x1p-19f), hn::Abs(until), far);
  const MF clear = hn::And(hn::Lt(T, zero), hn::Gt(hn::Sub(until, hn::Set(df, 1)), rounded));
  // Before a late hit the ray is above, but t_min may be behind it.
  T = hn::IfThenElse(hn::Or(early, at_end), unknown, T);
  return hn::IfThenElse(hn::Or(hn::AndNot(early, late), clear), never, T);
}

// One vector of a row: the first `width` lanes, or all at once.
template <class V, class E>
HWY_INLINE void put(V v, E* to, bool direct, int width) {
  constexpr hn::Simd<E, N, 0> d;
  if (direct) {
    hn::StoreU(v, d, to);
    return;
  }
  alignas(64) E all[N];
  hn::Store(v, d, all);
  for (int i = 0; i < width; ++i) to[i] = all[i];
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
