// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
// Samples per side of a window of level 0, and of a coarser one in strides of the finer level: four windows side by
// side, 10 strides each.
constexpr int kWindow = 10, kParts = 4;
constexpr std::int64_t kRowsPerTask = 64;

using Maxima = HorizonGround::Maxima;
using CoarseMaxima = HorizonGround::CoarseMaxima;

// Maxima are higher by this, 16 roundings of the tallest height: horizon_scan.h says why.
float above_of(double tallest, float eye) { return 0x1p-20f * (static_cast<float>(tallest) + eye); }

// Maxima over 10 x 10 values, each at its north-west corner, for rows [begin, end) of memory: from those over 2, 4 and
// 8, first along rows, then along columns. Rows follow one another without a border. NaN is nothing.
void widen_rows(const LargeVector<float>& values, std::ptrdiff_t pitch, std::int64_t begin, std::int64_t end,
                float above, LargeVector<float>& maxima) {
  const auto all = static_cast<std::ptrdiff_t>(values.size());
  const std::int64_t last = std::min<std::int64_t>(end + kWindow - 1, (all + pitch - 1) / pitch);
  const auto widen = [](const float* from, std::ptrdiff_t step, float* out, std::ptrdiff_t count) {
    for (std::ptrdiff_t i = 0; i < count; ++i) out[i] = std::max(from[i], from[i + step]);
  };
  std::vector<float> along(static_cast<std::size_t>(pitch * (last - begin)));
  std::vector<float> a(static_cast<std::size_t>(pitch + kWindow), kNothing), b(a);
  for (std::int64_t y = begin; y < last; ++y) {
    const float* row = &values[static_cast<std::size_t>(y * pitch)];
    const std::ptrdiff_t count = std::min(pitch + kWindow - 1, all - y * pitch);
    for (std::ptrdiff_t x = 0; x < count; ++x) a[static_cast<std::size_t>(x)] = std::isnan(row[x]) ? kNothing : row[x];
    std::fill(a.begin() + count, a.end(), kNothing);
    // 2, 4 and 8 values; 10 are 8 and the 8 two further.
    widen(a.data(), 1, b.data(), pitch + 8), widen(b.data(), 2, a.data(), pitch + 6);
    widen(a.data(), 4, b.data(), pitch + 2);
    widen(b.data(), 2, &along[static_cast<std::size_t>((y - begin) * pitch)], pitch);
  }
  for (std::int64_t y = begin; y < std::min(end, last); ++y) {
    const std::ptrdiff_t count = std::min(pitch, all - y * pitch);
    float* out = &maxima[static_cast<std::size_t>(y * pitch)];
    for (std::int64_t r = y; r < std::min(y + kWindow, last); ++r) {
      const float* from = &along[static_cast<std::size_t>((r - begin) * pitch)];
      for (std::ptrdiff_t x = 0; x < count; ++x) out[x] = std::max(out[x], from[x]);
    }
    for (std::ptrdiff_t x = 0; x < count; ++x) out[x] += above;
  }
}

// The shape of a coarse level, without ground. Windows begin up to the length of a segment and a group before the
// field, and up to a group behind it.
Maxima without_ground(int cols, int rows, int level) {
  const int stride = HorizonGround::stride_of(level);
  Maxima to;
  to.first = -(HorizonGround::steps_of(level) + 2 * kGroupCols) / stride - 1;
  const int across = (cols + 2 * kGroupCols) / stride + 1 - to.first;
  const int down = (rows + 2 * kGroupCols) / stride + 1 - to.first;
  to.pitch = across + kGroupCols;  // vectors are loaded from any corner
  to.origin = -to.first * (to.pitch + 1);
  to.values.assign(static_cast<std::size_t>(to.pitch * (down + 1)), kNothing);
  return to;
}

Maxima coarser(const Maxima& finer, int cols, int rows, int level) {
  Maxima to = without_ground(cols, rows, level);
  const std::ptrdiff_t across = to.pitch - kGroupCols,
                       down = static_cast<std::ptrdiff_t>(to.values.size()) / to.pitch - 1;
  const std::ptrdiff_t finer_rows = static_cast<std::ptrdiff_t>(finer.values.size()) / finer.pitch;
  // The values of the finer level that make up a window, as far as they exist; beyond them there is no ground.
  const auto part = [&](std::ptrdiff_t corner, int i) { return 4 * (corner + to.first) + i * kWindow - finer.first; };
  parallel_for(down, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::ptrdiff_t y = begin; y < end; ++y) {
      for (std::ptrdiff_t x = 0; x < across; ++x) {
        float highest = kNothing;
        for (int i = 0; i < kParts; ++i) {
          const std::ptrdiff_t row = part(y, i);
          if (row < 0 || row >= finer_rows) continue;
          for (int j = 0; j < kParts; ++j) {
            const std::ptrdiff_t col = part(x, j);
            if (col >= 0 && col < finer.pitch)
              highest = std::max(highest, finer.values[static_cast<std::size_t>(row * finer.pitch + col)]);
          }
        }
        to.values[static_cast<std::size_t>(y * to.pitch + x)] = highest;
      }
    }
  });
  return to;
}

// The highest sample of each 4 x 4, in the places of level 1.
Maxima highest_of_blocks(const HorizonTiles& tiles, const Progress& progress) {
  Maxima to = without_ground(tiles.cols(), tiles.rows(), 1);
  constexpr int kSide = HorizonTiles::kSide, kBlock = 4;
  const auto fill = [&](std::int64_t begin, std::int64_t end) {
    float tile[HorizonTiles::kSamples];
    for (int down = static_cast<int>(begin); down < end; ++down) {
      for (int across = 0; across < tiles.across(); ++across) {
        tiles.read(across, down, tile);
        for (int i = 0; i < HorizonTiles::kSamples; ++i) {
          const int col = across * kSide + i % kSide, row = down * kSide + i / kSide;
          if (col >= tiles.cols() || row >= tiles.rows() || std::isnan(tile[i])) continue;
          float& block = to.values[static_cast<std::size_t>((row / kBlock) * to.pitch + col / kBlock + to.origin)];
          block = std::max(block, tile[i]);
        }
      }
    }
  };
  parallel_for(tiles.down(), 1, fill, progress);
  return to;
}

}  // namespace

int HorizonGround::levels_of(int cols, int rows) {
  int levels = 1;
  while (8 * steps_of(levels - 1) < std::max(cols, rows)) ++levels;
  return levels;
}

HorizonGround::HorizonGround(const HeightField& field, int sign, float eye, const Progress& progress)
    : heights_(field, sign) {
  const LargeVector<float>& heights = heights_.values();
  const std::ptrdiff_t pitch = heights_.pitch();
  finest_.first = -HorizonHeights::kMargin, finest_.pitch = pitch, finest_.origin = heights_.origin();
  finest_.values.assign(heights.size(), kNothing);
  const float above = above_of(heights_.tallest(), eye);
  parallel_for(
      rows() + 2 * HorizonHeights::kMargin, kRowsPerTask,
      [&](std::int64_t begin, std::int64_t end) { widen_rows(heights, pitch, begin, end, above, finest_.values); },
      progress);
  CoarseMaxima coarse;
  for (int level = 1; level < levels_of(cols(), rows()); ++level)
    coarse.push_back(coarser(level == 1 ? finest_ : coarse.back(), cols(), rows(), level));
  coarse_ = std::make_shared<const CoarseMaxima>(std::move(coarse));
}

HorizonGround::HorizonGround(HorizonHeights strip, float eye, std::shared_ptr<const CoarseMaxima> coarse,
                             LargeVector<float> memory)
    : heights_(std::move(strip)), coarse_(std::move(coarse)) {
  const LargeVector<float>& heights = heights_.values();
  const std::ptrdiff_t pitch = heights_.pitch(), all = static_cast<std::ptrdiff_t>(heights.size());
  finest_.pitch = pitch, finest_.origin = heights_.origin(), finest_.values = std::move(memory);
  finest_.values.assign(heights.size(), kNothing);
  // A few rows at once, whose windows then lie in the cache.
  const std::int64_t high = (all + pitch - 1) / pitch;
  for (std::int64_t begin = 0; begin < high; begin += kRowsPerTask)
    widen_rows(heights, pitch, begin, std::min(begin + kRowsPerTask, high), above_of(heights_.tallest(), eye),
               finest_.values);
}

HorizonGround::CoarseMaxima HorizonGround::coarse_maxima(const HorizonTiles& tiles, float eye,
                                                         const Progress& progress) {
  CoarseMaxima coarse;
  const int levels = levels_of(tiles.cols(), tiles.rows());
  if (levels == 1) return coarse;
  // A window of level 1 is one of 10 x 10 blocks.
  const Maxima blocks = highest_of_blocks(tiles, progress);
  coarse.push_back(without_ground(tiles.cols(), tiles.rows(), 1));
  const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(blocks.values.size()) / blocks.pitch;
  const float above = above_of(tiles.tallest(), eye);
  parallel_for(down, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    widen_rows(blocks.values, blocks.pitch, begin, end, above, coarse[0].values);
  });
  for (int level = 2; level < levels; ++level)
    coarse.push_back(coarser(coarse.back(), tiles.cols(), tiles.rows(), level));
  return coarse;
}

double HorizonGround::coarse_bytes(int cols, int rows) {
  // Twice those of level 1, which make up nearly all.
  constexpr double kMargin = 40, kCoarser = 4;
  return 2 * sizeof(float) * (cols / kCoarser + kMargin) * (rows / kCoarser + kMargin);
}

}  // namespace scarp
