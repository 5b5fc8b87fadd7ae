// SPDX-License-Identifier: MIT
#include "scarp/analysis/node_maxima.h"

#include <algorithm>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr float kNone = -std::numeric_limits<float>::infinity();

int blocks(int nodes, int side) { return (nodes + side - 1) / side; }

}  // namespace

NodeMaxima::NodeMaxima(const HeightField& field) : field_(field) {
  const int rows = blocks(field.rows(), kFine);
  fine_.cols = blocks(field.cols(), kFine);
  fine_.highest.assign(static_cast<std::size_t>(fine_.cols) * rows, kNone);
  field.visit([&](const auto& grid) {
    parallel_for(rows, 1, [&](std::int64_t begin, std::int64_t end) {
      for (int row = static_cast<int>(begin) * kFine; row < std::min(static_cast<int>(end) * kFine, grid.rows); ++row)
        for (int col = 0; col < grid.cols; ++col) {
          const auto sample = grid.at(col, row);
          // Samples are 16-bit integers or floats: all are floats.
          if (grid.is_nodata(sample)) continue;
          float& highest = fine_.highest[static_cast<std::size_t>(row / kFine) * fine_.cols + col / kFine];
          highest = std::max(highest, static_cast<float>(sample));
        }
    });
  });
  constexpr int kRatio = kCoarse / kFine;
  coarse_.cols = blocks(fine_.cols, kRatio);
  coarse_.highest.assign(static_cast<std::size_t>(coarse_.cols) * blocks(rows, kRatio), kNone);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < fine_.cols; ++col) {
      float& highest = coarse_.highest[static_cast<std::size_t>(row / kRatio) * coarse_.cols + col / kRatio];
      highest = std::max(highest, fine_.highest[static_cast<std::size_t>(row) * fine_.cols + col]);
    }
}

double NodeMaxima::highest(int side, int col, int row, int col_end, int row_end) const {
  const Level& blocks_of = level(side);
  float most = kNone;
  for (int r = row / side; r <= row_end / side; ++r)
    for (int c = col / side; c <= col_end / side; ++c)
      most = std::max(most, blocks_of.highest[static_cast<std::size_t>(r) * blocks_of.cols + c]);
  return most == kNone ? -std::numeric_limits<double>::infinity()
                       : field_.height_from_sample(static_cast<double>(most));
}

}  // namespace scarp
