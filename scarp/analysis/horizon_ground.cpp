// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_ground.h"

#include <algorithm>
#include <cmath>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr int kFirstWindow = HorizonGround::kFirstSteps + 2;
constexpr std::int64_t kRowsPerTask = 64;

int window_needed(int level) {
  const int quantised = HorizonGround::stride_of(level) - 1;
  return HorizonGround::steps_of(level) + 2 + quantised + (level >= 2 ? kGroupCols - 1 : 0);
}

// An odd number of cache lines: rows at a power of two would share the same sets of the cache.
std::ptrdiff_t odd_lines(std::ptrdiff_t samples) {
  constexpr std::ptrdiff_t kLine = 16;
  return ((samples + kLine - 1) / kLine | 1) * kLine;
}

}  // namespace

HorizonGround::HorizonGround(const HeightField& field, int sign, float eye, const Progress& progress)
    : cols_(field.cols()), rows_(field.rows()), pitch_(odd_lines(field.cols() + 2 * kMarginCols)) {
  heights_.assign(static_cast<std::size_t>(pitch_ * (rows_ + 2 * kMarginRows)),
                  std::numeric_limits<float>::quiet_NaN());
  field.visit([&](const auto& grid) {
    parallel_for(rows_, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
      for (int row = static_cast<int>(begin); row < end; ++row) {
        float* to = &heights_[place(0, row)];
        for (int col = 0; col < cols_; ++col) {
          const auto sample = grid.at(col, row);
          if (!(grid.has_holes && grid.is_nodata(sample)))
            to[col] = static_cast<float>(sign * field.height_from_sample(static_cast<double>(sample)));
        }
      }
    });
  });
  float tallest = 0;
  for (const float h : heights_) tallest = std::max(tallest, std::abs(h));
  above_ = 0x1p-20f * (tallest + eye);
  int levels = 1;
  while (8 * steps_of(levels - 1) < std::max(cols_, rows_)) ++levels;
  levels_.resize(static_cast<std::size_t>(levels)), windows_.resize(levels_.size());
  build_first(progress);
  for (int level = 1; level < levels; ++level) build_coarser(level);
}

// Maxima over 10 samples from those over 2, 4 and 8, first along rows, then along columns.
void HorizonGround::build_first(const Progress& progress) {
  Maxima& to = levels_[0];
  windows_[0] = kFirstWindow;
  to.first = -kMarginRows, to.pitch = pitch_;
  const int high = rows_ + 2 * kMarginRows;
  // Corners at -kMarginRows: the margin of columns is wider, and the first columns of a row stay unused.
  to.values.assign(static_cast<std::size_t>(pitch_ * high), kNothing);
  std::vector<float> along(to.values.size(), kNothing);
  constexpr int kOff = kMarginCols - kMarginRows;
  const auto widen = [](const float* from, std::ptrdiff_t step, float* out, std::ptrdiff_t count) {
    for (std::ptrdiff_t i = 0; i < count; ++i) out[i] = std::max(from[i], from[i + step]);
  };
  const std::ptrdiff_t wide = pitch_ - kOff;  // corners of a row
  parallel_for(
      high, kRowsPerTask,
      [&](std::int64_t begin, std::int64_t end) {
        std::vector<float> a(static_cast<std::size_t>(pitch_ + 16), kNothing), b(a);
        for (std::int64_t y = begin; y < end; ++y) {
          const float* row = &heights_[static_cast<std::size_t>(y * pitch_ + kOff)];
          for (std::ptrdiff_t x = 0; x < wide; ++x)
            a[static_cast<std::size_t>(x)] = std::isnan(row[x]) ? kNothing : row[x];
          widen(a.data(), 1, b.data(), wide), widen(b.data(), 2, a.data(), wide), widen(a.data(), 4, b.data(), wide);
          // b: 8 samples; 10 are 8 and the 8 two further.
          widen(b.data(), 2, &along[static_cast<std::size_t>(y * pitch_)], wide);
        }
      },
      progress);
  parallel_for(high, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t y = begin; y < end; ++y) {
      float* out = &to.values[static_cast<std::size_t>(y * pitch_)];
      for (std::int64_t r = y; r < std::min<std::int64_t>(y + kFirstWindow, high); ++r) {
        const float* from = &along[static_cast<std::size_t>(r * pitch_)];
        for (std::ptrdiff_t x = 0; x < wide; ++x) out[x] = std::max(out[x], from[x]);
      }
      for (std::ptrdiff_t x = 0; x < wide; ++x) out[x] += above_;
    }
  });
}

void HorizonGround::build_coarser(int level) {
  const Maxima& finer = levels_[static_cast<std::size_t>(level) - 1];
  const int finer_stride = stride_of(level - 1), finer_window = windows_[static_cast<std::size_t>(level) - 1];
  const int stride = stride_of(level), needed = window_needed(level);
  // Corners of finer windows that cover this one, in their strides.
  std::vector<int> offsets{0};
  const int most = finer_window / finer_stride;
  int covered = finer_window;
  for (; covered < needed; covered = offsets.back() * finer_stride + finer_window)
    offsets.push_back(offsets.back() + most);
  Maxima& to = levels_[static_cast<std::size_t>(level)];
  windows_[static_cast<std::size_t>(level)] = covered;
  to.first = -(steps_of(level) + 2 * kGroupCols) / stride - 1;
  const int across = (cols_ + 2 * kGroupCols) / stride + 1 - to.first,
            down = (rows_ + 2 * kGroupCols) / stride + 1 - to.first;
  // Vectors are loaded from any corner.
  to.pitch = across + kGroupCols;
  to.values.assign(static_cast<std::size_t>(to.pitch * (down + 1)), kNothing);
  const std::ptrdiff_t finer_rows = static_cast<std::ptrdiff_t>(finer.values.size()) / finer.pitch;
  parallel_for(down, kRowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < across; ++x) {
        float highest = kNothing;
        for (const int dy : offsets) {
          const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y + to.first) * 4 + dy - finer.first;
          if (row < 0 || row >= finer_rows) continue;
          for (const int dx : offsets) {
            const std::ptrdiff_t col = static_cast<std::ptrdiff_t>(x + to.first) * 4 + dx - finer.first;
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
