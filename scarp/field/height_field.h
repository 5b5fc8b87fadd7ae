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
#pragma once

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

namespace scarp {

enum class SampleType : std::uint8_t { int16, uint16, float32 };

/// "int16", "uint16" or "float32".
std::string_view name_of(SampleType type);

/// Samples as stored, in rows from north to south, for code that works on one sample type. Plain data, no ownership.
template <class T>
struct SampleGrid {
  const T* data = nullptr;
  std::ptrdiff_t row_stride = 0;  ///< in samples, from one row to the next one south; may be negative
  int cols = 0;
  int rows = 0;
  bool has_holes = false;  ///< whether any sample is nodata
  T nodata{};              ///< the value that marks a hole (in float32 NaN does, too); means nothing without holes

  const T* row(int r) const { return data + r * row_stride; }
  T at(int col, int r) const { return row(r)[col]; }
  bool is_nodata(T sample) const {
    if constexpr (std::is_floating_point_v<T>) return has_holes && (sample == nodata || sample != sample);
    return has_holes && sample == nodata;
  }
  bool is_hole(int col, int r) const {
    return has_holes && (is_nodata(at(col, r)) || is_nodata(at(col + 1, r)) || is_nodata(at(col, r + 1)) ||
                         is_nodata(at(col + 1, r + 1)));
  }
};

/// How samples become a surface in metres.
struct HeightFieldSettings {
  double cell_x = 1.0;                          ///< metres from one column to the next, > 0
  double cell_y = 1.0;                          ///< metres from one row to the next, > 0
  double scale = 1.0;                           ///< z = (sample * scale + offset) * exaggeration; > 0
  double offset = 0.0;                          ///< metres
  double exaggeration = 1.0;                    ///< > 0
  std::optional<double> nodata = std::nullopt;  ///< sample value of a hole; NaN is one in float32 anyway
};

/// The heights of one cell at its corners, in sample units: h10 is at (col+1, row), h01 at (col, row+1).
struct CellHeights {
  double h00, h10, h01, h11;
};

/// A ray in grid units: x in columns, y in rows (southwards), z in sample units; t is that of the world ray.
struct GridRay {
  dvec3 origin;
  dvec3 direction;
};

/// Immutable; cheap to copy (copies share the samples).
class HeightField {
 public:
  /// Over memory of the caller's, which is not copied and must outlive every copy of the field. `row_stride` counts
  /// samples. Throws Error: fewer than 1 column or row, a setting out of its range, an infinite sample (which one).
  template <class T>
  static HeightField view(const T* samples, int cols, int rows, std::ptrdiff_t row_stride,
                          const HeightFieldSettings& settings = {});
  /// Takes the samples, rows from north to south, size cols * rows. Throws as view() does.
  template <class T>
  static HeightField own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings = {});

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int cell_cols() const { return cols_ - 1; }
  int cell_rows() const { return rows_ - 1; }
  /// False for a single row or column: then every ray misses.
  bool has_cells() const { return cols_ > 1 && rows_ > 1; }
  SampleType sample_type() const { return type_; }
  const HeightFieldSettings& settings() const { return settings_; }
  std::int64_t nodata_count() const { return nodata_count_; }
  bool all_nodata() const { return nodata_count_ == std::int64_t{cols_} * rows_; }

  /// Lowest and highest sample, in sample units; means nothing when all_nodata().
  double min_sample() const { return min_sample_; }
  double max_sample() const { return max_sample_; }
  /// The same in metres of world z, exaggerated.
  double min_height() const { return height_from_sample(min_sample_); }
  double max_height() const { return height_from_sample(max_sample_); }
  /// Extent of the nodes in metres: x in [0, width()], y in [0, depth()].
  double width() const { return (cols_ - 1) * settings_.cell_x; }
  double depth() const { return (rows_ - 1) * settings_.cell_y; }

  double height_from_sample(double s) const {
    return (s * settings_.scale + settings_.offset) * settings_.exaggeration;
  }

  GridRay grid_from_world(const Ray& ray) const {
    return {
        {ray.origin.x * per_cell_x_, (rows_ - 1) - ray.origin.y * per_cell_y_, (ray.origin.z - z_offset_) * per_scale_},
        {ray.direction.x * per_cell_x_, -ray.direction.y * per_cell_y_, ray.direction.z * per_scale_}};
  }
  /// World position of a point in grid units.
  dvec3 world_from_grid(double col, double row, double sample) const {
    return {col * settings_.cell_x, (rows_ - 1 - row) * settings_.cell_y, height_from_sample(sample)};
  }

  /// The cell that holds a world position: [col, col+1) x [row, row+1), the last column and row closed; u and v are the
  /// place in it. Nothing outside the field; holes are not looked at.
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

  /// Calls f with the SampleGrid<T> of the stored type and returns what it returns.
  template <class F>
  decltype(auto) visit(F&& f) const {
    switch (type_) {
      case SampleType::int16:
        return f(grid<std::int16_t>());
      case SampleType::uint16:
        return f(grid<std::uint16_t>());
      case SampleType::float32:
        break;
    }
    return f(grid<float>());
  }

 private:
  template <class T>
  SampleGrid<T> grid() const {
    return {static_cast<const T*>(data_), row_stride_, cols_, rows_, nodata_count_ > 0, static_cast<T>(nodata_)};
  }
  HeightField(SampleType type, const void* data, int cols, int rows, std::ptrdiff_t row_stride,
              const HeightFieldSettings& settings, std::shared_ptr<const void> owner);

  SampleType type_ = SampleType::float32;
  const void* data_ = nullptr;
  std::shared_ptr<const void> owner_;
  int cols_ = 0;
  int rows_ = 0;
  std::ptrdiff_t row_stride_ = 0;
  HeightFieldSettings settings_;
  double nodata_ = 0;
  std::int64_t nodata_count_ = 0;
  double min_sample_ = 0;
  double max_sample_ = 0;
  double per_cell_x_ = 1;
  double per_cell_y_ = 1;
  double z_offset_ = 0;   // world z of sample value 0
  double per_scale_ = 1;  // sample units per metre of world z
};

}  // namespace scarp
