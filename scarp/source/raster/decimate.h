// SPDX-License-Identifier: MIT
// Reduction of rasters too large to be shown sample by sample: averages of blocks, with the extremes kept.
//
//   n = ceil(N / k)   samples on a side of N; sample i is the average of the valid ones in the block of columns
//                     [i N / n, (i + 1) N / n), rounded down, so that it is displaced by less than half a column
//   k                 the smallest whole number whose result is within the caller's limit
//   a hole            where less than half of a block is valid
//   the extremes      the blocks with the lowest and the highest sample take exactly these values, so that relief,
//                     colour ramps and legends stay true
//
// One pass over the file, with memory for the result and for the blocks of the rows being read.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Size of a reduced raster.
struct DecimatedSize {
  int cols = 0;
  int rows = 0;
  int block = 1;  ///< k
};

/// Returns the size with the smallest k that has at most `most` (>= 4) samples. Sides of two or more samples keep at
/// least two, so that the field has cells.
DecimatedSize decimated_size(int cols, int rows, std::int64_t most);

/// The lowest and highest of a set of samples; low > high if it is empty.
struct SampleEnds {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

/// Averages blocks of samples of one type: std::int16_t, std::uint16_t or float.
template <class T>
class Decimator {
 public:
  /// Samples equal to `nodata` are holes, as is NaN.
  Decimator(int cols, int rows, int out_cols, int out_rows, std::optional<T> nodata);

  /// Adds a rectangle of rect.cols * rect.rows samples, row by row, on all threads. Samples that are never added are
  /// holes. None of its rows may have been closed.
  void add(const RasterWindow& rect, const T* samples);
  /// States that no samples of rows before `end` will be added. Rows must be closed in order.
  void close_rows(int end);
  /// Returns the result, out_cols * out_rows samples; all rows must be closed. Holes are `nodata`, or NaN. Extremes in
  /// `known` that exceed those of the samples replace them.
  std::vector<T> finish(const SampleEnds& known = {});

 private:
  // An output row whose blocks are not complete.
  struct Row {
    std::vector<double> sum;
    std::vector<std::int64_t> valid;
    SampleEnds ends;
    int low_col = 0, high_col = 0;  // columns of the blocks with the extremes
  };
  struct Place {
    int col = 0, row = 0;
  };

  std::int64_t first_col(int out_col) const { return std::int64_t{out_col} * cols_ / out_cols_; }
  std::int64_t first_row(int out_row) const { return std::int64_t{out_row} * rows_ / out_rows_; }
  int out_col_of(int col) const;
  int out_row_of(int row) const;
  void add_to_row(Row& row, const RasterWindow& rect, const T* samples, std::int64_t first, std::int64_t count);
  void write(const Row& row);
  T average(double sum, std::int64_t valid) const;
  T& at(const Place& place) {
    return out_[static_cast<std::size_t>(place.row) * static_cast<std::size_t>(out_cols_) +
                static_cast<std::size_t>(place.col)];
  }
  Place beside(const Place& place) const;

  int cols_, rows_, out_cols_, out_rows_;
  std::optional<T> nodata_;
  T hole_;
  int next_row_ = 0;       // first output row that is not written
  std::vector<Row> open_;  // output rows next_row_, next_row_ + 1, ...
  std::vector<T> out_;
  SampleEnds ends_;
  Place low_, high_;
};

}  // namespace scarp
