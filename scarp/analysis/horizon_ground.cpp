// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
// Samples per side of a window of level 0, and of a coarser one in strides of the finer level: four windows side by
// side, 10 strides each.
constexpr int kWindow = 10, kParts = 4;
constexpr std::int64_t kRowsPerTask = 64;

}  // namespace

HorizonGround::HorizonGround(const HeightField& field, int sign, float eye, const Progress& progress)
    : heights_(field, sign) {
  int levels = 1;
  while (8 * steps_of(levels - 1) < std::max(cols(), rows())) ++levels;
  levels_.resize(static_cast<std::size_t>(levels));
  // Maxima are higher by this, 16 roundings of the tallest height: horizon_scan.h says why.
  build_first(0x1p-20f * (static_cast<float>(heights_.tallest()) + eye), progress);
  for (int level = 1; level < levels; ++level) build_coarser(level);
}

// Maxima over 10 samples from those over 2, 4 and 8, first along rows, then along columns.
void HorizonGround::build_first(float above, const Progress& progress) {
  Maxima& to = levels_[0];
  const LargeVector<float>& heights = heights_.values();
  const std::ptrdiff_t pitch = heights_.pitch();
  to.first = -HorizonHeights::kMargin, to.pitch = pitch;
  const std::int64_t high = rows() + 2 * HorizonHeights::kMargin;
  to.values.assign(heights.size(), kNothing);
  const auto widen = [](const float* from, std::ptrdiff_t step, float* out, std::ptrdiff_t count) {
    for (std::ptrdiff_t i = 0; i < count; ++i) out[i] = std::max(from[i], from[i + step]);
  };
  parallel_for(
      high, kRowsPerTask,
      [&](std::int64_t begin, std::int64_t end) {
        const std::int64_t last = std::min(end + kWindow - 1, high);
        std::vector<float> along(static_cast<std::size_t>(pitch * (last - begin)));
        std::vector<float> a(static_cast<std::size_t>(pitch + kWindow), kNothing), b(a);
        for (std::int64_t y = begin; y < last; ++y) {
          const float* row = &heights[static_cast<std::size_t>(y * pitch)];
          for (std::ptrdiff_t x = 0; x < pitch; ++x)
            a[static_cast<std::size_t>(x)] = std::isnan(row[x]) ? kNothing : row[x];
          // 2, 4 and 8 samples; 10 are 8 and the 8 two further.
          widen(a.data(), 1, b.data(), pitch), widen(b.data(), 2, a.data(), pitch);
          widen(a.data(), 4, b.data(), pitch);
          widen(b.data(), 2, &along[static_cast<std::size_t>((y - begin) * pitch)], pitch);
        }
        for (std::int64_t y = begin; y < end; ++y) {
          float* out = &to.values[static_cast<std::size_t>(y * pitch)];
          for (std::int64_t r = y; r < std::min(y + kWindow, last); ++r) {
            const float* from = &along[static_cast<std::size_t>((r - begin) * pitch)];
            for (std::ptrdiff_t x = 0; x < pitch; ++x) out[x] = std::max(out[x], from[x]);
          }
          for (std::ptrdiff_t x = 0; x < pitch; ++x) out[x] += above;
        }
      },
      progress);
}

void HorizonGround::build_coarser(int level) {
  const Maxima& finer = levels_[static_cast<std::size_t>(level) - 1];
  Maxima& to = levels_[static_cast<std::size_t>(level)];
  const int stride = stride_of(level);
  // Windows begin up to the length of a segment and a group before the field, and up to a group behind it.
  to.first = -(steps_of(level) + 2 * kGroupCols) / stride - 1;
  const int across = (cols() + 2 * kGroupCols) / stride + 1 - to.first;
  const int down = (rows() + 2 * kGroupCols) / stride + 1 - to.first;
  to.pitch = across + kGroupCols;  // vectors are loaded from any corner
  to.values.assign(static_cast<std::size_t>(to.pitch * (down + 1)), kNothing);
  const std::ptrdiff_t finer_rows = static_cast<std::ptrdiff_t>(finer.values.size()) / finer.pitch;
  // The values of the finer level that make up a window, as far as they exist; beyond them there is no ground.
  const auto part = [&](int corner, int i) {
    return std::ptrdiff_t{4} * (corner + to.first) + i * kWindow - finer.first;
  };
  parallel_for(down, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < across; ++x) {
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
}

}  // namespace scarp
