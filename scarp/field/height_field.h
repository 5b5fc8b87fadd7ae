// SPDX-License-Identifier: MIT
// A height field: samples at the nodes of a grid, a bilinear surface between them.
//
//   world (right-handed, metres)          grid (left-handed)
//     y north                               col ->
//     ^        o--o--o--o                 row  o--o--o--o     samples sit at the nodes o
//     |        |  |  |  |                  |   |  |  |  |     a cell is the square between 4 samples
//     |        o--o--o--o                  v   o--o--o--o     N x M samples have (N-1) x (M-1) cells
//     +--> x east, z up                        |  |  |  |
//   the south-west sample is at (0, 0)         o--o--o--o
//
// The surface is a sheet seen from above. A cell with a nodata sample at one of its four corners is a hole: rays pass.
// A field that wraps round covers the whole plane: world (x, y) and (x + width(), y), (x, y + depth()) are the same
// place.
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

#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/field/sample_extent.h"
#include "scarp/field/sample_grid.h"

namespace scarp {

enum class SampleType : std::uint8_t { int16, uint16, float32 };

/// "int16", "uint16" or "float32".
std::string_view name_of(SampleType type);

/// What lies between the samples.
enum class Surface : std::uint8_t {
  bilinear,   ///< in each cell the bilinear patch through its four samples
  triangles,  ///< two triangles per cell, parted by the diagonal from (col+1, row) to (col, row+1), as mesh engines do
};

/// What lies beyond the border.
enum class Wrap : std::uint8_t {
  none,          ///< nothing: N x M samples have (N-1) x (M-1) cells
  periodic,      ///< the field again; the last column is followed by the first: N x M cells, period N and M cells
  shared_border  ///< the field again; the last column and row repeat the first: (N-1) x (M-1) cells and period
};

/// How samples become a surface in metres.
struct HeightFieldSettings {
  double cell_x = 1.0;                          ///< metres from one column to the next, > 0
  double cell_y = 1.0;                          ///< metres from one row to the next, > 0
  double scale = 1.0;                           ///< z = (sample * scale + offset) * exaggeration; > 0
  double offset = 0.0;                          ///< metres
  double exaggeration = 1.0;                    ///< > 0
  std::optional<double> nodata = std::nullopt;  ///< sample value of a hole; NaN is one in float32 anyway
  Surface surface = Surface::bilinear;
  Wrap wrap = Wrap::none;
  /// Whether there is rock under the sheet: then a ray that comes in below it through the border or out of a hole hits
  /// the wall there. One that begins inside is below, as without.
  bool solid = false;
};

/// Height of a cell's surface at (u, v) in it, 0..1, in sample units.
inline double height_in_cell(Surface surface, const CellHeights& h, double u, double v) {
  if (surface == Surface::bilinear) {
    const double north = h.h00 + u * (h.h10 - h.h00), south = h.h01 + u * (h.h11 - h.h01);
    return north + v * (south - north);
  }
  if (u + v <= 1) return h.h00 + u * (h.h10 - h.h00) + v * (h.h01 - h.h00);
  return h.h11 + (1 - u) * (h.h01 - h.h11) + (1 - v) * (h.h10 - h.h11);
}

/// Cells [col_begin, col_end) x [row_begin, row_end). In a field that wraps round a begin may be -1: the last ones.
struct CellBox {
  int col_begin = 0;
  int row_begin = 0;
  int col_end = 0;
  int row_end = 0;
};

/// A ray in grid units: x in columns, y in rows (southwards), z in sample units; t is that of the world ray.
struct GridRay {
  dvec3 origin;
  dvec3 direction;
};

/// Cheap to copy: copies share the samples and see one another's edits. Nothing but set_samples() and samples_changed()
/// changes a field; while one of them runs, no query may (accel/live_field.h keeps them apart).
class HeightField {
 public:
  /// Over memory of the caller's, which is not copied and must outlive every copy of the field. `row_stride` counts
  /// samples. Throws Error: fewer than 1 column or row, a setting out of its range, an infinite sample (which one), a
  /// shared border whose two sides differ (where).
  template <class T>
  static HeightField view(const T* samples, int cols, int rows, std::ptrdiff_t row_stride,
                          const HeightFieldSettings& settings = {});
  /// Takes the samples, rows from north to south, size cols * rows. Throws as view() does.
  template <class T>
  static HeightField own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings = {});

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int cell_cols() const { return cols_ - (settings_.wrap == Wrap::periodic ? 0 : 1); }
  int cell_rows() const { return rows_ - (settings_.wrap == Wrap::periodic ? 0 : 1); }
  /// False for a single row or column (unless periodic): then every ray misses.
  bool has_cells() const { return cell_cols() > 0 && cell_rows() > 0; }
  bool wraps() const { return settings_.wrap != Wrap::none; }
  SampleType sample_type() const { return type_; }
  const HeightFieldSettings& settings() const { return settings_; }
  std::int64_t nodata_count() const { return state_->extents.whole().nodata; }
  bool all_nodata() const { return nodata_count() == std::int64_t{cols_} * rows_; }

  /// Lowest and highest sample, in sample units; means nothing when all_nodata().
  double min_sample() const { return static_cast<double>(state_->extents.whole().min); }
  double max_sample() const { return static_cast<double>(state_->extents.whole().max); }
  /// The same in metres of world z, exaggerated.
  double min_height() const { return height_from_sample(min_sample()); }
  double max_height() const { return height_from_sample(max_sample()); }
  /// Extent of the cells in metres: x in [0, width()], y in [0, depth()]. The period of a field that wraps round.
  double width() const { return cell_cols() * settings_.cell_x; }
  double depth() const { return cell_rows() * settings_.cell_y; }

  double height_from_sample(double s) const {
    return (s * settings_.scale + settings_.offset) * settings_.exaggeration;
  }

  /// What grid_from_world() subtracts and multiplies by: for those who turn many rays at once, by its operations.
  struct GridScales {
    double per_cell_x, per_cell_y, z_offset, per_scale;
  };
  GridScales grid_scales() const { return {per_cell_x_, per_cell_y_, z_offset_, per_scale_}; }
  GridRay grid_from_world(const Ray& ray) const {
    return {{col_from_x(ray.origin.x), row_from_y(ray.origin.y), (ray.origin.z - z_offset_) * per_scale_},
            {ray.direction.x * per_cell_x_, -ray.direction.y * per_cell_y_, ray.direction.z * per_scale_}};
  }
  /// World position of a point in grid units.
  dvec3 world_from_grid(double col, double row, double sample) const {
    return {col * settings_.cell_x, (rows_ - 1 - row) * settings_.cell_y, height_from_sample(sample)};
  }

  /// The cell that holds a world position: [col, col+1) x [row, row+1), the last column and row closed; u and v are the
  /// place in it. Nothing outside a field that does not wrap round; holes are not looked at.
  struct Place {
    Cell cell;
    double u, v;
  };
  std::optional<Place> place(double x, double y) const;

  /// Corner heights of a cell, or nothing when it is a hole. The cell must exist.
  std::optional<CellHeights> cell_heights(Cell cell) const;
  /// Surface height in metres at a world position; nothing outside and over holes.
  std::optional<double> height(double x, double y) const;
  /// Slope (dz/dx, dz/dy) in metres per metre in world space, x east, y north, at a place in a cell. The cell must
  /// exist and be no hole.
  dvec2 gradient(Cell cell, double u, double v) const;
  std::optional<dvec2> gradient(double x, double y) const;
  /// Unit normal of the surface (upwards) from the gradient; steps from cell to cell.
  dvec3 normal(Cell cell, double u, double v) const;
  /// Unit normal that is continuous from cell to cell, for shading: central differences at the four nodes (one-sided at
  /// borders and holes), interpolated bilinearly.
  dvec3 shading_normal(Cell cell, double u, double v) const;

  /// Overwrites a rectangle of samples with `samples`, `stride` samples from one row to the next, and returns the cells
  /// that changed: what an accelerator has to be updated for. T must be the C++ type of sample_type(). Throws Error and
  /// changes nothing: a rectangle that is empty or not inside, another sample type, an infinite sample, a border that
  /// would no longer be shared, samples that are the caller's (view).
  template <class T>
  CellBox set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t stride);
  /// The same after the caller has written to memory that the field views. Throws Error when the rectangle is empty or
  /// not inside; for an infinite sample or a border no longer shared, after which the field must not be used until a
  /// further call has found it mended.
  CellBox samples_changed(const SampleRect& rect);

  /// Calls f with the SampleGrid<T> of the stored type and returns what it returns.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return visit_as(nodata_count() > 0, std::forward<F>(f));
  }

 private:
  // What copies share.
  struct State {
    std::shared_ptr<void> owner;  // null: the samples are the caller's
    TileExtents extents;
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
  // For a look at samples of which it is not yet known whether they are nodata.
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

  // A position on the border stays there: rounding must not carry it out of the field.
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
  bool may_have_holes_ = false;  // whether a sample can be nodata at all
  double per_cell_x_ = 1;
  double per_cell_y_ = 1;
  double z_offset_ = 0;   // world z of sample value 0
  double per_scale_ = 1;  // sample units per metre of world z
  std::shared_ptr<State> state_;
};

}  // namespace scarp
