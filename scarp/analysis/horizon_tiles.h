// SPDX-License-Identifier: MIT
// Private to scarp/analysis: the heights of a field as floats, in square tiles, for rasters beyond the memory of a run.
// The array may lie in a file (array_files.h); it is read a tile at a time, in either direction.
#pragma once

#include <cstddef>
#include <memory>

#include "scarp/base/progress.h"
#include "scarp/field/height_field.h"

namespace scarp {

class HorizonTiles {
 public:
  static constexpr int kSide = 64, kSamples = kSide * kSide;

  /// `sign`: as of HorizonHeights. Throws Interrupted.
  HorizonTiles(const HeightField& field, int sign, const Progress& progress);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int sign() const { return sign_; }
  double tallest() const { return tallest_; }
  int across() const { return (cols_ + kSide - 1) / kSide; }
  int down() const { return (rows_ + kSide - 1) / kSide; }

  /// Copies the tile of these samples, (kSide * col, kSide * row) and on, in rows of kSide; NaN on holes and beyond the
  /// field.
  void read(int col, int row, float* samples) const;
  /// Copies samples of a row of the field.
  void read_row(int col, int row, int count, float* samples) const;
  /// As read(), with rows and columns exchanged.
  void read_transposed(int col, int row, float* samples) const;

 private:
  float* tile(int col, int row) const {
    return values_.get() + (static_cast<std::ptrdiff_t>(row) * across() + col) * kSamples;
  }

  int cols_, rows_, sign_;
  double tallest_;
  std::unique_ptr<float[]> values_;
};

/// The samples of tiles by column and row, for code that follows a line: keeps the tile that it read last.
class HorizonSamples {
 public:
  explicit HorizonSamples(const HorizonTiles& tiles)
      : tiles_(tiles), samples_(std::make_unique_for_overwrite<float[]>(HorizonTiles::kSamples)) {}

  /// The sample must exist; NaN on a hole.
  float at(int col, int row) {
    constexpr int kSide = HorizonTiles::kSide;
    if (col / kSide != col_ || row / kSide != row_)
      col_ = col / kSide, row_ = row / kSide, tiles_.read(col_, row_, samples_.get());
    return samples_[static_cast<std::size_t>(row % kSide * kSide + col % kSide)];
  }

 private:
  const HorizonTiles& tiles_;
  int col_ = -1, row_ = -1;
  std::unique_ptr<float[]> samples_;
};

}  // namespace scarp
