// SPDX-License-Identifier: MIT
// A height field: samples at the nodes of a grid, and a surface between them.
//
//   world (right-handed, metres)          grid (left-handed)
//     y north                               col ->
//     ^        o--o--o--o                 row  o--o--o--o     samples are at the nodes o
//     |        |  |  |  |                  |   |  |  |  |     a cell is the square between 4 samples
//     |        o--o--o--o                  v   o--o--o--o     N x M samples have (N-1) x (M-1) cells
//     +--> x east, z up                        |  |  |  |
//   the south-west sample is at (0, 0)         o--o--o--o
//
// Rays hit the surface only from above. A cell with a nodata sample at one of its four corners is a hole: rays pass
// through it.
// A wrapped field covers the whole plane: world (x, y), (x + width(), y) and (x, y + depth()) are the same point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scarp/base/edit_count.h"
#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/field/sample_extent.h"
#include "scarp/field/sample_grid.h"

namespace scarp {

enum class SampleType : std::uint8_t { int16, uint16, float32 };

/// Returns "int16", "uint16" or "float32".
std::string_view name_of(SampleType type);

/// Interpolation between the samples.
enum class Surface : std::uint8_t {
  bilinear,   ///< the bilinear patch through the four samples of each cell
  triangles,  ///< two triangles per cell, split along the diagonal from (col+1, row) to (col, row+1), as in
              ///< triangle-mesh renderers
};

/// Continuation beyond the border.
enum class Wrap : std::uint8_t {
  none,          ///< ends at the border: N x M samples have (N-1) x (M-1) cells
  periodic,      ///< repeats; the last column is followed by the first: N x M cells, period N and M cells
  shared_border  ///< repeats; the last column and row equal the first: (N-1) x (M-1) cells and period
};

/// Mapping from samples to a surface in metres.
struct HeightFieldSettings {
  double cell_x = 1.0;                          ///< column spacing in metres, > 0
  double cell_y = 1.0;                          ///< row spacing in metres, > 0
  double scale = 1.0;                           ///< z = (sample * scale + offset) * exaggeration; > 0
  double offset = 0.0;                          ///< metres
  double exaggeration = 1.0;                    ///< > 0
  std::optional<double> nodata = std::nullopt;  ///< sample value of a hole; NaN is always a hole in float32
  Surface surface = Surface::bilinear;
  Wrap wrap = Wrap::none;
  /// Whether the volume below the surface is solid: rays that enter it through the border or from a hole hit a wall
  /// there. Rays that start inside are `below`, as without `solid`.
  bool solid = false;
};

/// Returns the height of a cell's surface at (u, v), each 0..1, in sample units.
inline double height_in_cell(Surface surface, const CellHeights& h, double u, double v) {
  if (surface == Surface::bilinear) {
    const double north = h.h00 + u * (h.h10 - h.h00), south = h.h01 + u * (h.h11 - h.h01);
    return north + v * (south - north);
  }
  if (u + v <= 1) return h.h00 + u * (h.h10 - h.h00) + v * (h.h01 - h.h00);
  return h.h11 + (1 - u) * (h.h01 - h.h11) + (1 - v) * (h.h10 - h.h11);
}

/// Cells [col_begin, col_end) x [row_begin, row_end). In a wrapped field col_begin or row_begin may be -1, which means
/// the last column or row.
struct CellBox {
  int col_begin = 0;
  int row_begin = 0;
  int col_end = 0;
  int row_end = 0;
};

/// A ray in grid units: x in columns, y in rows (southwards), z in sample units. t is the same as for the world ray.
struct GridRay {
  dvec3 origin;
  dvec3 direction;
};

/// A height field. Copies are cheap: they share the samples and see one another's edits. Only set_samples() and
/// samples_changed() change a field, and must not run concurrently with queries (accel/live_field.h synchronises them).
class HeightField {
 public:
  /// Wraps caller-owned memory without copying; it must outlive every copy of the field. `row_stride` is the distance
  /// between rows in samples; 0 means `cols`. If it is negative, `samples` points to the northernmost row, which is
  /// last in memory. Throws Error for a null pointer, fewer than 1 column or row, rows that overlap (a stride shorter
  /// than a row), a setting out of range, an infinite sample (with its position), or a shared border whose sides differ
  /// (with the position). `memory`, if not empty, is what owns the samples: scenes throw Error once it is destroyed.
  template <class T>
  static HeightField view(const T* samples, int cols, int rows, const HeightFieldSettings& settings = {},
                          std::ptrdiff_t row_stride = 0, std::weak_ptr<const void> memory = {});
  /// Takes ownership of cols * rows samples, rows from north to south. Throws as view() does.
  template <class T>
  static HeightField own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings = {});

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int cell_cols() const { return cols_ - (settings_.wrap == Wrap::periodic ? 0 : 1); }
  int cell_rows() const { return rows_ - (settings_.wrap == Wrap::periodic ? 0 : 1); }
  /// False for a single row or column (unless periodic): every ray misses.
  bool has_cells() const { return cell_cols() > 0 && cell_rows() > 0; }
  bool wraps() const { return settings_.wrap != Wrap::none; }
  SampleType sample_type() const { return type_; }
  const HeightFieldSettings& settings() const { return settings_; }
  std::int64_t nodata_count() const { return state_->extents.whole().nodata; }
  bool all_nodata() const { return nodata_count() == std::int64_t{cols_} * rows_; }

  /// Whether a cell has four valid samples; otherwise every ray misses. Scans the cells up to the first such one.
  bool has_ground() const;

  /// Minimum and maximum sample, in sample units. Undefined if all_nodata().
  double min_sample() const { return static_cast<double>(state_->extents.whole().min); }
  double max_sample() const { return static_cast<double>(state_->extents.whole().max); }
  /// Minimum and maximum in metres of world z, with exaggeration.
  double min_height() const { return height_from_sample(min_sample()); }
  double max_height() const { return height_from_sample(max_sample()); }
  /// Extent of the cells in metres: x in [0, width()], y in [0, depth()]. The period of a wrapped field.
  double width() const { return cell_cols() * settings_.cell_x; }
  double depth() const { return cell_rows() * settings_.cell_y; }

  double height_from_sample(double s) const {
    return (s * settings_.scale + settings_.offset) * settings_.exaggeration;
  }

  /// Coefficients of grid_from_world(), for vectorised callers that must reproduce it exactly.
  struct GridScales {
    double per_cell_x, per_cell_y, z_offset, per_scale;
  };
  GridScales grid_scales() const { return {per_cell_x_, per_cell_y_, z_offset_, per_scale_}; }
  GridRay grid_from_world(const Ray& ray) const {
    return {{col_from_x(ray.origin.x), row_from_y(ray.origin.y), (ray.origin.z - z_offset_) * per_scale_},
            {ray.direction.x * per_cell_x_, -ray.direction.y * per_cell_y_, ray.direction.z * per_scale_}};
  }
  /// Returns the world position of a point in grid units.
  dvec3 world_from_grid(double col, double row, double sample) const {
    return {col * settings_.cell_x, (rows_ - 1 - row) * settings_.cell_y, height_from_sample(sample)};
  }

  /// Returns the cell that contains a world position, [col, col+1) x [row, row+1) with the last column and row closed,
  /// and the position (u, v) in it. On the rim of a hole, this is a cell with ground; elsewhere it may be a hole. A
  /// position within rounding_of_line() of the border or a rim counts as on it. Returns nullopt outside a field without
  /// wrap.
  struct Place {
    Cell cell;
    double u, v;
  };
  std::optional<Place> place(double x, double y) const;
  /// If the position is on the rim of a hole, returns it as a position in an adjacent cell with ground: the first of
  /// those to the west, the north and the north-west that have ground, otherwise one of those to the east and the
  /// south. All other positions are returned unchanged.
  Place ground_at(const Place& place) const;

  /// Returns the distance, in cells, by which rounding may move a position off the grid line that it is on, for a field
  /// with this many cells along the axis. Converting a world coordinate to grid units takes 3 roundings (1 / cell size,
  /// the product, the difference), evaluating the ray at a time 3 more, and the caller's coordinate, col * cell, 1:
  /// together 7 roundings of 2^-53, each relative to the position or to the number of cells. The crossing time of the
  /// line itself adds as many, which makes less than 16.
  static double rounding_of_line(double position, int cells) {
    constexpr double kUnit = 0x1p-53, kRoundings = 16;
    return kRoundings * kUnit * (std::abs(position) + cells);
  }

  /// Returns the corner heights of a cell, or nullopt for a hole. The cell must exist.
  std::optional<CellHeights> cell_heights(Cell cell) const;
  /// Returns the surface height in metres at a world position, or nullopt outside the field and over holes.
  std::optional<double> height(double x, double y) const;
  /// Returns the slope (dz/dx, dz/dy) in metres per metre of world space, x east, y north. The cell must exist and must
  /// not be a hole.
  dvec2 gradient(Cell cell, double u, double v) const;
  std::optional<dvec2> gradient(double x, double y) const;
  /// Returns the upward unit normal of the surface; discontinuous between cells.
  dvec3 normal(Cell cell, double u, double v) const;
  /// Returns a unit normal for shading, continuous between cells: central differences at the four nodes (one-sided at
  /// borders and holes), interpolated bilinearly.
  dvec3 shading_normal(Cell cell, double u, double v) const;

  /// Prefetches the samples that shading_normal() reads for this cell. The cell must exist.
  void prefetch_around(Cell cell) const;

  /// Overwrites a rectangle of samples and returns the cells that changed, for updates of accelerators. `stride` counts
  /// samples per row of `samples`. T must match sample_type(). Throws Error, changing nothing, for a rectangle that is
  /// empty or not inside the field, a null pointer, rows that overlap, another sample type, an infinite sample, a
  /// border that would no longer be shared, or a field over caller-owned memory (view).
  template <class T>
  CellBox set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t stride);
  /// Reports samples that the caller changed in memory passed to view(). Throws Error for a rectangle that is empty or
  /// not inside the field, an infinite sample or a border that is no longer shared; in the last two cases the field
  /// must not be used until another call succeeds.
  CellBox samples_changed(const SampleRect& rect);
  /// Number of successful set_samples() calls plus all samples_changed() calls, over all copies.
  std::uint64_t edits() const { return state_->edits.value(); }
  /// Returns the owner passed to view(), or null if there is none.
  const std::weak_ptr<const void>* memory() const { return state_->memory ? &*state_->memory : nullptr; }

  /// Calls f with the SampleGrid<T> of the stored type and returns its result.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return visit_as(nodata_count() > 0, std::forward<F>(f));
  }

 private:
  // State shared by copies.
  struct State {
    std::shared_ptr<void> owner;  // null: caller-owned samples
    TileExtents extents;
    std::optional<std::weak_ptr<const void>> memory{};  // of the caller
    EditCount edits{};
  };

  template <class T>
  SampleGrid<T> grid(bool has_holes) const {
    return {static_cast<const T*>(data_), row_stride_, cols_, rows_, cell_cols(), cell_rows(), has_holes,
            static_cast<T>(nodata_)};
  }
  template <class F>
  decltype(auto) visit_as(bool has_holes, F&& f) const {
    switch (type_) {
      case SampleType::int16:
        return f(grid<std::int16_t>(has_holes));
      case SampleType::uint16:
        return f(grid<std::uint16_t>(has_holes));
      case SampleType::float32:
        break;
    }
    return f(grid<float>(has_holes));
  }
  // Reads samples that may be nodata.
  template <class F>
  decltype(auto) visit_unknown(F&& f) const {
    return visit_as(may_have_holes_, std::forward<F>(f));
  }
  HeightField(SampleType type, const void* data, int cols, int rows, std::ptrdiff_t row_stride,
              const HeightFieldSettings& settings, std::shared_ptr<void> owner);
  void require_inside(const SampleRect& rect) const;
  template <class T, class Sample>
  void require_shared_border(const SampleGrid<T>& grid, const Sample& sample) const;
  CellBox cells_of(const SampleRect& rect) const;
  template <class T>
  dvec3 shading_normal_inside(const SampleGrid<T>& grid, Cell cell, double u, double v) const;
  dvec3 normal_of_slopes(const dvec2& slopes) const;

  // A position on the border must stay on it: rounding must not move it out of the field.
  double col_from_x(double x) const {
    const double col = x * per_cell_x_;
    return !wraps() && x <= width() ? std::min(col, static_cast<double>(cell_cols())) : col;
  }
  double row_from_y(double y) const {
    const double row = (rows_ - 1) - y * per_cell_y_;
    return !wraps() && y <= depth() ? std::max(row, 0.0) : row;
  }

  SampleType type_ = SampleType::float32;
  const void* data_ = nullptr;
  int cols_ = 0;
  int rows_ = 0;
  std::ptrdiff_t row_stride_ = 0;
  HeightFieldSettings settings_;
  double nodata_ = 0;
  bool may_have_holes_ = false;  // whether samples can be nodata at all
  double per_cell_x_ = 1;
  double per_cell_y_ = 1;
  double z_offset_ = 0;   // world z of sample value 0
  double per_scale_ = 1;  // sample units per metre of world z
  std::shared_ptr<State> state_;
};

}  // namespace scarp
