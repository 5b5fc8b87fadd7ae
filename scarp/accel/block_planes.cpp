// SPDX-License-Identifier: MIT
#include "scarp/accel/block_planes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "scarp/accel/height_encode.h"
#include "scarp/accel/plane_rows.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Range of the slopes, as a multiple of the mean height difference in blocks of 2 x 2 cells. A smaller range has finer
// steps but clamps more slopes (doc/dev/decisions/accel.md).
constexpr double kSteepest = 0.5;
// Maximum tilt over half a block, in codes, so that floats stay accurate.
constexpr double kMostTilt = 0x1p15;

// Range of codes for 16-bit samples, which rarely use the full range of their type: `range`, with room for edits on
// either side, at least an eighth of it. At most 2^7 codes per sample unit: vector code errs by about one code, less
// than samples can resolve.
constexpr double kLowestWhole = -0x1p15, kHighestWhole = 0x1p16;  // beyond all 16-bit samples
constexpr double kRoom = 1.25, kLeastSpan = 256;
// The step is the pyramid's step times a power of two, so conversions are exact.
HeightCode code_with_room(const SampleRange& range) {
  const double span = std::max(kRoom * (range.high - range.low), kLeastSpan);
  const double per_step = std::exp2(std::floor(std::log2(kTopCode / span)));
  return {std::floor((range.low + range.high - kTopCode / per_step) / 2), 1 / per_step, per_step};
}

// A row of samples as codes, columns [begin, begin + count); beyond the field the last one is repeated.
template <class T>
void codes_of(const SampleGrid<T>& grid, const HeightCode& code, int row, int begin, int count, float* codes) {
  const T* samples = grid.row(row);
  const auto one = [&](T sample) {
    return static_cast<float>((static_cast<double>(sample) - code.base) * code.per_step);
  };
  const int plain = std::min(count, grid.cols - begin);
  for (int i = 0; i < plain; ++i) codes[i] = one(samples[begin + i]);
  if (plain == count) return;
  codes[plain] = grid.cell_cols == grid.cols ? one(samples[0]) : codes[plain - 1];
  std::fill(codes + plain + 1, codes + count, codes[plain]);
}

template <class T>
std::vector<T> padded_row(int count) {
  return std::vector<T>(static_cast<std::size_t>(count) + kPlaneRowPadding);
}

// Adds planes to a row of blocks in a padded copy, because vectors write beyond its end.
template <class Fit>
void fit_row(std::uint32_t* blocks, int count, std::vector<std::uint32_t>& padded, const Fit& fit) {
  std::copy_n(blocks, count, padded.data());
  fit(static_cast<std::size_t>(count), padded.data());
  std::copy_n(padded.data(), count, blocks);
}

template <class T>
void fit_first(const SampleGrid<T>& grid, const HeightCode& code, const PlaneFit& fit, const PyramidLevel& level,
               const CellBox& part, std::uint32_t* blocks) {
  const int width = part.col_end - part.col_begin, samples = 2 * width + 1;
  parallel_for(part.row_end - part.row_begin, rows_per_piece(width), [&](std::int64_t first, std::int64_t last) {
    auto north = padded_row<float>(samples), middle = north, south = north;
    auto padded = padded_row<std::uint32_t>(width);
    const auto load = [&](int row, std::vector<float>& to) {
      codes_of(grid, code, row, 2 * part.col_begin, samples, to.data());
    };
    const int begin = part.row_begin + static_cast<int>(first), end = part.row_begin + static_cast<int>(last);
    load(2 * begin, south);
    for (int row = begin; row < end; ++row) {
      std::swap(north, south);
      const int next = grid.south(2 * row);
      load(next, middle);
      // Beyond an odd end the last row is repeated.
      load(2 * row + 1 < grid.cell_rows ? grid.south(next) : next, south);
      fit_row(blocks + static_cast<std::ptrdiff_t>(row) * level.cols + part.col_begin, width, padded,
              [&](std::size_t count, std::uint32_t* to) {
                fit_first_planes(fit, north.data(), middle.data(), south.data(), count, to);
              });
    }
  });
}

void fit_coarser(const PlaneFit& fit, const PyramidLevel& finer, const PyramidLevel& level, const CellBox& part,
                 std::uint32_t* blocks) {
  const int width = part.col_end - part.col_begin;
  parallel_for(part.row_end - part.row_begin, rows_per_piece(width), [&](std::int64_t first, std::int64_t last) {
    auto north = padded_row<std::uint32_t>(2 * width), south = north, padded = padded_row<std::uint32_t>(width);
    const int begin = 2 * part.col_begin, children = std::min(2 * width, finer.cols - begin);
    // Beyond an odd end the last child is repeated.
    const auto load = [&](int row, std::vector<std::uint32_t>& to) {
      std::copy_n(blocks + finer.begin + static_cast<std::ptrdiff_t>(row) * finer.cols + begin, children, to.data());
      if (children < 2 * width) to[static_cast<std::size_t>(children)] = to[static_cast<std::size_t>(children - 1)];
    };
    for (int row = part.row_begin + static_cast<int>(first); row < part.row_begin + last; ++row) {
      load(2 * row, north);
      load(std::min(2 * row + 1, finer.rows - 1), south);
      fit_row(blocks + level.begin + static_cast<std::ptrdiff_t>(row) * level.cols + part.col_begin, width, padded,
              [&](std::size_t count, std::uint32_t* to) {
                fit_coarser_planes(fit, north.data(), south.data(), count, to);
              });
    }
  });
}

}  // namespace

void BlockPlanes::build(const HeightField& field, const Blocks& blocks, const std::optional<SampleRange>& reserve) {
  exist_ = !blocks.levels.empty() && field.nodata_count() == 0 &&
           static_cast<std::size_t>(blocks.levels.back().begin) < kMostEntries;
  if (!exist_) return;
  set_scale(field, blocks, reserve);
  fit(field, blocks, {0, 0, field.cell_cols(), field.cell_rows()});
}

void BlockPlanes::update(const HeightField& field, const Blocks& blocks, const CellBox& changed) {
  const bool fits = field.nodata_count() == 0 && field.min_sample() >= range_.low && field.max_sample() <= range_.high;
  if (exist_ && fits) {
    for (const CellBox& part : parts_inside(field, changed)) fit(field, blocks, part);
    return;
  }
  build(field, blocks, std::nullopt);
}

void BlockPlanes::set_scale(const HeightField& field, const Blocks& blocks, const std::optional<SampleRange>& reserve) {
  if (field.sample_type() == SampleType::float32) {
    // The pyramid is rebuilt when samples leave the range of its code.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    range_ = {-kInfinity, kInfinity};
    code_ = blocks.code;
  } else {
    SampleRange range{field.min_sample(), field.max_sample()};
    if (reserve) {
      range.low = std::min(range.low, std::max(reserve->low, kLowestWhole));
      range.high = std::max(range.high, std::min(reserve->high, kHighestWhole));
    }
    code_ = code_with_room(range);
    range_ = {code_.base, code_.base + code_.step * kTopCode};
  }
  scale_ = static_cast<float>(blocks.code.step * code_.per_step);
  shift_ = static_cast<float>((blocks.code.base - code_.base) * code_.per_step);
  const PyramidLevel& first = blocks.levels.front();
  std::atomic<std::int64_t> sum = 0;
  parallel_for(first.rows, rows_per_piece(first.cols), [&](std::int64_t begin, std::int64_t end) {
    std::int64_t part = 0;
    for (std::int64_t i = begin * first.cols; i < end * first.cols; ++i) {
      part += static_cast<int>(blocks.maxima[i] & 0xffff) - blocks.minima[i];
    }
    sum += part;
  });
  const double count = static_cast<double>(first.cols) * first.rows;
  const double mean = static_cast<double>(sum) / count * blocks.code.step * code_.per_step;
  unit_ = static_cast<float>(std::clamp(kSteepest * mean, 1.0, kMostTilt) / kMostSteps);
}

void BlockPlanes::fit(const HeightField& field, const Blocks& blocks, const CellBox& changed) {
  CellBox part = changed;
  for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
    part = coarser(part);
    // Distance in cells from the middle of a child to its border; for a block it is twice that.
    const auto half = static_cast<float>(std::ldexp(0.5, static_cast<int>(l)));
    const double most = std::min(static_cast<double>(kMostSteps), kMostTilt / static_cast<double>(2 * half * unit_));
    const PlaneFit plane_fit{unit_, half, static_cast<std::int32_t>(most), scale_, shift_};
    if (l == 0) {
      field.visit([&](const auto& grid) { fit_first(grid, code_, plane_fit, blocks.levels[0], part, blocks.maxima); });
    } else {
      fit_coarser(plane_fit, blocks.levels[l - 1], blocks.levels[l], part, blocks.maxima);
    }
  }
}

double BlockPlanes::height(std::uint32_t block, int level, double x, double y) const {
  const auto slope = [block](int first) {
    return static_cast<std::int32_t>(block << (32 - kSlopeBits - first)) >> (32 - kSlopeBits);
  };
  const double unit = static_cast<double>(unit_), half = std::ldexp(1, level - 1);
  const double maximum =
      static_cast<double>(block & 0xffff) * static_cast<double>(scale_) + static_cast<double>(shift_);
  const double depth = (block >> (16 + 2 * kSlopeBits)) * static_cast<double>(kDepthUnits) * unit * half;
  return code_.base + code_.step * (maximum - depth + unit * (slope(16) * x + slope(16 + kSlopeBits) * y));
}

}  // namespace scarp
