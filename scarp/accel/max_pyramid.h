// SPDX-License-Identifier: MIT
// Maximum mipmap of a height field: for every block of 2^level x 2^level cells, a height that no point of the surface
// in it exceeds.
//
//   level 0: the cells themselves, the maximum of FOUR corner samples each (a bilinear surface stays below them). Not
//   stored:
//            who looks at a cell needs its samples anyway, and a quarter of the memory holds all other levels
//   level l: (n + 1) / 2 entries per side for n at level l-1, so odd sizes keep their last row and column
//   top:     one entry, on level 1 at least
//
// Holes count as the lowest value of the sample type. Entries have the sample type itself, so nothing is rounded.
//
// Source: A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering", I3D 2008 (maxima of cells instead of samples: those of samples do not bound what lies between them).
// Cost: 1/3 entry per cell; built in one pass over the samples and one over each level.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp {

/// One level of a pyramid over samples of type T: rows from north to south, no padding.
template <class T>
struct PyramidLevel {
  const T* data = nullptr;
  int cols = 0;
  int rows = 0;

  T at(int col, int row) const { return data[static_cast<std::ptrdiff_t>(row) * cols + col]; }
};

/// Immutable; cheap to copy (copies share the levels). Built from a field, it does not refer to it afterwards.
class MaxPyramid {
 public:
  /// Builds all levels, on all threads. A field without cells has a pyramid without levels.
  explicit MaxPyramid(const HeightField& field);

  /// Levels are 1 .. top_level(); 0 when the field has no cells.
  int top_level() const { return static_cast<int>(levels_.size()); }
  SampleType sample_type() const { return type_; }
  std::size_t bytes() const { return bytes_; }

  /// T must be the C++ type of sample_type(); l from 1 to top_level().
  template <class T>
  PyramidLevel<T> level(int l) const {
    const Level& level = levels_[static_cast<std::size_t>(l - 1)];
    return {static_cast<const T*>(data_.get()) + level.begin, level.cols, level.rows};
  }

  /// Where a level begins, in entries from the begin of level 1, and its size.
  struct Level {
    std::ptrdiff_t begin;
    int cols;
    int rows;
  };
  /// Levels 1, 2, ...
  const std::vector<Level>& levels() const { return levels_; }

 private:
  SampleType type_;
  std::vector<Level> levels_;
  std::shared_ptr<const void> data_;
  std::size_t bytes_ = 0;
};

}  // namespace scarp
