// SPDX-License-Identifier: MIT
#include "scarp/field/sample_extent.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// SampleGrid::is_nodata in three variants, so that each sample is tested no more than needed. kCompares: whether nodata
// samples affect comparisons; NaN does not.
struct NoHoles {
  static constexpr bool kCompares = false;
  bool operator()(auto) const { return false; }
};
// As an integer: a float comparison may raise a flag, which keeps compilers from hoisting it out of a branch.
struct IsNaN {
  static constexpr bool kCompares = false;
  static constexpr std::int32_t kMagnitude = 0x7fffffff, kInfinite = 0x7f800000;
  bool operator()(float sample) const { return (std::bit_cast<std::int32_t>(sample) & kMagnitude) > kInfinite; }
};
template <class T>
struct IsNodata {
  static constexpr bool kCompares = true;
  explicit IsNodata(T value) : nodata(value) {}
  bool operator()(T sample) const { return sample == nodata; }
  T nodata;
};
template <>
struct IsNodata<float> {
  static constexpr bool kCompares = true;
  // 0 and -0 are equal.
  explicit IsNodata(float value)
      : mask(value == 0 ? IsNaN::kMagnitude : -1), nodata(std::bit_cast<std::int32_t>(value) & mask) {}
  bool operator()(float sample) const {
    // No branch: both are evaluated.
    const int is_nodata = (std::bit_cast<std::int32_t>(sample) & mask) == nodata, is_nan = IsNaN()(sample);
    return (is_nodata | is_nan) != 0;
  }
  std::int32_t mask, nodata;
};

// Minimum, maximum and nodata count of each column of a tile. One result per column lets compilers vectorise: they must
// not reorder a single chain of float comparisons.
template <class T, int kSide>
class ColumnExtents {
 public:
  ColumnExtents() {
    std::fill(low_, low_ + kSide, std::numeric_limits<T>::max());
    std::fill(high_, high_ + kSide, std::numeric_limits<T>::lowest());
  }

  // Processes kRows rows at once, from `run` on: fewer passes over this state in memory.
  template <int kRows, class Nodata>
  void extend(const SampleGrid<T>& grid, const Nodata& is_nodata, const T* run, int cols) {
    for (int i = 0; i < cols; ++i) {
      T low = low_[i], high = high_[i];
      Count holes = holes_[i];
      for (int row = 0; row < kRows; ++row) {
        const T sample = run[row * grid.row_stride + i];
        const bool hole = is_nodata(sample), left_out = Nodata::kCompares && hole;
        const T lowest = left_out ? std::numeric_limits<T>::max() : sample;
        const T highest = left_out ? std::numeric_limits<T>::lowest() : sample;
        low = lowest < low ? lowest : low;
        high = highest > high ? highest : high;
        holes = static_cast<Count>(holes + hole);
      }
      low_[i] = low;
      high_[i] = high;
      holes_[i] = holes;
    }
  }

  SampleExtent merged(int cols, int rows) const {
    SampleExtent extent;
    for (int i = 0; i < cols; ++i) {
      extent.nodata += holes_[i];
      if (holes_[i] == rows) continue;
      extent.min = std::min(extent.min, static_cast<float>(low_[i]));
      extent.max = std::max(extent.max, static_cast<float>(high_[i]));
    }
    return extent;
  }

 private:
  using Count = std::conditional_t<sizeof(T) == 2, std::int16_t, std::int32_t>;  // as many lanes as the samples have
  T low_[kSide], high_[kSide];
  Count holes_[kSide] = {};
};

template <int kSide, class T, class Nodata>
SampleExtent extent_of_tile(const SampleGrid<T>& grid, const Nodata& is_nodata, const SampleRect& tile) {
  constexpr int kRows = 4;
  ColumnExtents<T, kSide> columns;
  const int end = tile.row + tile.rows;
  int row = tile.row;
  for (; row + kRows <= end; row += kRows) {
    columns.template extend<kRows>(grid, is_nodata, grid.row(row) + tile.col, tile.cols);
  }
  for (; row < end; ++row) columns.template extend<1>(grid, is_nodata, grid.row(row) + tile.col, tile.cols);
  return columns.merged(tile.cols, tile.rows);
}

template <int kSide, class T>
SampleExtent extent_of_tile(const SampleGrid<T>& grid, const SampleRect& tile) {
  if (!grid.has_holes) return extent_of_tile<kSide>(grid, NoHoles(), tile);
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(grid.nodata)) return extent_of_tile<kSide>(grid, IsNaN(), tile);
  }
  return extent_of_tile<kSide>(grid, IsNodata<T>(grid.nodata), tile);
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
    const int col = tile * kSide, row = tile_row * kSide;
    tiles_[begin + tile] =
        extent_of_tile<kSide>(grid, {col, row, std::min(kSide, grid.cols - col), std::min(kSide, grid.rows - row)});
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
      // No branch per sample: infinities are rare.
      int beyond = 0;
      const T* run = grid.row(row) + rect.col;
      for (int i = 0; i < rect.cols; ++i) beyond += std::abs(run[i]) > std::numeric_limits<T>::max();
      if (beyond == 0) continue;
      for (int col = rect.col; col < rect.col + rect.cols; ++col) {
        const T sample = grid.at(col, row);
        if (std::isinf(sample) && !grid.is_nodata(sample)) {
          throw Error(fmt::format(
              "height field: the sample at column {}, row {} is infinite (mark such samples as nodata)", col, row));
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
