// SPDX-License-Identifier: MIT
// Traces coherent rays from one point through the pyramid together, with one list of blocks for all.
//
//   +---+---+   All rays advance along both axes of their frames. In each block they cross first the near
//   | Y | F |   child, then one of the two sides, then the far one, so one order suits all. The times
//   +---+---+   of the lines between children divide each ray's time in its block without gaps, in any
//   | N | X |   rounding. Maxima and samples are loaded once for all rays. Rays leave the
//   +---+---+   list at cells where they are not certainly above the ground.
//
// Source: I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive rendering with coherent ray tracing", Computer
// Graphics Forum 20(3), 2001 (packets of rays). Heights include the margin of Lanes; maxima need none. Compiled once
// per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_TOGETHER_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_TOGETHER_H
#undef SCARP_MARCH_MAX_MIP_SIMD_TOGETHER_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_TOGETHER_H
#endif

#include <algorithm>
#include <bit>

#include "scarp/march/height/max_mip_simd_beam.h"
#include "scarp/march/height/max_mip_simd_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Maximum spread, in cells, of the start cells of rays traced together, and cells up to which floats count exactly.
constexpr std::int32_t kWidestStart = 2, kFarthestCell = 1 << 22;

using MF = hn::Mask<decltype(df)>;

template <class T>
class Together {
 public:
  HWY_INLINE Together(const VectorGround<T>& g, Lanes* lanes, std::size_t count)
      : g_(g), lanes_(lanes), count_(count) {}

  /// Returns the number of rays. Each ray then ends without a hit, or is undecided in a cell and above the ground up to
  /// there.
  HWY_INLINE std::size_t walk() {
    VI x0 = hn::Set(di, kMostCells), y0 = x0;
    std::size_t rays = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const Lanes& a = lanes_[k];
      const VF end = hn::Load(df, a.end);
      const MI walk =
          hn::And(hn::Eq(hn::Load(di, a.status), hn::Zero(di)), hn::RebindMask(di, hn::Lt(hn::Load(df, a.T), end)));
      x0 = hn::IfThenElse(walk, hn::Min(x0, hn::Load(di, a.x)), x0);
      y0 = hn::IfThenElse(walk, hn::Min(y0, hn::Load(di, a.y)), y0);
      Numbers& r = numbers_[k];
      hn::Store(hn::ConvertTo(df, hn::Load(di, a.begin_x)), df, r.begin_x);
      hn::Store(hn::ConvertTo(df, hn::Load(di, a.begin_y)), df, r.begin_y);
      hn::Store(hn::Mul(hn::Load(df, a.ox), hn::Load(df, a.per_x)), df, r.o_per_x);
      hn::Store(hn::Mul(hn::Load(df, a.oy), hn::Load(df, a.per_y)), df, r.o_per_y);
      hn::Store(hn::IfThenElse(hn::RebindMask(df, walk), end, hn::Set(df, kDone)), df, r.end);
      if (hn::AllFalse(di, walk)) continue;
      const auto j = static_cast<std::size_t>(hn::FindFirstTrue(di, walk));
      mirror_x_ = a.mirror_x[j], mirror_y_ = a.mirror_y[j], last_x_ = a.last_x[j], last_y_ = a.last_y[j];
      live_ |= std::uint64_t{1} << k, rays += hn::CountTrue(di, walk);
    }
    if (live_ == 0) return 0;
    first_x_ = hn::GetLane(hn::MinOfLanes(di, x0)), first_y_ = hn::GetLane(hn::MinOfLanes(di, y0));
    descend();
    while (depth_ > 0 && live_ != 0) {
      const Block block = stack_[--depth_];
      const std::uint64_t vectors = block.vectors & live_;
      if (vectors == 0) continue;
      if (block.level > 1) {
        open(block, vectors);
      } else {
        test_cells(block, vectors);
      }
    }
    for (std::size_t k = 0; k < count_; ++k) {
      std::int32_t* status = lanes_[k].status;
      const MI above = hn::RebindMask(di, hn::Ge(hn::Load(df, numbers_[k].end), hn::Zero(df)));
      hn::Store(hn::IfThenElse(above, hn::Set(di, kMiss), hn::Load(di, status)), di, status);
      hn::BlendedStore(hn::Set(di, 1), above, di, lanes_[k].seen);
    }
    return rays;
  }

 private:
  struct Block {
    std::int32_t x, y, level;
    std::uint64_t vectors;
  };
  // State of the rays of a vector; `end` is kDone for rays that are finished.
  struct Numbers {
    alignas(64) float begin_x[N], begin_y[N], o_per_x[N], o_per_y[N], end[N];
  };
  // Descends from the top to the start of the rays, past blocks that are behind all of them.
  HWY_INLINE void descend() {
    Block b{0, 0, g_.top, live_};
    while (b.level > kFirstLevel) {
      const std::int32_t level = b.level - 1, half = 1 << level, x1 = b.x + half, y1 = b.y + half;
      const bool in_x1 = first_x_ >= x1, in_y1 = first_y_ >= y1, has_x1 = x1 <= last_x_, has_y1 = y1 <= last_y_;
      if (!(in_x1 && in_y1) && has_x1 && has_y1) push({x1, y1, level, live_});
      if (!in_x1 && !in_y1) {
        if (has_y1) push({b.x, y1, level, live_});
        if (has_x1) push({x1, b.y, level, live_});
      }
      b = {in_x1 ? x1 : b.x, in_y1 ? y1 : b.y, level, live_};
    }
    push(b);
  }
  HWY_INLINE void push(const Block& b) { stack_[depth_++] = b; }

  // Lines at which a block starts, is divided and ends; never at the end of the field.
  struct Lines {
    float x[3], y[3];
  };
  HWY_INLINE Lines lines(std::int32_t x, std::int32_t y, std::int32_t half) const {
    const auto line = [](std::int32_t at, std::int32_t first, std::int32_t last) {
      return at > last ? 0x1p30f : at <= first ? -0x1p30f : static_cast<float>(at);
    };
    const auto x_line = [&](std::int32_t at) { return line(at, first_x_, last_x_); };
    const auto y_line = [&](std::int32_t at) { return line(at, first_y_, last_y_); };
    return {{x_line(x), x_line(x + half), x_line(x + 2 * half)}, {y_line(y), y_line(y + half), y_line(y + 2 * half)}};
  }
  struct Times {
    VF t[4];
    MF by_x;
    HWY_INLINE auto begins_before(int i) const { return hn::Lt(t[i], t[i + 1]); }
  };
  HWY_INLINE Times times(std::size_t k, const Lines& l) const {
    const Lanes& a = lanes_[k];
    const Numbers& r = numbers_[k];
    const VF bx = hn::Load(df, r.begin_x), by = hn::Load(df, r.begin_y), px = hn::Load(df, a.per_x),
             py = hn::Load(df, a.per_y), ox = hn::Load(df, r.o_per_x), oy = hn::Load(df, r.o_per_y);
    const auto tx = [&](int i) HWY_ATTR { return hn::MulSub(hn::Sub(hn::Set(df, l.x[i]), bx), px, ox); };
    const auto ty = [&](int i) HWY_ATTR { return hn::MulSub(hn::Sub(hn::Set(df, l.y[i]), by), py, oy); };
    const VF in = hn::Max(hn::Load(df, a.T), hn::Max(tx(0), ty(0)));
    const VF out = hn::Min(hn::Load(df, r.end), hn::Min(tx(2), ty(2)));
    const VF mx = tx(1), my = ty(1);
    Times t;
    t.by_x = hn::Lt(mx, my);
    t.t[0] = in;
    t.t[1] = hn::Max(in, hn::Min(out, hn::Min(mx, my)));
    t.t[2] = hn::Max(in, hn::Min(out, hn::Max(mx, my)));
    t.t[3] = hn::Max(in, out);
    return t;
  }

  HWY_NOINLINE void open(const Block& block, std::uint64_t vectors) {
    const std::int32_t level = block.level - 1, half = 1 << level, x1 = block.x + half, y1 = block.y + half;
    const Lines l = lines(block.x, block.y, half);
    const std::int32_t cols = (g_.last_col >> level) + 1, last_row = g_.last_row >> level;
    const std::uint32_t* blocks = g_.blocks + g_.level_begin[level];
    const auto col = [&](std::int32_t x) { return std::min((x ^ mirror_x_) >> level, cols - 1); };
    const auto row = [&](std::int32_t y) { return std::min((y ^ mirror_y_) >> level, last_row) * cols; };
    const std::int32_t c0 = col(block.x), c1 = col(x1 > last_x_ ? block.x : x1);
    const std::int32_t r0 = row(block.y), r1 = row(y1 > last_y_ ? block.y : y1);
    const auto maximum = [&](std::int32_t entry) HWY_ATTR {
      return hn::Set(df, static_cast<float>(blocks[entry] & 0xffff) * g_.maxima_scale + g_.maxima_shift);
    };
    const VF near = maximum(r0 + c0), side_x = maximum(r0 + c1), side_y = maximum(r1 + c0), far = maximum(r1 + c1);
    std::uint64_t at_near = 0, at_x = 0, at_y = 0, at_far = 0;
    for (std::uint64_t rest = vectors; rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      const Times t = times(k, l);
      const VF dz = hn::Load(df, lanes_[k].dz), z = hn::Load(df, lanes_[k].z);
      const auto height = [&](int i) HWY_ATTR { return hn::MulAdd(dz, t.t[i], z); };
      const VF h0 = height(0), h1 = height(1), h2 = height(2), h3 = height(3);
      const auto low0 = hn::AndNot(hn::Gt(hn::Min(h0, h1), near), t.begins_before(0));
      const auto low1 = hn::AndNot(hn::Gt(hn::Min(h1, h2), hn::IfThenElse(t.by_x, side_x, side_y)), t.begins_before(1));
      const auto low2 = hn::AndNot(hn::Gt(hn::Min(h2, h3), far), t.begins_before(2));
      const auto note = [k](std::uint64_t& at, auto low) HWY_ATTR { at |= std::uint64_t{!hn::AllFalse(df, low)} << k; };
      note(at_near, low0), note(at_x, hn::And(low1, t.by_x)), note(at_y, hn::AndNot(t.by_x, low1)), note(at_far, low2);
    }
    if (at_far) push({x1, y1, level, at_far});
    if (at_y) push({block.x, y1, level, at_y});
    if (at_x) push({x1, block.y, level, at_x});
    if (at_near) push({block.x, block.y, level, at_near});
  }

  HWY_NOINLINE void test_cells(const Block& block, std::uint64_t vectors) {
    const Lines l = lines(block.x, block.y, 1);
    const bool back_x = mirror_x_ != 0, back_y = mirror_y_ != 0;
    float h[4][4], highest[4];
    for (std::int32_t i = 0; i < 4; ++i) {
      // Beside the field, where no ray is, any cell will do.
      const std::int32_t col = std::min(std::min(block.x + i % 2, last_x_) ^ mirror_x_, g_.last_col);
      const std::int32_t row = std::min(std::min(block.y + i / 2, last_y_) ^ mirror_y_, g_.last_row);
      const T *north = g_.samples + row * g_.stride + col, *south = north + g_.south(row);
      const std::ptrdiff_t east = g_.east(col);
      const auto code = [&](T v) { return (static_cast<float>(v) - g_.base) * g_.per_step + g_.offset; };
      h[i][0] = code(north[0]), h[i][1] = code(north[east]), h[i][2] = code(south[0]), h[i][3] = code(south[east]);
      highest[i] = std::max(std::max(h[i][0], h[i][1]), std::max(h[i][2], h[i][3]));
    }
    for (std::uint64_t rest = vectors; rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      Lanes& a = lanes_[k];
      Numbers& r = numbers_[k];
      const Times t = times(k, l);
      const VF z = hn::Load(df, a.z), dz = hn::Load(df, a.dz), dx = hn::Load(df, a.dx), dy = hn::Load(df, a.dy);
      VF heights[4];
      for (int i = 0; i < 4; ++i) heights[i] = hn::MulAdd(dz, t.t[i], z);
      const auto test = [&](int i, int part, MF in_cell_i) HWY_ATTR {
        const VF z0 = heights[part], z1 = heights[part + 1], t0 = t.t[part], t1 = t.t[part + 1];
        const MF passes = hn::And(in_cell_i, hn::Lt(t0, hn::Min(t1, hn::Load(df, r.end))));
        const MF low = hn::AndNot(hn::Gt(hn::Min(z0, z1), hn::Set(df, highest[i])), passes);
        if (hn::AllFalse(df, low)) return;
        const std::int32_t x = block.x + i % 2, y = block.y + i / 2;
        const VF to_x =
            hn::Sub(hn::Load(df, a.ox), hn::Sub(hn::Set(df, static_cast<float>(x)), hn::Load(df, r.begin_x)));
        const VF to_y =
            hn::Sub(hn::Load(df, a.oy), hn::Sub(hn::Set(df, static_cast<float>(y)), hn::Load(df, r.begin_y)));
        const auto place = [](bool back, VF d, VF time, VF to) HWY_ATTR {
          const VF at = in_cell(hn::MulAdd(d, time, to));
          return back ? hn::Sub(hn::Set(df, 1), at) : at;
        };
        const CellCodes c{hn::Set(df, h[i][0]), hn::Set(df, h[i][1]), hn::Set(df, h[i][2]), hn::Set(df, h[i][3])};
        const VF u0 = place(back_x, dx, t0, to_x), u1 = place(back_x, dx, t1, to_x);
        const VF v0 = place(back_y, dy, t0, to_y), v1 = place(back_y, dy, t1, to_y);
        const Clearance f = g_.triangles ? triangle_clearance(c, u0, v0, u1, v1, z0, z1)
                                         : bilinear_clearance(c, u0, v0, u1, v1, z0, z1);
        const MF unsure = hn::AndNot(hn::Gt(f.least, hn::Zero(df)), low);
        if (!hn::AllFalse(df, unsure)) stop(k, unsure, x, y, t0);
      };
      const MF all = hn::Eq(z, z);
      test(0, 0, all), test(1, 1, t.by_x), test(2, 1, hn::Not(t.by_x)), test(3, 2, all);
    }
  }
  // Stops rays that may hit in a cell which they enter at `time`; they are above the ground up to there.
  HWY_INLINE void stop(std::size_t k, MF rays, std::int32_t x, std::int32_t y, VF time) {
    Lanes& a = lanes_[k];
    float* end = numbers_[k].end;
    const VF from = hn::Load(df, a.T);
    const MI put = hn::RebindMask(di, rays);
    hn::BlendedStore(hn::Set(di, 1), hn::RebindMask(di, hn::And(rays, hn::Lt(from, time))), di, a.seen);
    hn::BlendedStore(hn::Set(di, x), put, di, a.x), hn::BlendedStore(hn::Set(di, y), put, di, a.y);
    hn::BlendedStore(hn::Set(di, kUnsure), put, di, a.status);
    hn::BlendedStore(time, rays, df, a.T);
    const VF rest = hn::IfThenElse(rays, hn::Set(df, kDone), hn::Load(df, end));
    hn::Store(rest, df, end);
    if (hn::AllFalse(df, hn::Ge(rest, hn::Zero(df)))) live_ &= ~(std::uint64_t{1} << k);
  }

  static constexpr float kDone = -1;
  static constexpr std::int32_t kFirstLevel = 3;  // where tests begin
  static constexpr std::size_t kMostVectors = std::max<std::size_t>(1, 64 / N);
  const VectorGround<T>& g_;
  Lanes* lanes_;
  std::size_t count_;
  Numbers numbers_[kMostVectors];
  std::uint64_t live_ = 0;  // vectors with rays that take part
  std::int32_t mirror_x_ = 0, mirror_y_ = 0, last_x_ = 0, last_y_ = 0;
  std::int32_t first_x_ = 0, first_y_ = 0;  // nearest cell in which a ray starts
  Block stack_[4 * 32];
  std::size_t depth_ = 0;
};

// Traces the rays of `lanes` if they start close together and run in the same direction along x and along y. Returns
// their number, or 0.
template <class T>
HWY_NOINLINE std::size_t walk_together(const VectorGround<T>& g, Lanes* lanes, std::size_t count) {
  if (std::max(g.last_col, g.last_row) > kFarthestCell) return 0;
  const Beam beam(lanes, count);
  if (!beam.goes_one_way() || beam.at(0).width() > kWidestStart) return 0;
  return Together<T>(g, lanes, count).walk();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
