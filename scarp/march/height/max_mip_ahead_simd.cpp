// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip_ahead.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "scarp/march/height/cell_surface.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/rounding.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/height/max_mip_ahead_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/march/height/max_mip_simd_lanes.h"
#include "scarp/march/height/max_mip_simd_rays.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

using max_mip::Ahead;

// Narrower vectors are no faster than the scalar traversal.
#if HWY_CAP_GE256
constexpr bool kWide = true;

constexpr hn::CappedTag<float, 4> df4;
constexpr hn::RebindToSigned<decltype(df4)> di4;
using VF4 = hn::Vec<decltype(df4)>;
using MF = hn::Mask<decltype(df)>;

constexpr std::size_t kRows = N / 4;                 // rows of children in one vector
constexpr int kParts = 4 / static_cast<int>(kRows);  // vectors per 16 children

HWY_INLINE std::uint32_t lane_bits(MF mask) { return static_cast<std::uint32_t>(bits_of(hn::RebindMask(di, mask))); }

template <class T>
class AheadWalk {
 public:
  AheadWalk(const HeightTarget& target, const SampleGrid<T>& grid)
      : target_(target), field_(*target.field), pyramid_(*target.pyramid), grid_(grid) {}

  // Prepares the ray. Returns false if `answer` is final.
  HWY_INLINE bool prepare(const Ray& ray, Ahead& answer) {
    const HeightCode& code = pyramid_.code();
    // An even number of bits, because levels advance by two: mirroring then reverses whole groups of four children.
    const int bits = std::bit_width(static_cast<unsigned>(std::max(grid_.cell_cols, grid_.cell_rows) - 1));
    root_ = std::max(2, bits + (bits & 1));
    const FieldFrame frame = field_frame(target_, code, root_, std::min(kFirstOutside, root_));
    local_ = field_.grid_from_world(ray);
    const dvec3 &o = local_.origin, &d = local_.direction;
    GridRays rays;
    rays.ox[0] = o.x, rays.oy[0] = o.y, rays.oz[0] = o.z, rays.dx[0] = d.x, rays.dy[0] = d.y, rays.dz[0] = d.z;
    rays.t_min[0] = ray.t_min, rays.t_max[0] = ray.t_max;
    prepare_part(hn::CappedTag<double, 1>(), frame, rays, 0, a_);
    if (a_.status[0] == kMiss) answer = Ahead::miss;
    if (a_.status[0] != kWalking) return false;
    seen_ = a_.seen[0] != 0;
    start_x_ = -a_.ox[0] * a_.per_x[0], start_y_ = -a_.oy[0] * a_.per_y[0];
    base_ = static_cast<float>(code.base), per_step_ = static_cast<float>(code.per_step);
    offset_ = static_cast<float>((static_cast<double>(base_) - code.base) * code.per_step);
    cell_relief_ = frame.cell_relief;
    margin_per_cell_ = static_cast<float>(4 * kSideways * cell_relief_ * code.per_step);
    t_begin_ = a_.t_begin[0], t_per_cell_ = a_.t_per_cell[0], t_max_ = ray.t_max;
    return true;
  }

  // Follows the ray. Sets `t_clear` if the answer is open.
  HWY_INLINE Ahead run(double& t_clear) {
    std::uint32_t rest[kMostLevels], ahead = ~0u;
    int level = std::max(2, a_.level[0]), known = level;
    std::int32_t nx = a_.x[0] >> level, ny = a_.y[0] >> level;
    const Fixed fixed(a_, start_x_, start_y_);
    Ahead answer = Ahead::open;
    doubt_ = kNever;
    for (bool ends = false;;) {
      std::uint32_t waiting = 0;
      if (level > 2) {
        waiting = blocks(fixed, level, nx, ny) & ahead;
      } else if (cells(fixed, nx, ny, answer)) {
        return answer;
      }
      bool up = false;
      while (waiting == 0) {
        ends = level >= root_ || leaves_at_end(level, nx, ny);
        if (ends) break;
        const int child = (nx & 3) | (ny & 3) << 2;
        level += 2, nx >>= 2, ny >>= 2;
        up = level > known;
        if (up) {
          known = level, ahead = ~1u << child;
          break;
        }
        waiting = rest[level / 2];
      }
      if (ends) break;
      if (up) continue;
      const int child = std::countr_zero(waiting);
      rest[level / 2] = waiting & (waiting - 1);
      level -= 2, nx = 4 * nx + (child & 3), ny = 4 * ny + (child >> 2);
      ahead = ~0u;
    }
    if (doubt_ == kNever) return Ahead::miss;
    t_clear = time(doubt_);
    return Ahead::open;
  }

 private:
  static constexpr int kMostLevels = 16;
  static constexpr int kFirstOutside = 6;  // level of the first block of rays that start above or outside

  // The ray in all lanes, and the positions of the lanes' children in their block.
  struct Fixed {
    VF ox, oy, per_x, per_y, start_x, start_y, z, dz, end, last_x, last_y;
    VI lane_x, lane_y;
    decltype(hn::SetTableIndices(df, static_cast<const std::int32_t*>(nullptr))) along_x;
    HWY_INLINE Fixed(const Lanes& r, float from_x, float from_y)
        : ox(hn::Set(df, r.ox[0])),
          oy(hn::Set(df, r.oy[0])),
          per_x(hn::Set(df, r.per_x[0])),
          per_y(hn::Set(df, r.per_y[0])),
          start_x(hn::Set(df, from_x)),
          start_y(hn::Set(df, from_y)),
          z(hn::Set(df, r.z[0])),
          dz(hn::Set(df, r.dz[0])),
          end(hn::Set(df, r.end[0])),
          last_x(hn::Set(df, static_cast<float>(r.last_x[0] - r.x[0]))),
          last_y(hn::Set(df, static_cast<float>(r.last_y[0] - r.y[0]))) {
      const VI lanes = hn::Iota(di, 0);
      lane_x = hn::And(lanes, hn::Set(di, 3)), lane_y = hn::ShiftRight<2>(lanes);
      along_x = hn::IndicesFromVec(df, hn::Xor(lanes, hn::Set(di, r.mirror_x[0] & 3)));
    }
    HWY_INLINE VF height(VF t) const { return hn::MulAdd(dz, t, z); }
  };

  // The ray's path through the children of a vector.
  struct Ways {
    VF x, y;  // the near grid lines of the children, relative to the ray's start
    VF in, out, low;
    MF crossed;
  };
  HWY_INLINE Ways ways(const Fixed& f, int child_level, std::int32_t nx, std::int32_t ny, int part) const {
    const std::int32_t cells = 1 << child_level, row = 4 * ny + part * static_cast<std::int32_t>(kRows);
    const VF size = hn::Set(df, static_cast<float>(cells)), never = hn::Set(df, kNever), zero = hn::Zero(df);
    const auto lines = [&](VI lane, std::int32_t first) HWY_ATTR {
      return hn::ConvertTo(df, hn::Add(hn::ShiftLeftSame(lane, child_level), hn::Set(di, first)));
    };
    Ways w;
    w.x = lines(f.lane_x, 4 * nx * cells - a_.x[0]), w.y = lines(f.lane_y, row * cells - a_.y[0]);
    // One time for each line, in all blocks. The ray leaves the field at its end time, not through a line.
    const auto times = [&](VF line, VF last, VF start, VF per)
                           HWY_ATTR { return hn::IfThenElse(hn::Gt(line, last), never, hn::MulAdd(line, per, start)); };
    const VF in_x = times(w.x, f.last_x, f.start_x, f.per_x), in_y = times(w.y, f.last_y, f.start_y, f.per_y);
    const VF out_x = times(hn::Add(w.x, size), f.last_x, f.start_x, f.per_x);
    const VF out_y = times(hn::Add(w.y, size), f.last_y, f.start_y, f.per_y);
    const VF line = hn::Min(out_x, out_y);
    w.in = hn::Max(hn::Max(in_x, in_y), zero), w.out = hn::Min(line, f.end);
    w.crossed = hn::And(hn::Le(w.in, w.out), hn::Gt(line, zero));
    w.low = hn::Min(f.height(w.in), f.height(w.out));
    return w;
  }

  // Whether the ray ends within a block; children beyond it are crossed later, according to the same times.
  HWY_INLINE bool leaves_at_end(int level, std::int32_t nx, std::int32_t ny) const {
    const std::int32_t x = (nx + 1) << level, y = (ny + 1) << level;
    const float tx = x > a_.last_x[0] ? kNever : std::fma(static_cast<float>(x - a_.x[0]), a_.per_x[0], start_x_);
    const float ty = y > a_.last_y[0] ? kNever : std::fma(static_cast<float>(y - a_.y[0]), a_.per_y[0], start_y_);
    return std::min(tx, ty) > a_.end[0];
  }

  // Four entries of each row.
  HWY_INLINE static VF join(const VF4* rows) {
#if HWY_CAP_GE512
    constexpr hn::CappedTag<float, 8> df8;
    return hn::Combine(df, hn::Combine(df8, rows[3], rows[2]), hn::Combine(df8, rows[1], rows[0]));
#else
    return hn::Combine(df, rows[1], rows[0]);
#endif
  }

  static HWY_INLINE VF4 four(const float* from) { return hn::LoadU(df4, from); }
  template <class Whole>
  static HWY_INLINE VF4 four(const Whole* from) {
    constexpr hn::Rebind<Whole, decltype(df4)> four_whole;
    return hn::ConvertTo(df4, hn::PromoteTo(di4, hn::LoadU(four_whole, from)));
  }

  // Children of a block in which the ray may hit the ground, as bits.
  HWY_INLINE std::uint32_t blocks(const Fixed& f, int level, std::int32_t nx, std::int32_t ny) const {
    const int child = level - 2;
    const MaxPyramid::Level& at = pyramid_.levels()[static_cast<std::size_t>(child - 1)];
    const std::int32_t mirror_x = a_.mirror_x[0] >> child, mirror_y = a_.mirror_y[0] >> child;
    const std::uint32_t* in_rows = pyramid_.blocks() + at.begin + ((4 * nx ^ mirror_x) & ~3);
    std::uint32_t bits = 0;
    for (int part = 0; part < kParts; ++part) {
      const Ways w = ways(f, child, nx, ny, part);
      VF4 rows[kRows];
      for (std::size_t j = 0; j < kRows; ++j) {
        const std::int32_t row = 4 * ny + part * static_cast<std::int32_t>(kRows) + static_cast<std::int32_t>(j);
        const std::uint32_t* from = in_rows + std::ptrdiff_t{std::min(row ^ mirror_y, at.rows - 1)} * at.cols;
        const auto block = hn::LoadU(di4, reinterpret_cast<const std::int32_t*>(from));
        rows[j] = hn::ConvertTo(df4, hn::And(block, hn::Set(di4, 0xffff)));
      }
      const VF highest = hn::TableLookupLanes(join(rows), f.along_x);
      bits |= lane_bits(hn::AndNot(hn::Gt(w.low, highest), w.crossed)) << (part * static_cast<int>(N));
    }
    return bits;
  }

  // The cells of a block of level 2. Returns true if `answer` is known.
  HWY_NOINLINE bool cells(const Fixed& f, std::int32_t nx, std::int32_t ny, Ahead& answer) {
    const std::int32_t col = (4 * nx ^ a_.mirror_x[0]) & ~3, first_row = (4 * ny ^ a_.mirror_y[0]) & ~3;
    const T* data = grid_.data + first_row * grid_.row_stride + col;
    std::ptrdiff_t stride = grid_.row_stride;
    T copy[5 * 8];
    if (col + 4 >= grid_.cols || first_row + 4 >= grid_.rows) [[unlikely]] {
      for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i)
          copy[8 * j + i] = grid_.at(std::min(col + i, grid_.cols - 1), std::min(first_row + j, grid_.rows - 1));
      }
      data = copy, stride = 8;
    }
    for (int part = 0; part < kParts; ++part) {
      const Ways w = ways(f, 0, nx, ny, part);
      if (lane_bits(w.crossed) == 0) continue;
      VF4 nw[kRows], ne[kRows], sw[kRows], se[kRows];
      for (std::size_t j = 0; j < kRows; ++j) {
        const int along = part * static_cast<int>(kRows) + static_cast<int>(j),
                  row = a_.mirror_y[0] ? 3 - along : along;
        const T *north = data + row * stride, *south = north + stride;
        nw[j] = four(north), ne[j] = four(north + 1), sw[j] = four(south), se[j] = four(south + 1);
      }
      const VF samples_nw = join(nw), samples_ne = join(ne), samples_sw = join(sw), samples_se = join(se);
      const auto in_codes = [&](VF heights) HWY_ATTR {
        const VF above_base = hn::Sub(hn::TableLookupLanes(heights, f.along_x), hn::Set(df, base_));
        return hn::MulAdd(above_base, hn::Set(df, per_step_), hn::Set(df, offset_));
      };
      const VF highest = in_codes(hn::Max(hn::Max(samples_nw, samples_ne), hn::Max(samples_sw, samples_se)));
      const MF near = hn::AndNot(hn::Gt(w.low, highest), w.crossed);
      if (lane_bits(near) == 0) continue;
      const CellCodes h{in_codes(samples_nw), in_codes(samples_ne), in_codes(samples_sw), in_codes(samples_se)};
      const VF one = hn::Set(df, 1), zero = hn::Zero(df);
      const VF dx = hn::Set(df, a_.dx[0]), dy = hn::Set(df, a_.dy[0]);
      const auto place = [&](VF o, VF d, VF t, VF line, std::int32_t mirror) HWY_ATTR {
        const VF along = in_cell(hn::MulAdd(d, t, hn::Sub(o, line)));
        return mirror ? hn::Sub(one, along) : along;
      };
      const VF u0 = place(f.ox, dx, w.in, w.x, a_.mirror_x[0]), u1 = place(f.ox, dx, w.out, w.x, a_.mirror_x[0]);
      const VF v0 = place(f.oy, dy, w.in, w.y, a_.mirror_y[0]), v1 = place(f.oy, dy, w.out, w.y, a_.mirror_y[0]);
      const VF z0 = f.height(w.in), z1 = f.height(w.out);
      const Clearance c = field_.settings().surface == Surface::triangles
                              ? triangle_clearance(h, u0, v0, u1, v1, z0, z1)
                              : bilinear_clearance(h, u0, v0, u1, v1, z0, z1);
      std::uint32_t open = lane_bits(hn::AndNot(hn::Gt(c.least, zero), near));
      if (open == 0) continue;
      // Without holes a ray that was above the ground and is below it has passed through the surface.
      alignas(64) float in[N], out[N];
      hn::Store(w.in, df, in), hn::Store(w.out, df, out);
      const std::uint32_t above = lane_bits(hn::Gt(c.in, zero));
      seen_ = seen_ || in[std::countr_zero(open)] > 0 || (above & open & -open) != 0;
      const VF margin = hn::MulAdd(hn::Set(df, margin_per_cell_), w.out, hn::Set(df, a_.margin[0]));
      const VF least_end = hn::MulSub(f.end, hn::Set(df, 1 - 0x1p-20f), hn::Set(df, static_cast<float>(4 * kSideways)));
      const MF below = hn::And(hn::Lt(hn::Add(c.out, margin), zero), hn::Lt(w.out, least_end));
      if (seen_ && (lane_bits(below) & open) != 0) {
        answer = Ahead::hit;
        return true;
      }
      for (; open != 0; open &= open - 1) {
        const int lane = std::countr_zero(open);
        const int along_x = lane & 3, along_y = part * static_cast<int>(kRows) + lane / 4;
        const Cell cell{(4 * nx + along_x) ^ a_.mirror_x[0], (4 * ny + along_y) ^ a_.mirror_y[0]};
        switch (in_doubles(cell, in[lane], out[lane])) {
          case Found::clear:
            seen_ = true;
            break;
          case Found::hit:
            answer = Ahead::hit;
            return true;
          case Found::doubt:
            if (!seen_) return true;
            doubt_ = std::min(doubt_, in[lane]);
        }
      }
    }
    return false;
  }

  enum class Found { clear, hit, doubt };

  // A cell that floats do not decide, between two times.
  HWY_NOINLINE Found in_doubles(const Cell& cell, float in, float out) const {
    if (field_.settings().surface == Surface::triangles) return Found::doubt;
    const CellHeights h = grid_.cell(cell.col, cell.row);
    const dvec3 &o = local_.origin, &d = local_.direction;
    const double col = cell.col, row = cell.row;
    const auto height = [&](double t) { return o.z + d.z * t; };
    const double t_far = std::max(std::abs(t_begin_), std::abs(time(a_.end[0])));
    const double rounding = 4 * rounding_of_clearance(field_, local_, t_far);
    {
      // The ray is within kSideways * (T + 2) cells of this one, and so is the parabola that belongs to it.
      const double t0 = time(in), length = time(out) - t0;
      const CellQuadratic f(h, o.x + d.x * t0 - col, o.y + d.y * t0 - row, d.x, d.y, height(t0), d.z);
      const bool between = f.a > 0 && f.b < 0 && -f.b < 2 * f.a * length;
      const double ends = std::min(f.c, f.at(length)), least = between ? std::min(ends, f.vertex_value()) : ends;
      if (least > rounding + 4 * kSideways * (static_cast<double>(out) + 2) * cell_relief_) return Found::clear;
    }
    // Whether it is above where it enters the cell and later below by more than rounding, so that the scalar traversal
    // also finds the hit. The scalar traversal tests the whole cell if the ray leaves it before its end.
    if (!(std::abs(d.x) > 0x1p-1000 && std::abs(d.y) > 0x1p-1000)) return Found::doubt;
    const double per_x = 1 / d.x, per_y = 1 / d.y;
    const auto line_x = [&](double line) { return (line - o.x) * per_x; };
    const auto line_y = [&](double line) { return (line - o.y) * per_y; };
    const bool back_x = d.x < 0, back_y = d.y < 0;
    const double tx = line_x(back_x ? col : col + 1), ty = line_y(back_y ? row : row + 1);
    const double exit_x = line_x(back_x ? 0 : grid_.cell_cols), exit_y = line_y(back_y ? 0 : grid_.cell_rows);
    const double t_in = std::max({t_begin_, line_x(back_x ? col + 1 : col), line_y(back_y ? row + 1 : row)});
    const double t_line = std::min(tx, ty), length = t_line - t_in;
    if (!(t_in < t_line && t_line <= std::min({t_max_, exit_x, exit_y}))) return Found::doubt;
    const auto inside = [](double place) { return std::clamp(place, 0.0, 1.0); };
    const CellQuadratic f(h, inside(o.x + d.x * t_in - col), inside(o.y + d.y * t_in - row), d.x, d.y, height(t_in),
                          d.z);
    const bool between = f.a > 0 && f.b < 0 && -f.b < 2 * f.a * length;
    const double least = between ? f.vertex_value() : f.at(length);
    return f.c > rounding && least < -rounding ? Found::hit : Found::doubt;
  }

  HWY_INLINE double time(float cells) const { return t_begin_ + static_cast<double>(cells) * t_per_cell_; }

  const HeightTarget& target_;
  const HeightField& field_;
  const MaxPyramid& pyramid_;
  const SampleGrid<T>& grid_;
  Lanes a_;  // the ray is in lane 0
  GridRay local_;
  double t_begin_, t_per_cell_, t_max_, cell_relief_;
  bool seen_;
  float start_x_, start_y_;  // times of lines 0
  float margin_per_cell_, base_, per_step_, offset_;
  float doubt_;
  int root_;
};

Ahead look(const HeightTarget& target, const Ray& ray, double& t_clear) {
  Ahead answer = Ahead::open;
  t_clear = max_mip::kNotClear;
  target.field->visit([&](const auto& grid) HWY_ATTR {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    AheadWalk<T> walk(target, grid);
    if (walk.prepare(ray, answer)) answer = walk.run(t_clear);
  });
  return answer;
}
#else
constexpr bool kWide = false;

Ahead look(const HeightTarget&, const Ray&, double&) { return Ahead::open; }
#endif

bool is_wide() { return kWide; }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(look);
HWY_EXPORT(is_wide);

}  // namespace

bool max_mip::looks_ahead(const HeightTarget& target) {
  const HeightField& field = *target.field;
  if (!field.has_cells() || field.nodata_count() > 0 || field.wraps()) return false;
  if (std::max(field.cols(), field.rows()) > 1 << 22) return false;
  const HeightCode& code = target.pyramid->code();
  return code.per_step > 0x1p-100 && code.per_step < 0x1p100 && std::abs(code.base) < 0x1p100 &&
         HWY_DYNAMIC_DISPATCH(is_wide)();
}

max_mip::Ahead max_mip::look_ahead(const HeightTarget& target, const Ray& ray, double& t_clear) {
  return HWY_DYNAMIC_DISPATCH(look)(target, ray, t_clear);
}

}  // namespace scarp
#endif
