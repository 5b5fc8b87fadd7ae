// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_tiles.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "scarp/analysis/horizon_heights.h"
#include "scarp/base/array_files.h"
#include "scarp/base/parallel.h"

namespace scarp {

HorizonTiles::HorizonTiles(const HeightField& field, int sign, const Progress& progress)
    : cols_(field.cols()), rows_(field.rows()), sign_(sign), tallest_(tallest_of(field)) {
  const auto all = static_cast<std::size_t>(across()) * static_cast<std::size_t>(down()) * kSamples;
  values_ = std::make_unique_for_overwrite<float[]>(all);
  constexpr int kTiles = 16;  // read side by side
  field.visit([&](const auto& grid) {
    using Sample = std::decay_t<decltype(grid.at(0, 0))>;
    const auto fill = [&](std::int64_t begin, std::int64_t end) {
      std::vector<Sample> samples(static_cast<std::size_t>(kTiles * kSide));
      std::vector<float> heights(static_cast<std::size_t>(kTiles * kSamples));
      for (std::int64_t down = begin; down < end; ++down) {
        for (int first = 0; first < across(); first += kTiles) {
          std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
          const int count = std::min(kTiles, across() - first), col = first * kSide;
          const int width = std::min(count * kSide, cols_ - col);
          for (int r = 0; r < kSide; ++r) {
            const std::int64_t row = down * kSide + r;
            if (row >= rows_) break;
            read_array(samples.data(), grid.data + row * grid.row_stride + col,
                       static_cast<std::size_t>(width) * sizeof(Sample));
            for (int x = 0; x < width; ++x) {
              const Sample sample = samples[static_cast<std::size_t>(x)];
              if (grid.has_holes && grid.is_nodata(sample)) continue;
              heights[static_cast<std::size_t>(x / kSide * kSamples + r * kSide + x % kSide)] =
                  static_cast<float>(sign * field.height_from_sample(static_cast<double>(sample)));
            }
          }
          write_array(tile(first, static_cast<int>(down)), heights.data(),
                      static_cast<std::size_t>(count * kSamples) * sizeof(float));
        }
      }
    };
    parallel_for(down(), 1, fill, progress);
  });
}

void HorizonTiles::read(int col, int row, float* samples) const {
  read_array(samples, tile(col, row), kSamples * sizeof(float));
}

void HorizonTiles::read_row(int col, int row, int count, float* samples) const {
  for (int at = col; at < col + count;) {
    const int next = std::min((at / kSide + 1) * kSide, col + count);
    const float* from = tile(at / kSide, row / kSide) + row % kSide * kSide + at % kSide;
    read_array(samples + (at - col), from, static_cast<std::size_t>(next - at) * sizeof(float));
    at = next;
  }
}

void HorizonTiles::read_transposed(int col, int row, float* samples) const {
  float upright[kSamples];
  read(row, col, upright);
  constexpr int kBlock = 16;  // a line of the cache
  for (int y = 0; y < kSide; y += kBlock)
    for (int x = 0; x < kSide; x += kBlock)
      for (int i = y; i < y + kBlock; ++i)
        for (int j = x; j < x + kBlock; ++j) samples[j * kSide + i] = upright[i * kSide + j];
}

}  // namespace scarp
