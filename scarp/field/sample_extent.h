// SPDX-License-Identifier: MIT
// Minimum, maximum and nodata count of samples, kept per tile, so that edits rescan only their tiles.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "scarp/field/sample_grid.h"

namespace scarp {

/// In sample units. Samples are int16, uint16 or float32, which a float represents exactly.
struct SampleExtent {
  float min = std::numeric_limits<float>::infinity();
  float max = -std::numeric_limits<float>::infinity();
  std::int64_t nodata = 0;

  void merge(const SampleExtent& other);
};

/// Extents of all tiles of a field, and of the whole field.
class TileExtents {
 public:
  /// Scans all samples, on all threads. Throws Error naming the first infinite one.
  template <class T>
  explicit TileExtents(const SampleGrid<T>& grid);

  /// Rescans the tiles of a rectangle. Samples must be finite or nodata.
  template <class T>
  void update(const SampleGrid<T>& grid, const SampleRect& changed);

  const SampleExtent& whole() const { return whole_; }

 private:
  static constexpr int kSide = 64;  // samples per tile side
  template <class T>
  void scan_tile_row(const SampleGrid<T>& grid, int tile_row, int first, int last);
  void gather();

  int tile_cols_ = 0, tile_rows_ = 0;
  std::vector<SampleExtent> tiles_;  // row-major
  std::vector<SampleExtent> rows_;   // combined extents of each row of tiles
  SampleExtent whole_;
};

/// Throws Error naming the first infinite sample of a rectangle that is not marked as nodata.
template <class T>
void refuse_infinite(const SampleGrid<T>& grid, const SampleRect& rect);

}  // namespace scarp
