// SPDX-License-Identifier: MIT
// A common deep start for 64 consecutive rays from above: they form a beam, and while the beam is above the ground
// below it no single ray needs a test.
//
//   \\\\ the beam, T to T + step       free if its lowest point is above the highest
//    \\\\                              ground in the rectangle that it passes: at most
//     +--------+                       four blocks of the pyramid. Continue from T + step,
//     | _/\__  |                       otherwise with half the step; the rays continue one by
//     +--------+                       one when the step is not much longer than the beam is wide
//
// All rays advance along both axes of their frames, so the near corner of the rectangle is that of the beam's start,
// the far one that of its end. Source: A. Reshetov, A. Soupikov, J. Hurley, "Multi-level ray tracing algorithm", ACM
// Transactions on Graphics 24(3), 2005 (one entry point for a beam of rays). Heights include the margin of Lanes;
// maxima need none. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_BEAM_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_BEAM_H
#undef SCARP_MARCH_MAX_MIP_SIMD_BEAM_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_BEAM_H
#endif

#include <algorithm>
#include <bit>
#include <limits>

#include "scarp/march/height/max_mip_simd_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

constexpr std::int32_t kMostCells = std::numeric_limits<std::int32_t>::max();
// Found with scarp-bench (doc/dev/decisions/march.md): minimum ratio of length to width of a beam; first step as a
// fraction of the previous beam's length; factor of steps after it. The shortest step is the width of the beam, within
// limits in cells.
constexpr float kSlender = 8, kShareOfBefore = 0.9f, kShorter = 0.25f;
constexpr std::int32_t kLeastShortest = 1, kMostShortest = 4;
// Level at which its rays continue.
constexpr std::int32_t kLevelAfterBeam = 1;

// Upper bound of the ground in the cells [x0, x1] x [y0, y1], from up to four blocks.
template <class T>
HWY_INLINE float highest_over(const VectorGround<T>& g, std::int32_t x0, std::int32_t x1, std::int32_t y0,
                              std::int32_t y1) {
  const auto span = static_cast<unsigned>(std::max(x1 - x0, y1 - y0));
  const int level = std::clamp(static_cast<int>(std::bit_width(span)), 1, static_cast<int>(g.top));
  const std::int32_t cols = (g.last_col >> level) + 1;
  const std::uint32_t* blocks = g.blocks + g.level_begin[level];
  const std::int32_t c0 = x0 >> level, c1 = x1 >> level, r0 = (y0 >> level) * cols, r1 = (y1 >> level) * cols;
  const auto code = [blocks](std::int32_t entry) { return static_cast<int>(blocks[entry] & 0xffff); };
  const int highest = std::max(std::max(code(r0 + c0), code(r0 + c1)), std::max(code(r1 + c0), code(r1 + c1)));
  return static_cast<float>(highest) * g.maxima_scale + g.maxima_shift;
}

// Common bounds of the rays at a time.
struct BeamPlace {
  std::int32_t x0, x1, y0, y1;  // cells of their frames, inclusive
  float low;                    // lowest height of the rays

  std::int32_t width() const { return std::max(x1 - x0, y1 - y0); }
};

class Beam {
 public:
  /// The active rays of `lanes`.
  HWY_INLINE Beam(Lanes* lanes, std::size_t count) : lanes_(lanes), count_(count) {
    VI mirror_x0 = hn::Set(di, kMostCells), mirror_y0 = mirror_x0, mirror_x1 = hn::Set(di, -1), mirror_y1 = mirror_x1;
    VF end = hn::Set(df, kNever);
    for (std::size_t k = 0; k < count_; ++k) {
      const Lanes& a = lanes_[k];
      const MI walk = walking(a);
      const VI mx = hn::Load(di, a.mirror_x), my = hn::Load(di, a.mirror_y);
      mirror_x0 = hn::IfThenElse(walk, hn::Min(mirror_x0, mx), mirror_x0);
      mirror_y0 = hn::IfThenElse(walk, hn::Min(mirror_y0, my), mirror_y0);
      mirror_x1 = hn::IfThenElse(walk, hn::Max(mirror_x1, mx), mirror_x1);
      mirror_y1 = hn::IfThenElse(walk, hn::Max(mirror_y1, my), mirror_y1);
      end = hn::IfThenElse(hn::RebindMask(df, walk), hn::Min(end, hn::Load(df, a.end)), end);
    }
    mirror_x_ = hn::GetLane(hn::MaxOfLanes(di, mirror_x1)), mirror_y_ = hn::GetLane(hn::MaxOfLanes(di, mirror_y1));
    goes_one_way_ = mirror_x_ >= 0 && hn::GetLane(hn::MinOfLanes(di, mirror_x0)) == mirror_x_ &&
                    hn::GetLane(hn::MinOfLanes(di, mirror_y0)) == mirror_y_;
    end_ = hn::GetLane(hn::MinOfLanes(df, end)) * (1 - 0x1p-10f);
  }

  HWY_INLINE bool goes_one_way() const { return goes_one_way_; }
  HWY_INLINE float end() const { return end_; }

  HWY_INLINE BeamPlace at(float time) const {
    const VF t = hn::Set(df, time);
    VI x0 = hn::Set(di, kMostCells), y0 = x0, x1 = hn::Set(di, -1), y1 = x1;
    VF low = hn::Set(df, kNever);
    for (std::size_t k = 0; k < count_; ++k) {
      const Lanes& a = lanes_[k];
      const MI walk = walking(a);
      const VI x = cell(a.dx, a.ox, a.begin_x, a.last_x, t), y = cell(a.dy, a.oy, a.begin_y, a.last_y, t);
      const VF height = hn::MulAdd(hn::Load(df, a.dz), t, hn::Load(df, a.z));
      x0 = hn::IfThenElse(walk, hn::Min(x0, x), x0), x1 = hn::IfThenElse(walk, hn::Max(x1, x), x1);
      y0 = hn::IfThenElse(walk, hn::Min(y0, y), y0), y1 = hn::IfThenElse(walk, hn::Max(y1, y), y1);
      low = hn::IfThenElse(hn::RebindMask(df, walk), hn::Min(low, height), low);
    }
    return {hn::GetLane(hn::MinOfLanes(di, x0)), hn::GetLane(hn::MaxOfLanes(di, x1)),
            hn::GetLane(hn::MinOfLanes(di, y0)), hn::GetLane(hn::MaxOfLanes(di, y1)),
            hn::GetLane(hn::MinOfLanes(df, low))};
  }

  /// Returns whether the rays are above all ground between the two positions.
  template <class T>
  HWY_INLINE bool is_free(const VectorGround<T>& g, const BeamPlace& from, const BeamPlace& to) const {
    // Mirrored, the far corner comes first.
    const auto [c0, c1] = std::minmax({from.x0 ^ mirror_x_, to.x1 ^ mirror_x_});
    const auto [r0, r1] = std::minmax({from.y0 ^ mirror_y_, to.y1 ^ mirror_y_});
    return std::min(from.low, to.low) > highest_over(g, c0, c1, r0, r1);
  }

  /// Continues the rays from there one by one; returns their number.
  HWY_INLINE std::size_t start(float time, std::int32_t level) {
    const VF t = hn::Set(df, time);
    std::size_t rays = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      Lanes& a = lanes_[k];
      const MI walk = walking(a);
      const auto put = [&](VI v, std::int32_t* to)
                           HWY_ATTR { hn::Store(hn::IfThenElse(walk, v, hn::Load(di, to)), di, to); };
      put(cell(a.dx, a.ox, a.begin_x, a.last_x, t), a.x), put(cell(a.dy, a.oy, a.begin_y, a.last_y, t), a.y);
      put(hn::Set(di, level), a.level), put(hn::Set(di, 1), a.seen);
      hn::Store(hn::IfThenElse(hn::RebindMask(df, walk), t, hn::Load(df, a.T)), df, a.T);
      rays += hn::CountTrue(di, walk);
    }
    return rays;
  }

 private:
  static HWY_INLINE MI walking(const Lanes& a) { return hn::Eq(hn::Load(di, a.status), hn::Zero(di)); }
  static HWY_INLINE VI cell(const float* d, const float* o, const std::int32_t* begin, const std::int32_t* last, VF t) {
    const VF way = hn::MulAdd(hn::Load(df, d), t, hn::Load(df, o));
    return hn::Min(hn::Add(hn::ConvertTo(di, way), hn::Load(di, begin)), hn::Load(di, last));
  }

  Lanes* lanes_;
  std::size_t count_;
  std::int32_t mirror_x_, mirror_y_;
  float end_;
  bool goes_one_way_;
};

// Advances the rays of `lanes` to where they are no longer jointly above the ground, and returns their number, or 0.
// `expected` is the distance of the previous rays.
template <class T>
HWY_NOINLINE std::size_t follow_beam(const VectorGround<T>& g, Lanes* lanes, std::size_t count, float& expected) {
  Beam beam(lanes, count);
  if (!beam.goes_one_way()) return 0;
  BeamPlace here = beam.at(0);
  if (static_cast<float>(here.width()) * kSlender > beam.end() || !beam.is_free(g, here, here)) return 0;
  const bool guessed = expected > 0;
  float clear = 0, step = guessed ? kShareOfBefore * std::min(expected, beam.end()) : beam.end() / 2;
  while (step >= static_cast<float>(std::clamp(here.width(), kLeastShortest, kMostShortest))) {
    const float then = clear + step;
    if (then < beam.end()) {
      const BeamPlace there = beam.at(then);
      if (beam.is_free(g, here, there)) {
        if (guessed && clear == 0) step *= kShorter;
        clear = then, here = there;
        continue;
      }
    }
    step /= 2;
  }
  expected = clear;
  return clear > 0 ? beam.start(clear, std::min(kLevelAfterBeam, g.top)) : 0;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
