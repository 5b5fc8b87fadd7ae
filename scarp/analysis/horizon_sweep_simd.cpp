// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "scarp/analysis/horizon_sweep.h"
#include "scarp/base/prefetch.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/analysis/horizon_sweep_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/analysis/fused_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
#if HWY_TARGET != HWY_SCALAR
constexpr hn::Half<decltype(di)> dh;
constexpr hn::Half<decltype(du)> duh;
constexpr hn::RepartitionToWide<decltype(di)> di64;
constexpr hn::RepartitionToWide<decltype(du)> d64;
#endif
constexpr int N = static_cast<int>(hn::MaxLanes(df));
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;

HWY_INLINE VF take(hn::Mask<decltype(df)> m, VF yes, VF no) { return hn::IfThenElse(m, yes, no); }

class HorizonSweep {
 public:
  HorizonSweep(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits)
      : heights_(heights), table_(table), eye_(eye), line_(line), visits_(visits) {
    const auto deep = static_cast<std::size_t>(visits + 1) * kSweptLines;
    // Never read before they are written, and mostly never touched.
    hull_ = std::make_unique_for_overwrite<std::uint64_t[]>(deep);
  }

  void run(const SweepSink& sink) {
    constexpr int kLag = SweepTable::kNearSteps, kAhead = 6;
    for (int visit = 0; visit < visits_; ++visit) {
      const int first = line_ + swept_place(table_, visit).nearest;
      const SweptPlace sample = swept_place(table_, visit - kLag);
      prefetch(visit + kAhead);
      for (int at = 0; at < kSweptLines; at += N) {
        if (visit >= kLag) push(visit - kLag, sample, at);
        if (const int col = first + at; col > -N && col < heights_.cols()) look(visit, at, col);
      }
      const int begin = std::max(first, 0), end = std::min(first + kSweptLines, heights_.cols());
      if (begin < end) sink(begin, row_of(visit), end - begin, slopes_ + (begin - first), entries_ + (begin - first));
    }
  }

 private:
  // Loads the heights of a visit's nodes into the cache. They come from a new page with each row, which processors do
  // not foresee.
  void prefetch(int visit) const {
    if (visit >= visits_) return;
    constexpr int kLine = 64 / sizeof(float);
    const int first = line_ + swept_place(table_, visit).nearest;
    const int begin = std::max(first, 0), end = std::min(first + kSweptLines, heights_.cols());
    for (int col = begin; col < end; col += kLine) scarp::prefetch(heights_.height(col, row_of(visit)));
  }

  // Points of hulls, one per lane.
  struct Points {
    VF height, visit;
  };
  static HWY_INLINE Points choose(hn::Mask<decltype(df)> m, const Points& yes, const Points& no) {
    return {take(m, yes.height, no.height), take(m, yes.visit, no.visit)};
  }

  // Entry `depth` of the hull of each lane, counted from the far end; lanes with a negative depth return entry 0.
  HWY_INLINE Points hull_at(VI depth, int at) const {
    const VI place = hn::Add(hn::ShiftLeft<kShift>(hn::Max(depth, hn::Zero(di))), hn::Iota(di, at));
#if HWY_TARGET == HWY_SCALAR
    const std::uint64_t pair = hull_[static_cast<std::size_t>(hn::GetLane(place))];
    return {hn::BitCast(df, hn::Set(du, static_cast<std::uint32_t>(pair))),
            hn::BitCast(df, hn::Set(du, static_cast<std::uint32_t>(pair >> 32)))};
#else
    const auto low = hn::GatherIndex(d64, hull_.get(), hn::PromoteTo(di64, hn::LowerHalf(place)));
    const auto high = hn::GatherIndex(d64, hull_.get(), hn::PromoteTo(di64, hn::UpperHalf(dh, place)));
    return {hn::ConcatEven(df, hn::BitCast(df, high), hn::BitCast(df, low)),
            hn::ConcatOdd(df, hn::BitCast(df, high), hn::BitCast(df, low))};
#endif
  }
  HWY_INLINE void put_at(VI depth, int at, const Points& points) {
    const VI place = hn::Add(hn::ShiftLeft<kShift>(depth), hn::Iota(di, at));
    const auto height = hn::BitCast(du, points.height), visit = hn::BitCast(du, points.visit);
#if HWY_TARGET == HWY_SCALAR
    hull_[static_cast<std::size_t>(hn::GetLane(place))] =
        hn::GetLane(height) | static_cast<std::uint64_t>(hn::GetLane(visit)) << 32;
#else
    const auto put = [this](auto h, auto v, auto to) HWY_ATTR {
      const auto pair = hn::Or(hn::PromoteTo(d64, h), hn::ShiftLeft<32>(hn::PromoteTo(d64, v)));
      hn::ScatterIndex(pair, d64, hull_.get(), hn::PromoteTo(di64, to));
    };
    put(hn::LowerHalf(height), hn::LowerHalf(visit), hn::LowerHalf(place));
    put(hn::UpperHalf(duh, height), hn::UpperHalf(duh, visit), hn::UpperHalf(dh, place));
#endif
  }
  // The nearest points of hulls.
  HWY_INLINE Points nearest(int which, int at) const {
    return {hn::Load(df, nearest_[which].height + at), hn::Load(df, nearest_[which].visit + at)};
  }
  HWY_INLINE void keep(int which, int at, const Points& points) {
    hn::Store(points.height, df, nearest_[which].height + at);
    hn::Store(points.visit, df, nearest_[which].visit + at);
  }

  HWY_INLINE void push(int visit, const SweptPlace& place, int at) {
    const int col = line_ + at + place.before;
    if (col <= -N - 1 || col >= heights_.cols()) return;
    const float* first = heights_.height(col, row_of(visit));
    VF ground = hn::LoadU(df, first);
    if (place.w > 0) ground = fused(hn::Set(df, place.w), hn::Sub(hn::LoadU(df, first + 1), ground), ground);
    const auto exists = hn::Eq(ground, ground);
    if (hn::AllFalse(df, exists)) return;
    const auto when = static_cast<float>(visit);
    const VF now = hn::Set(df, when);
    const VF height = hn::Sub(ground, hn::Set(df, bend_at(when)));

    VI count = hn::Load(di, count_ + at);
    Points top = nearest(0, at), next = nearest(1, at), third = nearest(2, at);
    const VI one = hn::Set(di, 1);
    for (;;) {
      const auto covered = hn::Ge(hn::Mul(hn::Sub(next.height, height), hn::Sub(now, top.visit)),
                                  hn::Mul(hn::Sub(top.height, height), hn::Sub(now, next.visit)));
      const auto pops = hn::And(hn::And(exists, covered), hn::RebindMask(df, hn::Gt(count, one)));
      if (hn::AllFalse(df, pops)) break;
      count = hn::Sub(count, hn::IfThenElseZero(hn::RebindMask(di, pops), one));
      top = choose(pops, next, top), next = choose(pops, third, next);
      third = choose(pops, hull_at(hn::Sub(count, hn::Set(di, 3)), at), third);
    }
    // Lanes without a sample write above their hull.
    put_at(count, at, {height, now});
    hn::Store(hn::Add(count, hn::IfThenElseZero(hn::RebindMask(di, exists), one)), di, count_ + at);
    keep(2, at, choose(exists, next, third)), keep(1, at, choose(exists, top, next));
    keep(0, at, choose(exists, {height, now}, top));
  }

  HWY_INLINE void look(int visit, int at, int col) {
    const float* node = heights_.height(col, row_of(visit));
    const VF z = hn::Add(hn::LoadU(df, node), hn::Set(df, eye_));
    VF best = hn::Set(df, -std::numeric_limits<float>::infinity());
    VI entry = hn::Set(di, -1);
    std::int32_t number = 0;
    for (const SweepTable::Entry& e : table_.near()) {
      const float *first = node + e.first, *second = first + e.second;
      const VF a = hn::LoadU(df, first), b = hn::LoadU(df, second);
      const VF ground = fused(hn::Set(df, e.w), hn::Sub(b, a), hn::Sub(a, z));
      const VF slope = fused(ground, hn::Set(df, e.per_distance), hn::Set(df, -e.drop));
      const auto more = hn::Gt(slope, best);
      best = take(more, slope, best);
      entry = hn::IfThenElse(hn::RebindMask(di, more), hn::Set(di, number), entry);
      ++number;
    }
    const VI count = hn::Load(di, count_ + at);
    const auto any = hn::RebindMask(df, hn::Gt(count, hn::Zero(di)));
    if (!hn::AllFalse(df, any)) far(visit, at, node, z, count, any, best, entry);
    hn::StoreU(take(hn::IsNaN(z), z, best), df, slopes_ + at);
    hn::StoreU(entry, di, entries_ + at);
  }

  // The horizon where the tangent touches the hull.
  HWY_INLINE void far(int visit, int at, const float* node, VF z, VI count, hn::Mask<decltype(df)> any, VF& best,
                      VI& entry) const {
    const auto when = static_cast<float>(visit);
    const VF now = hn::Set(df, when), eye = hn::Sub(z, hn::Set(df, bend_at(when)));
    Points touched = nearest(0, at), next = nearest(1, at), third = nearest(2, at);
    const VI none = hn::Set(di, -1), one = hn::Set(di, 1);
    VI depth = hn::Sub(count, hn::Set(di, 2));
    auto lower = hn::RebindMask(df, hn::Gt(depth, none));
    for (;;) {
      lower = hn::And(lower, hn::Gt(hn::Mul(hn::Sub(next.height, eye), hn::Sub(now, touched.visit)),
                                    hn::Mul(hn::Sub(touched.height, eye), hn::Sub(now, next.visit))));
      if (hn::AllFalse(df, lower)) break;
      touched = choose(lower, next, touched), next = third;
      depth = hn::Sub(depth, one);
      lower = hn::And(lower, hn::RebindMask(df, hn::Gt(depth, none)));
      if (hn::AllFalse(df, lower)) break;
      third = hull_at(hn::Sub(depth, one), at);
    }
    const VF steps = hn::Sub(now, touched.visit);
    const VI step = hn::IfThenElseZero(hn::RebindMask(di, any), hn::ConvertTo(di, steps));
    const SweepTable::Majors& m = table_.majors();
    const VI first = hn::Add(hn::GatherIndex(di, m.first.data(), step), hn::Iota(di, 0));
    const VF w = hn::GatherIndex(df, m.w.data(), step);
    const auto between = hn::RebindMask(di, hn::Gt(w, hn::Zero(df)));
    const VI second = hn::Add(first, hn::IfThenElseZero(between, hn::Set(di, table_.beside())));
    const VF a = hn::GatherIndex(df, node, first), b = hn::GatherIndex(df, node, second);
    const VF ground = fused(w, hn::Sub(b, a), hn::Sub(a, z));
    VF slope = fused(ground, hn::GatherIndex(df, m.per_distance.data(), step),
                     hn::Neg(hn::GatherIndex(df, m.drop.data(), step)));
    if (const auto missing = hn::IsNaN(slope); !hn::AllFalse(df, missing)) {
      const VF tangent = hn::Sub(hn::Mul(hn::Div(hn::Sub(touched.height, eye), steps), hn::Set(df, table_.per_step())),
                                 hn::Set(df, 2 * table_.bend() * when * table_.per_step()));
      slope = take(missing, tangent, slope);
    }
    const auto more = hn::And(any, hn::Gt(slope, best));
    if (hn::AllFalse(df, more)) return;
    best = take(more, slope, best);
    entry = hn::IfThenElse(hn::RebindMask(di, more), hn::Add(step, hn::Set(di, table_.first_major())), entry);
  }

  int row_of(int visit) const { return table_.row_sign() > 0 ? heights_.rows() - 1 - visit : visit; }
  float bend_at(float visit) const { return table_.bend() * visit * visit; }

  static constexpr int kShift = 7;
  static_assert(1 << kShift == kSweptLines);

  const HorizonHeights& heights_;
  const SweepTable& table_;
  const float eye_;
  const int line_, visits_;
  // The hulls, entry by entry, each with all lines: a height in the lower half of the bits, a visit in the upper one.
  std::unique_ptr<std::uint64_t[]> hull_;
  // Their three nearest points, and their lengths.
  struct {
    alignas(64) float height[kSweptLines] = {}, visit[kSweptLines] = {};
  } nearest_[3];
  alignas(64) std::int32_t count_[kSweptLines] = {};
  alignas(64) float slopes_[kSweptLines];
  alignas(64) std::int32_t entries_[kSweptLines];
};

void sweep(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits,
           const SweepSink& sink) {
  HorizonSweep(heights, table, eye, line, visits).run(sink);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(sweep);

}  // namespace

void sweep_horizons(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits,
                    const SweepSink& sink) {
  HWY_DYNAMIC_DISPATCH(sweep)(heights, table, eye, line, visits, sink);
}

}  // namespace scarp
#endif
