// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "scarp/analysis/horizon_scan.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/analysis/horizon_scan_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/analysis/fused_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, kGroupCols> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr std::size_t N = hn::MaxLanes(df);
using VF = hn::Vec<decltype(df)>;
using VI = hn::Vec<decltype(di)>;

// The next number below; -inf stays.
HWY_INLINE VF next_below(VF v) {
  const VI bits = hn::BitCast(di, v), one = hn::Set(di, 1);
  const auto positive = hn::Gt(v, hn::Zero(df));
  const VF lower =
      hn::BitCast(df, hn::IfThenElse(hn::RebindMask(di, positive), hn::Sub(bits, one), hn::Add(bits, one)));
  const VF below_zero = hn::Set(df, -std::numeric_limits<float>::denorm_min());
  const VF next = hn::IfThenElse(hn::Eq(v, hn::Zero(df)), below_zero, lower);
  return hn::IfThenElse(hn::Eq(v, hn::Set(df, -std::numeric_limits<float>::infinity())), v, next);
}

class HorizonScan {
 public:
  HorizonScan(const HorizonGround& ground, const HorizonTable& table, float eye)
      : ground_(ground), table_(table), eye_(eye), pitch_(ground.heights().pitch()), top_(ground.levels() - 1) {}

  void run(const NodeRect& rect, float* slope, std::int32_t* entry, std::ptrdiff_t pitch) {
    const auto groups = static_cast<std::size_t>((rect.col_end - rect.col_begin + static_cast<int>(N) - 1)) / N;
    std::vector<std::int32_t> winners(groups * N, -1);
    for (int row = rect.row_begin; row < rect.row_end; row += kGroupRows) {
      for (std::size_t g = 0; g < groups; ++g) {
        const int col = rect.col_begin + static_cast<int>(g * N);
        look(col, row, &winners[g * N]);
        const auto count = static_cast<std::size_t>(std::min<int>(N, rect.col_end - col));
        for (int r = 0; r < std::min(kGroupRows, rect.row_end - row); ++r) {
          const std::ptrdiff_t at = (row + r - rect.row_begin) * pitch + (col - rect.col_begin);
          put(r, count, slope + at, entry ? entry + at : nullptr);
        }
      }
    }
  }

 private:
  // The horizons of a group. `winners`: those of the group above, and then of this one.
  HWY_INLINE void look(int col, int row, std::int32_t* winners) {
    col_ = col, row_ = row;
    node_ = ground_.heights().height(col, row);
    const VF none = hn::Set(df, -std::numeric_limits<float>::infinity());
    z0_ = hn::Add(hn::LoadU(df, node_), hn::Set(df, eye_));
    z1_ = hn::Add(hn::LoadU(df, node_ + pitch_), hn::Set(df, eye_));
    best0_ = best1_ = none;
    entry0_ = entry1_ = hn::Set(di, -1);
    const int last_col = std::min(col + static_cast<int>(N) - 1, ground_.cols() - 1);
    const int last_row = std::min(row + kGroupRows - 1, ground_.rows() - 1);
    stop_ = table_.reachable(table_.col_sign() > 0 ? ground_.cols() - 1 - col : last_col,
                             table_.row_sign() > 0 ? ground_.rows() - 1 - row : last_row);
    start_warm(winners);
    walk();
    hn::StoreU(entry1_, di, winners);
  }

  void put(int r, std::size_t count, float* slope, std::int32_t* entry) const {
    const VF z = r == 0 ? z0_ : z1_;
    const VF best = hn::IfThenElse(hn::IsNaN(z), z, r == 0 ? best0_ : best1_);
    alignas(64) float slopes[N];
    alignas(64) std::int32_t entries[N];
    hn::Store(best, df, slopes), hn::Store(r == 0 ? entry0_ : entry1_, di, entries);
    std::copy_n(slopes, count, slope);
    if (entry) std::copy_n(entries, count, entry);
  }

  HWY_INLINE void start_warm(const std::int32_t* winners) {
    constexpr std::int32_t kAround = 3, kApart = 4;
    const std::int32_t near = table_.segments(0)[0].end;
    std::int32_t tried[(N + 4) / 5];
    int count = 0;
    for (std::size_t lane = 0; lane < N; lane += 5) {
      const std::int32_t at = winners[lane] + table_.shift();
      if (winners[lane] < 0 || at < near) continue;
      if (std::any_of(tried, tried + count, [at](std::int32_t t) { return std::abs(t - at) < kApart; })) continue;
      tried[count++] = at;
      evaluate<false>(std::max(at - kAround, 0), std::min(at + kAround + 1, stop_));
    }
    if (count > 0) best0_ = next_below(best0_), best1_ = next_below(best1_);
  }

  HWY_INLINE void walk() {
    evaluate<true>(0, std::min(table_.segments(0)[0].end, stop_));
    for (int level = 0; level <= top_; ++level) {
      const auto& segments = table_.segments(level);
      const std::size_t last = level == top_ ? segments.size() : std::min<std::size_t>(8, segments.size());
      for (std::size_t p = level == 0 ? 1 : 2; p < last; ++p) {
        if (segments[p].begin >= stop_) return;
        visit(level, p);
      }
    }
  }

  void visit(int level, std::size_t p) {
    const HorizonTable::Segment& segment = table_.segments(level)[p];
    if (segment.begin == segment.end) return;
    if (!rises_above(level, segment)) return;
    if (level == 0) return evaluate<true>(segment.begin, std::min(segment.end, stop_));
    const auto& parts = table_.segments(level - 1);
    for (std::size_t part = 4 * p; part < std::min(4 * p + 4, parts.size()) && parts[part].begin < stop_; ++part)
      visit(level - 1, part);
  }

  // Whether a crossing of the segment may exceed the current horizon of any node.
  HWY_INLINE bool rises_above(int level, const HorizonTable::Segment& segment) const {
    const int col = col_ + segment.corner_col, row = row_ + segment.corner_row;
    const HorizonGround::Maxima& maxima = ground_.maxima(level);
    VF high0, high1;
    if (level == 0) {
      const float* at = maxima.at(col, row);
      high0 = hn::LoadU(df, at), high1 = hn::LoadU(df, at + maxima.pitch);
    } else if (level == 1) {
      // Windows begin at every fourth column: neighbouring lanes share one.
      const auto lanes = hn::IndicesFromVec(df, hn::ShiftRight<2>(hn::Add(hn::Iota(di, 0), hn::Set(di, col & 3))));
      high0 = hn::TableLookupLanes(hn::LoadU(df, maxima.at(col >> 2, row >> 2)), lanes);
      high1 = hn::TableLookupLanes(hn::LoadU(df, maxima.at(col >> 2, (row + 1) >> 2)), lanes);
    } else {
      high0 = high1 = hn::Set(df, *maxima.at(col >> (2 * level), row >> (2 * level)));
    }
    const VF most = hn::Set(df, segment.most_per_distance), least = hn::Set(df, segment.least_per_distance);
    const VF drop = hn::Set(df, -segment.least_drop);
    const auto rises = [&](VF high, VF z, VF best) HWY_ATTR {
      const VF above = hn::Sub(high, z);
      return hn::Gt(hn::Max(fused(above, most, drop), fused(above, least, drop)), best);
    };
    return !hn::AllFalse(df, hn::Or(rises(high0, z0_, best0_), rises(high1, z1_, best1_)));
  }

  // Tries crossings, nearest first. Without `winners` only the slope is kept.
  template <bool winners>
  HWY_INLINE void evaluate(std::int32_t begin, std::int32_t end) {
    VF best0 = best0_, best1 = best1_;
    VI entry0 = entry0_, entry1 = entry1_;
    const VF z0 = z0_, z1 = z1_;
    const HorizonTable::Entry* entries = table_.entries().data();
    for (std::int32_t i = begin; i < end; ++i) {
      const HorizonTable::Entry& e = entries[i];
      const float *first = node_ + e.first, *second = first + e.second;
      const VF w = hn::Set(df, e.w), per_distance = hn::Set(df, e.per_distance), drop = hn::Set(df, -e.drop);
      const auto slope = [&](VF a, VF b, VF z)
                             HWY_ATTR { return fused(fused(w, hn::Sub(b, a), hn::Sub(a, z)), per_distance, drop); };
      const VF to0 = slope(hn::LoadU(df, first), hn::LoadU(df, second), z0);
      const VF to1 = slope(hn::LoadU(df, first + pitch_), hn::LoadU(df, second + pitch_), z1);
      const auto more0 = hn::Gt(to0, best0), more1 = hn::Gt(to1, best1);
      best0 = hn::IfThenElse(more0, to0, best0), best1 = hn::IfThenElse(more1, to1, best1);
      if constexpr (winners) {
        const VI number = hn::Set(di, i);
        entry0 = hn::IfThenElse(hn::RebindMask(di, more0), number, entry0);
        entry1 = hn::IfThenElse(hn::RebindMask(di, more1), number, entry1);
      }
    }
    best0_ = best0, best1_ = best1;
    if constexpr (winners) entry0_ = entry0, entry1_ = entry1;
  }

  const HorizonGround& ground_;
  const HorizonTable& table_;
  const float eye_;
  const std::ptrdiff_t pitch_;
  const int top_;
  int col_ = 0, row_ = 0;
  std::int32_t stop_ = 0;
  const float* node_ = nullptr;
  VF z0_, z1_, best0_, best1_;
  VI entry0_, entry1_;
};

void scan(const HorizonGround& ground, const HorizonTable& table, float eye, const NodeRect& rect, float* slope,
          std::int32_t* entry, std::ptrdiff_t pitch) {
  HorizonScan(ground, table, eye).run(rect, slope, entry, pitch);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(scan);

}  // namespace

void scan_horizon(const HorizonGround& ground, const HorizonTable& table, float eye, const NodeRect& rect, float* slope,
                  std::int32_t* entry, std::ptrdiff_t pitch) {
  HWY_DYNAMIC_DISPATCH(scan)(ground, table, eye, rect, slope, entry, pitch);
}

}  // namespace scarp
#endif
