// SPDX-License-Identifier: MIT
// Prepares rays for the lanes of max_mip_simd.cpp, in double. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_RAYS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#undef SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/height/max_mip_simd_lanes.h"
#include "scarp/march/ray_numbers_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Maximum distance in cells to the origin of a ray over wrapped ground, and to the last copy that vector code
// traverses. Horizontally, |origin| + |path| along x and y is then at most eight times that plus twice the sides of a
// copy, also in the frames of copies.
constexpr double kFarthestCopy = 0x1p17;

// A ray that has to cross a copy of a wrapped ground.
struct CopyRay {
  std::size_t ray;
  std::int32_t x, y;
  bool seen;  // above the ground so far
};

// The field as needed for the preparation; heights in sample units.
struct FieldFrame {
  double cols, rows, sample_rows, highest, base, per_step;
  double relief, cell_relief;  // of all samples, of a cell
  double upright;              // see rounding_of_clearance()
  double mask;                 // of mirrored cells: column c is column mask - c
  double from_outside;         // start level of rays from above or outside
  double seam;                 // HeightTarget::seam
  HeightField::GridScales scales;
  double last_row;      // of samples
  double width, depth;  // metres up to which positions count as inside; unlimited if the ground is wrapped
};

// `code`: the heights that vector code computes with. `bits`: the width of a mirrored cell's number.
HWY_INLINE FieldFrame field_frame(const HeightTarget& target, const HeightCode& code, int bits, int from_outside) {
  const HeightField& field = *target.field;
  const MaxPyramid& pyramid = *target.pyramid;
  const double low = field.min_sample(), high = field.max_sample(), relief = high - low;
  const double cols = field.cell_cols(), rows = field.cell_rows();
  const HeightFieldSettings& settings = field.settings();
  return {.cols = cols,
          .rows = rows,
          .sample_rows = field.rows() + (field.wraps() ? 8 * kFarthestCopy + 2 * (cols + rows) : 0),
          .highest = high,
          .base = code.base,
          .per_step = code.per_step,
          .relief = relief,
          .cell_relief = std::min(relief, pyramid.cell_relief() * pyramid.code().step),
          .upright = std::max(std::abs(low), std::abs(high)) + std::abs(settings.offset) / settings.scale,
          .mask = std::ldexp(1.0, bits) - 1,
          .from_outside = static_cast<double>(from_outside),
          .seam = target.seam,
          .scales = field.grid_scales(),
          .last_row = static_cast<double>(field.rows() - 1),
          .width = field.wraps() ? -kNever : field.width(),
          .depth = field.wraps() ? -kNever : field.depth()};
}

// Rays in grid units, one per lane.
struct GridRays {
  alignas(64) double ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N];
  std::int32_t seen[N];

  // ray(0) to ray(N - 1), by the operations of HeightField::grid_from_world().
  template <class RayAt>
  HWY_INLINE void load(const FieldFrame& f, const RayAt& ray) {
    load_ray_numbers(ray, N, {ox, oy, oz, dx, dy, dz, t_min, t_max});
    const HeightField::GridScales& s = f.scales;
    const VD zero = hn::Zero(dd), cols = hn::Set(dd, f.cols);
    for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) {
      const auto turn = [part](double* numbers, auto by)
                            HWY_ATTR { hn::Store(by(hn::Load(dd, numbers + part)), dd, numbers + part); };
      const auto scale = [&](double* numbers, double per)
                             HWY_ATTR { turn(numbers, [per](VD v) HWY_ATTR { return hn::Mul(v, hn::Set(dd, per)); }); };
      turn(ox, [&](VD x) HWY_ATTR {
        const VD col = hn::Mul(x, hn::Set(dd, s.per_cell_x));
        return hn::IfThenElse(hn::And(hn::Le(x, hn::Set(dd, f.width)), hn::Lt(cols, col)), cols, col);
      });
      turn(oy, [&](VD y) HWY_ATTR {
        const VD row = hn::Sub(hn::Set(dd, f.last_row), hn::Mul(y, hn::Set(dd, s.per_cell_y)));
        return hn::IfThenElse(hn::And(hn::Le(y, hn::Set(dd, f.depth)), hn::Lt(row, zero)), zero, row);
      });
      turn(oz, [&](VD z) HWY_ATTR { return hn::Mul(hn::Sub(z, hn::Set(dd, s.z_offset)), hn::Set(dd, s.per_scale)); });
      scale(dx, s.per_cell_x), scale(dy, -s.per_cell_y), scale(dz, s.per_scale);
    }
  }
};

// Four times rounding_of_clearance() of a ray up to time t.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V rounding(D tag, const FieldFrame& f, V ox, V oy, V oz, V dx, V dy, V dz, V t) {
  const V upright = hn::Add(hn::Set(tag, f.upright), hn::Add(hn::Abs(oz), hn::Abs(hn::Mul(dz, t))));
  const V sideways =
      hn::Add(hn::Add(hn::Abs(ox), hn::Abs(hn::Mul(dx, t))), hn::Add(hn::Abs(oy), hn::Abs(hn::Mul(dy, t))));
  const V wide = hn::Mul(hn::Add(sideways, hn::Set(tag, f.sample_rows)), hn::Set(tag, f.relief));
  return hn::Mul(hn::Set(tag, kRoundings * kUnit), hn::Add(upright, wide));
}

// One axis of rays: mirrored so that they advance, and the times within the field.
template <class D>
struct AxisSpan {
  hn::Vec<D> origin, direction, per, enter, exit;
  hn::Vec<D> slack;  // how long the ray is beside the border, within its allowance: longer for slower crossings
  hn::Mask<D> back;
  hn::Mask<D> beside;  // runs along the border, outside
};
// rounding_of_line() of rounding.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V rounding_of_line(D tag, V o, V cells, double seam) {
  return hn::Add(hn::Set(tag, seam), hn::Mul(hn::Set(tag, 16 * kUnit), hn::Add(cells, hn::Abs(o))));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AxisSpan<D> axis_span(D tag, V o, V d, V cells, double seam) {
  const V zero = hn::Zero(tag), far = hn::Set(tag, std::numeric_limits<double>::infinity());
  AxisSpan<D> s;
  s.back = hn::Lt(d, zero);
  s.origin = hn::IfThenElse(s.back, hn::Sub(cells, o), o);
  s.direction = hn::Abs(d);
  s.per = hn::Div(hn::Set(tag, 1), s.direction);
  // A ray that does not move along the axis is always or never within the field.
  const auto still = hn::Eq(d, zero), within = hn::And(hn::Ge(o, zero), hn::Le(o, cells));
  const V off = hn::Max(hn::Neg(o), hn::Sub(o, cells));
  const V line = rounding_of_line(tag, o, cells, 0);
  s.beside = hn::And(still, hn::AndNot(within, hn::Le(off, hn::Add(hn::Set(tag, seam), line))));
  s.enter = hn::IfThenElse(still, hn::IfThenElse(within, hn::Neg(far), far), hn::Mul(hn::Neg(s.origin), s.per));
  s.exit = hn::IfThenElse(still, far, hn::Mul(hn::Sub(cells, s.origin), s.per));
  s.slack = hn::Mul(line, s.per);
  s.slack = hn::IfThenElse(still, hn::Zero(tag), s.slack);
  return s;
}

// Fills lanes from `part` on with as many rays as the vectors of `tag` hold: clips them to the field and to its highest
// sample, and finds the first cell. Rays that vector code cannot follow become kAlone.
template <class D>
HWY_INLINE void prepare_part(D tag, const FieldFrame& f, const GridRays& r, std::size_t part, Lanes& a) {
  using V = hn::Vec<D>;
  constexpr hn::Rebind<float, D> float_tag;
  constexpr hn::Rebind<std::int32_t, D> whole_tag;
  const V zero = hn::Zero(tag), one = hn::Set(tag, 1), cols = hn::Set(tag, f.cols), rows = hn::Set(tag, f.rows);
  const V ox = hn::Load(tag, r.ox + part), oy = hn::Load(tag, r.oy + part), oz = hn::Load(tag, r.oz + part);
  const V dx = hn::Load(tag, r.dx + part), dy = hn::Load(tag, r.dy + part), dz = hn::Load(tag, r.dz + part);
  const V t_min = hn::Load(tag, r.t_min + part), t_max = hn::Load(tag, r.t_max + part);
  const AxisSpan<D> x = axis_span(tag, ox, dx, cols, f.seam), y = axis_span(tag, oy, dy, rows, f.seam);
  const V longest = hn::Max(x.direction, y.direction), per_longest = hn::Min(x.per, y.per);
  const V t_border = hn::Max(t_min, hn::Max(x.enter, y.enter));
  const V t_exit = hn::Min(t_max, hn::Min(x.exit, y.exit));
  // A falling ray starts where it may be below the highest sample; a rising ray ends where it is above it.
  const V highest = hn::Set(tag, f.highest);
  const auto height = [&](V t) HWY_ATTR { return hn::Add(oz, hn::Mul(dz, t)); };
  const auto falls = hn::Lt(dz, zero), from_above = hn::Gt(height(t_border), highest);
  const V t_far = hn::Max(hn::Abs(t_border), hn::Abs(t_exit));
  const V doubt = rounding(tag, f, ox, oy, oz, dx, dy, dz, t_far), over = hn::Add(highest, doubt);
  const V quotient = hn::Div(hn::Sub(over, oz), dz);
  const V t_top = hn::Sub(quotient, hn::Mul(hn::Set(tag, 4 * kUnit), hn::Abs(quotient)));
  const V t_begin = hn::IfThenElse(hn::And(from_above, falls), hn::Max(t_border, t_top), t_border);
  const V t_over = hn::Div(hn::Sub(over, oz), dz);
  const V t_end = hn::IfThenElse(hn::Gt(dz, zero), hn::Min(t_exit, t_over), t_exit);
  // Usual lengths, and slopes of less than 2^30 codes per cell: far from float overflow.
  const V per_step = hn::Set(tag, f.per_step), slope = hn::Mul(hn::Mul(dz, per_step), per_longest);
  const auto usual =
      hn::And(hn::And(hn::Gt(longest, hn::Set(tag, 0x1p-300)), hn::Lt(longest, hn::Set(tag, 0x1p300))),
              hn::And(hn::Lt(hn::Abs(slope), hn::Set(tag, 0x1p30)), hn::Lt(t_far, hn::Set(tag, 0x1p300))));
  // Rays with NaN are left to the scalar traversal: vector minima and maxima may drop NaN. The slack is a sum, so NaN
  // along either axis makes it NaN. The borders are accurate to less than a position's rounding, and a sixteenth of a
  // code. A seam widens the borders that the ray crosses.
  const V per_enter = hn::IfThenElse(hn::Ge(x.enter, y.enter), x.per, y.per);
  const V per_exit = hn::IfThenElse(hn::Le(x.exit, y.exit), x.per, y.per);
  const V at_seam = hn::Mul(hn::Set(tag, f.seam), hn::Max(per_enter, per_exit));
  const V slack = hn::Add(hn::Add(x.slack, y.slack), at_seam), slack_cells = hn::Mul(slack, longest);
  const auto range = hn::And(hn::Le(t_min, t_max), hn::Gt(t_min, hn::Set(tag, -HUGE_VAL)));
  const auto numbers = hn::And(hn::Eq(oz, oz), range);
  const auto clear_of_borders = hn::AndNot(hn::Or(x.beside, y.beside), hn::And(usual, numbers));
  const auto sound =
      hn::And(clear_of_borders, hn::And(hn::Lt(slack_cells, hn::Set(tag, kSideways)),
                                        hn::Lt(hn::Mul(slack_cells, hn::Abs(slope)), hn::Set(tag, 0x1p-4))));
  const auto climbs_from_above = hn::AndNot(falls, from_above);
  const auto followed = hn::And(sound, hn::AndNot(climbs_from_above, hn::Lt(t_begin, t_end)));
  // Beside the field, or above all ground from start to end.
  const V tie = hn::Mul(hn::Set(tag, 0x1p-40), hn::Add(hn::Abs(t_border), hn::Abs(t_exit)));
  const auto beside = hn::Gt(hn::Sub(t_border, t_exit), hn::Add(tie, hn::Add(slack, slack)));
  // Up to the slack before and behind the field, too, where it may touch the rim.
  const auto stays_above = hn::And(hn::And(hn::Gt(height(hn::Sub(t_border, slack)), over), hn::Lt(t_border, t_exit)),
                                   hn::Or(hn::Not(falls), hn::Gt(height(hn::Add(t_exit, slack)), over)));
  const auto misses = hn::And(sound, hn::Or(beside, stays_above));
  const V at_x = hn::Add(x.origin, hn::Mul(x.direction, t_begin)),
          at_y = hn::Add(y.origin, hn::Mul(y.direction, t_begin));
  const auto cell = [&](V at, V cells) HWY_ATTR {
    return hn::IfThenElseZero(followed, hn::Min(hn::Max(hn::Floor(at), zero), hn::Sub(cells, one)));
  };
  const V cell_x = cell(at_x, cols), cell_y = cell(at_y, rows);
  const auto put = [&](V v, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(float_tag, v), float_tag, to + part); };
  put(hn::Min(hn::Max(hn::Sub(at_x, cell_x), zero), one), a.ox);
  put(hn::Min(hn::Max(hn::Sub(at_y, cell_y), zero), one), a.oy);
  put(hn::Mul(x.direction, per_longest), a.dx), put(hn::Mul(y.direction, per_longest), a.dy);
  const V most = hn::Set(tag, 0x1p60);
  put(hn::Min(hn::Mul(longest, x.per), most), a.per_x), put(hn::Min(hn::Mul(longest, y.per), most), a.per_y);
  // Positions are accurate to kSideways (T + 2) along either axis.
  const double sideways = 2 * kSideways * f.cell_relief * f.per_step;
  const V margin = hn::Add(hn::Set(tag, kUpright + 2 * sideways), hn::Mul(doubt, per_step));
  put(hn::Sub(hn::Mul(hn::Sub(height(t_begin), hn::Set(tag, f.base)), per_step), margin), a.z);
  put(hn::Sub(slope, hn::Set(tag, sideways)), a.dz);
  put(hn::Add(margin, margin), a.margin);
  const V way = hn::Add(hn::Mul(hn::Sub(t_end, t_begin), longest), slack_cells);
  put(hn::Mul(way, hn::Set(tag, 1 + 0x1p-22)), a.end);
  hn::Store(t_begin, tag, a.t_begin + part), hn::Store(per_longest, tag, a.t_per_cell + part);
  const auto put_whole = [&](V v, std::int32_t* to)
                             HWY_ATTR { hn::Store(hn::DemoteTo(whole_tag, v), whole_tag, to + part); };
  const V mask = hn::Set(tag, f.mask), last_x = hn::Sub(cols, one), last_y = hn::Sub(rows, one);
  const V shift_x = hn::IfThenElseZero(x.back, hn::Sub(mask, last_x));
  const V shift_y = hn::IfThenElseZero(y.back, hn::Sub(mask, last_y));
  put_whole(hn::IfThenElseZero(x.back, mask), a.mirror_x), put_whole(hn::IfThenElseZero(y.back, mask), a.mirror_y);
  put_whole(hn::Add(cell_x, shift_x), a.x), put_whole(hn::Add(cell_y, shift_y), a.y);
  put_whole(hn::Add(shift_x, last_x), a.last_x), put_whole(hn::Add(shift_y, last_y), a.last_y);
  const auto outside = hn::And(followed, hn::Ne(t_begin, t_min));
  put_whole(hn::IfThenElseZero(outside, hn::Set(tag, f.from_outside)), a.level);
  put_whole(hn::IfThenElseZero(hn::And(followed, from_above), one), a.seen);
  const V status = hn::IfThenElse(followed, hn::Set(tag, kWalking), hn::Set(tag, kAlone));
  put_whole(hn::IfThenElse(misses, hn::Set(tag, kMiss), status), a.status);
}
}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
