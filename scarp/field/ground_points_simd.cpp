// SPDX-License-Identifier: MIT
#include "scarp/field/ground_points_simd.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/field/ground_points_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<double> dd;
constexpr hn::Rebind<std::int32_t, decltype(dd)> di;
constexpr hn::Rebind<float, decltype(dd)> df;
[[maybe_unused]] constexpr hn::Rebind<std::int64_t, decltype(dd)> dl;  // only with gathers
using VD = hn::Vec<decltype(dd)>;
using VI = hn::Vec<decltype(di)>;
using MD = hn::Mask<decltype(dd)>;
constexpr std::size_t N = hn::MaxLanes(dd);

// Fraction of a cell within which a point over a hole may be on a rim: more than HeightField::rounding_of_line(), which
// is at most 2^-49 * 2^32 cells.
constexpr double kNearRim = 0x1p-16;

// Corner heights of the cells of all lanes.
struct Corners {
  VD h00, h10, h01, h11;
};

// Two neighbouring samples, as doubles.
struct Pair {
  VD west, east;
};

#if HWY_CAP_GE256
// Both samples in one load for each lane: the lower half is the western one.
HWY_INLINE Pair gather_pair(const float* samples, hn::Vec<decltype(dl)> bytes) {
  const auto both = hn::GatherOffset(dl, reinterpret_cast<const std::int64_t*>(samples), bytes);
  constexpr hn::RebindToUnsigned<decltype(dl)> dul;
  constexpr hn::Rebind<std::uint32_t, decltype(dd)> du;
  const auto bits = hn::BitCast(dul, both);
  return {hn::PromoteTo(dd, hn::BitCast(df, hn::TruncateTo(du, bits))),
          hn::PromoteTo(dd, hn::BitCast(df, hn::TruncateTo(du, hn::ShiftRight<32>(bits))))};
}
#endif

template <class T>
HWY_INLINE VD load_samples(const T* samples) {
  if constexpr (std::is_floating_point_v<T>) {
    return hn::PromoteTo(dd, hn::Load(df, samples));
  } else {
    return hn::PromoteTo(dd, hn::Load(di, samples));
  }
}

// The cells must exist and must not be at a seam.
template <class T>
HWY_INLINE Corners corners(const SampleGrid<T>& grid, VI col, VI row) {
#if HWY_CAP_GE256
  if constexpr (std::is_same_v<T, float>) {
    // Offsets in doubles are exact: rasters have fewer than 2^53 bytes.
    const VD stride = hn::Set(dd, static_cast<double>(grid.row_stride));
    const VD at = hn::Add(hn::Mul(hn::PromoteTo(dd, row), stride), hn::PromoteTo(dd, col));
    const auto bytes = hn::ConvertTo(dl, hn::Mul(at, hn::Set(dd, double{sizeof(T)})));
    const Pair north = gather_pair(grid.data, bytes), south = gather_pair(grid.data + grid.row_stride, bytes);
    return {north.west, north.east, south.west, south.east};
  }
#endif
  using Wide = std::conditional_t<std::is_same_v<T, float>, float, std::int32_t>;
  alignas(64) std::int32_t cols[N], rows[N];
  alignas(64) Wide h00[N], h10[N], h01[N], h11[N];
  hn::Store(col, di, cols), hn::Store(row, di, rows);
  for (std::size_t j = 0; j < N; ++j) {
    const T *north = grid.row(rows[j]) + cols[j], *south = north + grid.row_stride;
    h00[j] = north[0], h10[j] = north[1], h01[j] = south[0], h11[j] = south[1];
  }
  return {load_samples(h00), load_samples(h10), load_samples(h01), load_samples(h11)};
}

// Constants of a field in all lanes; see the members of HeightField of the same names.
struct FieldVectors {
  VD per_cell_x, per_cell_y, last_row, width, depth, cols, rows, metres, scale, offset, exaggeration;
  bool wraps, periodic, triangles;

  explicit HWY_INLINE FieldVectors(const HeightField& field) {
    const HeightFieldSettings& s = field.settings();
    const HeightField::GridScales scales = field.grid_scales();
    per_cell_x = hn::Set(dd, scales.per_cell_x), per_cell_y = hn::Set(dd, scales.per_cell_y);
    last_row = hn::Set(dd, field.rows() - 1);
    width = hn::Set(dd, field.width()), depth = hn::Set(dd, field.depth());
    cols = hn::Set(dd, field.cell_cols()), rows = hn::Set(dd, field.cell_rows());
    metres = hn::Set(dd, s.scale * s.exaggeration);
    scale = hn::Set(dd, s.scale), offset = hn::Set(dd, s.offset), exaggeration = hn::Set(dd, s.exaggeration);
    wraps = field.wraps(), periodic = s.wrap == Wrap::periodic, triangles = s.surface == Surface::triangles;
  }
};

// A coordinate along one axis, in cells: HeightField::place().
struct Along {
  VI cell;
  VD in_cell;
  MD inside;
};
HWY_INLINE Along place(VD position, VD cells, bool wraps) {
  const VD zero = hn::Zero(dd), one = hn::Set(dd, 1);
  if (wraps) position = hn::Sub(position, hn::Mul(hn::Floor(hn::Div(position, cells)), cells));
  // Positions far outside have a smaller rounding than theirs, so that infinity is outside.
  const VD near = hn::Min(hn::Abs(position), hn::Add(cells, cells));
  const VD off = hn::Mul(hn::Set(dd, 0x1p-53 * 16), hn::Add(near, cells));
  const MD inside = hn::And(hn::Ge(position, hn::Neg(off)), hn::Le(position, hn::Add(cells, off)));
  // Lanes outside have any cell.
  const VD at = hn::Min(hn::Max(hn::IfThenElseZero(inside, position), zero), cells);
  const VI cell = hn::DemoteTo(di, hn::Min(at, hn::Sub(cells, one)));
  return {cell, hn::Sub(at, hn::PromoteTo(dd, cell)), inside};
}

HWY_INLINE VD between(VD a, VD b, VD f) { return hn::Add(a, hn::Mul(f, hn::Sub(b, a))); }

// height_in_cell().
HWY_INLINE VD height_in(const Corners& h, VD u, VD v, bool triangles) {
  if (!triangles) return between(between(h.h00, h.h10, u), between(h.h01, h.h11, u), v);
  const VD one = hn::Set(dd, 1), left_u = hn::Sub(one, u), left_v = hn::Sub(one, v);
  const VD north_west = hn::Add(between(h.h00, h.h10, u), hn::Mul(v, hn::Sub(h.h01, h.h00)));
  const VD south_east = hn::Add(between(h.h11, h.h01, left_u), hn::Mul(left_v, hn::Sub(h.h10, h.h11)));
  return hn::IfThenElse(hn::Le(hn::Add(u, v), one), north_west, south_east);
}

// HeightField::normal(); zero in lanes that are not `valid`.
HWY_INLINE void store_normals(const FieldVectors& f, const Corners& h, VD u, VD v, MD valid, dvec3* normals) {
  const VD one = hn::Set(dd, 1);
  if (f.triangles) u = v = hn::IfThenElseZero(hn::Gt(hn::Add(u, v), one), one);
  const VD along_row = between(hn::Sub(h.h10, h.h00), hn::Sub(h.h11, h.h01), v);
  const VD along_col = between(hn::Sub(h.h01, h.h00), hn::Sub(h.h11, h.h10), u);
  const VD x = hn::Neg(hn::Mul(hn::Mul(along_row, f.metres), f.per_cell_x));
  const VD y = hn::Mul(hn::Mul(along_col, f.metres), f.per_cell_y);
  const VD square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), one);
  const VD per_length = hn::Div(one, hn::Sqrt(square));
  const auto masked = [&](VD value) HWY_ATTR { return hn::IfThenElseZero(valid, hn::Mul(value, per_length)); };
  hn::StoreInterleaved3(masked(x), masked(y), masked(one), dd, &normals->x);
}

template <class T>
HWY_INLINE MD is_nodata(const SampleGrid<T>& grid, VD sample) {
  return hn::Or(hn::Eq(sample, hn::Set(dd, static_cast<double>(grid.nodata))), hn::IsNaN(sample));
}

template <class T, bool holes, bool with_normals>
void look_up(const HeightField& field, const SampleGrid<T>& grid, const double* xs, const double* ys, std::size_t count,
             double* heights, dvec3* normals) {
  const FieldVectors f(field);
  std::size_t i = 0;
  for (; i + N <= count; i += N) {
    const VD x = hn::LoadU(dd, xs + i), y = hn::LoadU(dd, ys + i);
    VD col = hn::Mul(x, f.per_cell_x), row = hn::Sub(f.last_row, hn::Mul(y, f.per_cell_y));
    if (!f.wraps) {
      col = hn::IfThenElse(hn::Le(x, f.width), hn::Min(col, f.cols), col);
      row = hn::IfThenElse(hn::Le(y, f.depth), hn::Max(row, hn::Zero(dd)), row);
    }
    const Along ax = place(col, f.cols, f.wraps), ay = place(row, f.rows, f.wraps);
    MD valid = hn::And(ax.inside, ay.inside);
    VI cell_x = ax.cell, cell_y = ay.cell;
    MD alone = hn::Lt(hn::Zero(dd), hn::Zero(dd));  // lanes that are looked up one by one
    if (f.periodic) {
      const VD one = hn::Set(dd, 1);
      const VD at_x = hn::PromoteTo(dd, cell_x), at_y = hn::PromoteTo(dd, cell_y);
      alone = hn::Or(hn::Ge(at_x, hn::Sub(f.cols, one)), hn::Ge(at_y, hn::Sub(f.rows, one)));
      cell_x = hn::DemoteTo(di, hn::IfThenZeroElse(alone, at_x));
      cell_y = hn::DemoteTo(di, hn::IfThenZeroElse(alone, at_y));
    }
    const Corners h = corners(grid, cell_x, cell_y);
    if constexpr (holes) {
      const MD hole = hn::Or(hn::Or(is_nodata(grid, h.h00), is_nodata(grid, h.h10)),
                             hn::Or(is_nodata(grid, h.h01), is_nodata(grid, h.h11)));
      // A point near a rim may belong to another cell.
      const VD near = hn::Set(dd, kNearRim), far = hn::Set(dd, 1 - kNearRim);
      const MD rim = hn::Or(hn::Or(hn::Le(ax.in_cell, near), hn::Ge(ax.in_cell, far)),
                            hn::Or(hn::Le(ay.in_cell, near), hn::Ge(ay.in_cell, far)));
      alone = hn::Or(alone, hn::And(hole, rim));
      valid = hn::AndNot(hole, valid);
    }
    const VD sample = height_in(h, ax.in_cell, ay.in_cell, f.triangles);
    const VD height = hn::Mul(hn::Add(hn::Mul(sample, f.scale), f.offset), f.exaggeration);
    const VD none = hn::Set(dd, std::numeric_limits<double>::quiet_NaN());
    hn::StoreU(hn::IfThenElse(valid, height, none), dd, heights + i);
    if constexpr (with_normals) store_normals(f, h, ax.in_cell, ay.in_cell, valid, normals + i);
    if ((holes || f.periodic) && !hn::AllFalse(dd, alone)) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(dd, alone, bits);
      for (std::size_t j = 0; j < N; ++j) {
        if (bits[0] >> j & 1)
          look_up_point(field, xs[i + j], ys[i + j], heights[i + j], with_normals ? normals + i + j : nullptr);
      }
    }
  }
  for (; i < count; ++i) look_up_point(field, xs[i], ys[i], heights[i], with_normals ? normals + i : nullptr);
}

void look_up_all(const HeightField& field, const double* xs, const double* ys, std::size_t count, double* heights,
                 dvec3* normals) {
  field.visit([&](const auto& grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    const auto run = [&]<bool holes>() {
      normals ? look_up<T, holes, true>(field, grid, xs, ys, count, heights, normals)
              : look_up<T, holes, false>(field, grid, xs, ys, count, heights, normals);
    };
    grid.has_holes ? run.template operator()<true>() : run.template operator()<false>();
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(look_up_all);

}  // namespace

void look_up_points(const HeightField& field, const double* xs, const double* ys, std::size_t count, double* heights,
                    dvec3* normals) {
  // A vector may look up the cell at the origin for lanes without one.
  if (field.cols() < 2 || field.rows() < 2 || !field.has_cells()) {
    for (std::size_t i = 0; i < count; ++i)
      look_up_point(field, xs[i], ys[i], heights[i], normals ? normals + i : nullptr);
    return;
  }
  HWY_DYNAMIC_DISPATCH(look_up_all)(field, xs, ys, count, heights, normals);
}

void look_up_point(const HeightField& field, double x, double y, double& height, dvec3* normal) {
  height = std::numeric_limits<double>::quiet_NaN();
  if (normal) *normal = dvec3(0.0);
  const auto at = field.place(x, y);
  if (!at) return;
  const auto h = field.cell_heights(at->cell);
  if (!h) return;
  height = field.height_from_sample(height_in_cell(field.settings().surface, *h, at->u, at->v));
  if (normal) *normal = field.normal(at->cell, at->u, at->v);
}

}  // namespace scarp
#endif
