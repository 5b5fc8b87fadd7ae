// SPDX-License-Identifier: MIT
#include "scarp/field/sample_extent.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// SampleGrid::is_nodata of a grid with holes. For float in integers: a comparison of floats may raise a flag, which
// keeps compilers from taking it out of a branch.
template <class T>
struct IsNodata {
  explicit IsNodata(T value) : nodata(value) {}
  bool operator()(T sample) const { return sample == nodata; }
  T nodata;
};
template <>
struct IsNodata<float> {
  // 0 and -0 are equal.
  explicit IsNodata(float value)
      : mask(value == 0 ? kMagnitude : -1), nodata(std::bit_cast<std::int32_t>(value) & mask) {}
  bool operator()(float sample) const {
    const auto bits = std::bit_cast<std::int32_t>(sample);
    return ((bits & mask) == nodata) | ((bits & kMagnitude) > kInfinite);
  }
  static constexpr std::int32_t kMagnitude = 0x7fffffff, kInfinite = 0x7f800000;
  std::int32_t mask, nodata;
};

template <class T>
void include(T low, T high, SampleExtent& extent) {
  extent.min = std::min(extent.min, static_cast<float>(low));
  extent.max = std::max(extent.max, static_cast<float>(high));
}

// Lowest and highest of a run without holes, in lanes side by side, so that compilers make vector instructions of it:
// they may not reorder one chain of float comparisons.
template <class T>
void extend_valid(const T* run, int count, SampleExtent& extent) {
  constexpr int kLanes = 16;
  T low[kLanes], high[kLanes];
  std::fill(low, low + kLanes, run[0]);
  std::fill(high, high + kLanes, run[0]);
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const T sample = run[i + lane];
      low[lane] = sample < low[lane] ? sample : low[lane];
      high[lane] = sample > high[lane] ? sample : high[lane];
    }
  }
  for (; i < count; ++i) include(run[i], run[i], extent);
  include(*std::min_element(low, low + kLanes), *std::max_element(high, high + kLanes), extent);
}

template <class T>
void extend(const SampleGrid<T>& grid, const T* run, int count, SampleExtent& extent) {
  int holes = 0;
  if (grid.has_holes) {
    const IsNodata<T> is_nodata(grid.nodata);
    for (int i = 0; i < count; ++i) holes += is_nodata(run[i]);
  }
  extent.nodata += holes;
  if (holes == 0) return extend_valid(run, count, extent);
  for (int i = 0; i < count; ++i) {
    if (!grid.is_nodata(run[i])) include(run[i], run[i], extent);
  }
}

}  // namespace

void SampleExtent::merge(const SampleExtent& other) {
  min = std::min(min, other.min);
  max = std::max(max, other.max);
  nodata += other.nodata;
}

template <class T>
TileExtents::TileExtents(const SampleGrid<T>& grid)
    : tile_cols_((grid.cols + kSide - 1) / kSide),
      tile_rows_((grid.rows + kSide - 1) / kSide),
      tiles_(static_cast<std::size_t>(tile_cols_) * tile_rows_),
      rows_(static_cast<std::size_t>(tile_rows_)) {
  parallel_for(tile_rows_, 1, [&](std::int64_t begin, std::int64_t end) {
    for (int row = static_cast<int>(begin); row < end; ++row) scan_tile_row(grid, row, 0, tile_cols_);
  });
  gather();
  if (std::isinf(whole_.max) || std::isinf(whole_.min)) refuse_infinite(grid, {0, 0, grid.cols, grid.rows});
}

template <class T>
void TileExtents::update(const SampleGrid<T>& grid, const SampleRect& changed) {
  const int last_row = (changed.row + changed.rows - 1) / kSide, last_col = (changed.col + changed.cols - 1) / kSide;
  for (int row = changed.row / kSide; row <= last_row; ++row) {
    scan_tile_row(grid, row, changed.col / kSide, last_col + 1);
  }
  gather();
}

template <class T>
void TileExtents::scan_tile_row(const SampleGrid<T>& grid, int tile_row, int first, int last) {
  const std::size_t begin = static_cast<std::size_t>(tile_row) * tile_cols_;
  for (int tile = first; tile < last; ++tile) {
    SampleExtent& extent = tiles_[begin + tile];
    extent = {};
    const int col = tile * kSide, cols = std::min(kSide, grid.cols - col);
    const int row_end = std::min((tile_row + 1) * kSide, grid.rows);
    for (int row = tile_row * kSide; row < row_end; ++row) extend(grid, grid.row(row) + col, cols, extent);
  }
  SampleExtent& row = rows_[static_cast<std::size_t>(tile_row)];
  row = {};
  for (int tile = 0; tile < tile_cols_; ++tile) row.merge(tiles_[begin + tile]);
}

void TileExtents::gather() {
  whole_ = {};
  for (const SampleExtent& row : rows_) whole_.merge(row);
}

template <class T>
void refuse_infinite(const SampleGrid<T>& grid, const SampleRect& rect) {
  if constexpr (std::is_floating_point_v<T>) {
    for (int row = rect.row; row < rect.row + rect.rows; ++row) {
      // Without a branch per sample: infinities are rare.
      int beyond = 0;
      const T* run = grid.row(row) + rect.col;
      for (int i = 0; i < rect.cols; ++i) beyond += std::abs(run[i]) > std::numeric_limits<T>::max();
      if (beyond == 0) continue;
      for (int col = rect.col; col < rect.col + rect.cols; ++col) {
        const T sample = grid.at(col, row);
        if (std::isinf(sample) && !grid.is_nodata(sample)) {
          throw Error(fmt::format(
              "height field: the sample at column {}, row {} is infinite; mark such samples as nodata", col, row));
        }
      }
    }
  }
}

#define SCARP_INSTANTIATE(T)                                                  \
  template TileExtents::TileExtents(const SampleGrid<T>&);                    \
  template void TileExtents::update(const SampleGrid<T>&, const SampleRect&); \
  template void refuse_infinite(const SampleGrid<T>&, const SampleRect&);
SCARP_INSTANTIATE(std::int16_t)
SCARP_INSTANTIATE(std::uint16_t)
SCARP_INSTANTIATE(float)
#undef SCARP_INSTANTIATE

}  // namespace scarp
