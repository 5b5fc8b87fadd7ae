// SPDX-License-Identifier: MIT
// Prepares rays for the lanes of max_mip_simd.cpp, in double. Compiled once per instruction set.
#if defined(SCARP_MARCH_MAX_MIP_SIMD_RAYS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#undef SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#else
#define SCARP_MARCH_MAX_MIP_SIMD_RAYS_H
#endif

#include <limits>

#include "scarp/field/height_field.h"
#include "scarp/march/height/max_mip_simd_lanes.h"
#include "scarp/march/ray_numbers_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

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
HWY_INLINE VD rounding(const FieldFrame& f, VD ox, VD oy, VD oz, VD dx, VD dy, VD dz, VD t) {
  const VD upright = hn::Add(hn::Set(dd, f.upright), hn::Add(hn::Abs(oz), hn::Abs(hn::Mul(dz, t))));
  const VD sideways =
      hn::Add(hn::Add(hn::Abs(ox), hn::Abs(hn::Mul(dx, t))), hn::Add(hn::Abs(oy), hn::Abs(hn::Mul(dy, t))));
  const VD wide = hn::Mul(hn::Add(sideways, hn::Set(dd, f.sample_rows)), hn::Set(dd, f.relief));
  return hn::Mul(hn::Set(dd, kRoundings * kUnit), hn::Add(upright, wide));
}

// One axis of rays: mirrored so that they advance, and the times within the field.
struct AxisSpan {
  VD origin, direction, per, enter, exit;
  VD slack;  // rounding error of the border times: larger for slower crossings
  hn::Mask<decltype(dd)> back;
  hn::Mask<decltype(dd)> beside;  // runs along the border, outside
};
HWY_INLINE AxisSpan axis_span(VD o, VD d, VD cells, double seam) {
  const VD zero = hn::Zero(dd), far = hn::Set(dd, std::numeric_limits<double>::infinity());
  AxisSpan s;
  s.back = hn::Lt(d, zero);
  s.origin = hn::IfThenElse(s.back, hn::Sub(cells, o), o);
  s.direction = hn::Abs(d);
  s.per = hn::Div(hn::Set(dd, 1), s.direction);
  // A ray that does not move along the axis is within the field always or never.
  const auto still = hn::Eq(d, zero), within = hn::And(hn::Ge(o, zero), hn::Le(o, cells));
  const VD off = hn::Max(hn::Neg(o), hn::Sub(o, cells));
  s.beside = hn::And(still, hn::AndNot(within, hn::Le(off, hn::Set(dd, seam))));
  s.enter = hn::IfThenElse(still, hn::IfThenElse(within, hn::Neg(far), far), hn::Mul(hn::Neg(s.origin), s.per));
  s.exit = hn::IfThenElse(still, far, hn::Mul(hn::Sub(cells, s.origin), s.per));
  s.slack = hn::Mul(hn::Mul(hn::Set(dd, 8 * kUnit), hn::Add(cells, hn::Abs(o))), s.per);
  s.slack = hn::IfThenElse(still, hn::Zero(dd), s.slack);
  return s;
}

// Fills lanes with rays: clips them to the field and to its highest sample, and finds the first cell. Rays that vector
// code cannot follow become kAlone.
HWY_NOINLINE void prepare(const FieldFrame& f, const GridRays& r, Lanes& a) {
  for (std::size_t part = 0; part < N; part += hn::MaxLanes(dd)) {
    const VD zero = hn::Zero(dd), one = hn::Set(dd, 1), cols = hn::Set(dd, f.cols), rows = hn::Set(dd, f.rows);
    const VD ox = hn::Load(dd, r.ox + part), oy = hn::Load(dd, r.oy + part), oz = hn::Load(dd, r.oz + part);
    const VD dx = hn::Load(dd, r.dx + part), dy = hn::Load(dd, r.dy + part), dz = hn::Load(dd, r.dz + part);
    const VD t_min = hn::Load(dd, r.t_min + part);
    const AxisSpan x = axis_span(ox, dx, cols, f.seam), y = axis_span(oy, dy, rows, f.seam);
    const VD longest = hn::Max(x.direction, y.direction), per_longest = hn::Min(x.per, y.per);
    const VD t_border = hn::Max(t_min, hn::Max(x.enter, y.enter));
    const VD t_exit = hn::Min(hn::Load(dd, r.t_max + part), hn::Min(x.exit, y.exit));
    // Down to where the ray may be below the highest sample; up to where nothing is as high.
    const VD highest = hn::Set(dd, f.highest);
    const auto height = [&](VD t) HWY_ATTR { return hn::Add(oz, hn::Mul(dz, t)); };
    const auto falls = hn::Lt(dz, zero), from_above = hn::Gt(height(t_border), highest);
    const VD t_far = hn::Max(hn::Abs(t_border), hn::Abs(t_exit));
    const VD doubt = rounding(f, ox, oy, oz, dx, dy, dz, t_far), over = hn::Add(highest, doubt);
    const VD quotient = hn::Div(hn::Sub(over, oz), dz);
    const VD t_top = hn::Sub(quotient, hn::Mul(hn::Set(dd, 4 * kUnit), hn::Abs(quotient)));
    const VD t_begin = hn::IfThenElse(hn::And(from_above, falls), hn::Max(t_border, t_top), t_border);
    const VD t_over = hn::Div(hn::Sub(over, oz), dz);
    const VD t_end = hn::IfThenElse(hn::Gt(dz, zero), hn::Min(t_exit, t_over), t_exit);
    // Usual lengths, and slopes of less than 2^30 codes per cell: far from float overflow.
    const VD per_step = hn::Set(dd, f.per_step), slope = hn::Mul(hn::Mul(dz, per_step), per_longest);
    const auto usual =
        hn::And(hn::And(hn::Gt(longest, hn::Set(dd, 0x1p-300)), hn::Lt(longest, hn::Set(dd, 0x1p300))),
                hn::And(hn::Lt(hn::Abs(slope), hn::Set(dd, 0x1p30)), hn::Lt(t_far, hn::Set(dd, 0x1p300))));
    // The borders are accurate to less than a position's rounding, and a sixteenth of a code. A seam widens those that
    // the ray crosses.
    const VD per_enter = hn::IfThenElse(hn::Ge(x.enter, y.enter), x.per, y.per);
    const VD per_exit = hn::IfThenElse(hn::Le(x.exit, y.exit), x.per, y.per);
    const VD at_seam = hn::Mul(hn::Set(dd, f.seam), hn::Max(per_enter, per_exit));
    const VD slack = hn::Add(hn::Max(x.slack, y.slack), at_seam), slack_cells = hn::Mul(slack, longest);
    const auto clear_of_borders = hn::AndNot(hn::Or(x.beside, y.beside), usual);
    const auto sound =
        hn::And(clear_of_borders, hn::And(hn::Lt(slack_cells, hn::Set(dd, kSideways)),
                                          hn::Lt(hn::Mul(slack_cells, hn::Abs(slope)), hn::Set(dd, 0x1p-4))));
    const auto climbs_from_above = hn::AndNot(falls, from_above);
    const auto followed = hn::And(sound, hn::AndNot(climbs_from_above, hn::Lt(t_begin, t_end)));
    // Beside the field, or above all ground from start to end.
    const VD tie = hn::Mul(hn::Set(dd, 0x1p-40), hn::Add(hn::Abs(t_border), hn::Abs(t_exit)));
    const auto beside = hn::Gt(hn::Sub(t_border, t_exit), hn::Add(tie, hn::Add(slack, slack)));
    const auto stays_above = hn::And(hn::And(hn::Gt(height(t_border), over), hn::Lt(t_border, t_exit)),
                                     hn::Or(hn::Not(falls), hn::Gt(height(hn::Add(t_exit, slack)), over)));
    const auto misses = hn::And(sound, hn::Or(beside, stays_above));
    const VD at_x = hn::Add(x.origin, hn::Mul(x.direction, t_begin)),
             at_y = hn::Add(y.origin, hn::Mul(y.direction, t_begin));
    const auto cell = [&](VD at, VD cells) HWY_ATTR {
      return hn::IfThenElseZero(followed, hn::Min(hn::Max(hn::Floor(at), zero), hn::Sub(cells, one)));
    };
    const VD cell_x = cell(at_x, cols), cell_y = cell(at_y, rows);
    const auto put = [&](VD v, float* to) HWY_ATTR { hn::Store(hn::DemoteTo(df_part, v), df_part, to + part); };
    put(hn::Min(hn::Max(hn::Sub(at_x, cell_x), zero), one), a.ox);
    put(hn::Min(hn::Max(hn::Sub(at_y, cell_y), zero), one), a.oy);
    put(hn::Mul(x.direction, per_longest), a.dx), put(hn::Mul(y.direction, per_longest), a.dy);
    const VD most = hn::Set(dd, 0x1p60);
    put(hn::Min(hn::Mul(longest, x.per), most), a.per_x), put(hn::Min(hn::Mul(longest, y.per), most), a.per_y);
    // Positions are accurate to kSideways (T + 2) along either axis.
    const double sideways = 2 * kSideways * f.cell_relief * f.per_step;
    const VD margin = hn::Add(hn::Set(dd, kUpright + 2 * sideways), hn::Mul(doubt, per_step));
    put(hn::Sub(hn::Mul(hn::Sub(height(t_begin), hn::Set(dd, f.base)), per_step), margin), a.z);
    put(hn::Sub(slope, hn::Set(dd, sideways)), a.dz);
    put(hn::Add(margin, margin), a.margin);
    const VD way = hn::Add(hn::Mul(hn::Sub(t_end, t_begin), longest), slack_cells);
    put(hn::Mul(way, hn::Set(dd, 1 + 0x1p-22)), a.end);
    hn::Store(t_begin, dd, a.t_begin + part), hn::Store(per_longest, dd, a.t_per_cell + part);
    const auto put_whole = [&](VD v, std::int32_t* to)
                               HWY_ATTR { hn::Store(hn::DemoteTo(di_part, v), di_part, to + part); };
    const VD mask = hn::Set(dd, f.mask), last_x = hn::Sub(cols, one), last_y = hn::Sub(rows, one);
    const VD shift_x = hn::IfThenElseZero(x.back, hn::Sub(mask, last_x));
    const VD shift_y = hn::IfThenElseZero(y.back, hn::Sub(mask, last_y));
    put_whole(hn::IfThenElseZero(x.back, mask), a.mirror_x), put_whole(hn::IfThenElseZero(y.back, mask), a.mirror_y);
    put_whole(hn::Add(cell_x, shift_x), a.x), put_whole(hn::Add(cell_y, shift_y), a.y);
    put_whole(hn::Add(shift_x, last_x), a.last_x), put_whole(hn::Add(shift_y, last_y), a.last_y);
    const auto outside = hn::And(followed, hn::Ne(t_begin, t_min));
    put_whole(hn::IfThenElseZero(outside, hn::Set(dd, f.from_outside)), a.level);
    put_whole(hn::IfThenElseZero(hn::And(followed, from_above), one), a.seen);
    const VD status = hn::IfThenElse(followed, hn::Set(dd, kWalking), hn::Set(dd, kAlone));
    put_whole(hn::IfThenElse(misses, hn::Set(dd, kMiss), status), a.status);
  }
  for (std::size_t j = 0; j < N; ++j) {
    a.begin_x[j] = a.x[j], a.begin_y[j] = a.y[j], a.T[j] = 0, a.doubt[j] = kNever;
    if (a.status[j] == kWalking) a.seen[j] |= r.seen[j];
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
