// SPDX-License-Identifier: MIT
#include "scarp/accel/block_planes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scarp/accel/height_encode.h"
#include "scarp/accel/plane_rows.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// The slopes' range: at most this many times the mean slope, so that one cliff does not coarsen all.
constexpr double kTimesMean = 8;
// Codes of tilt over half a block: floats stay accurate.
constexpr double kMostTilt = 0x1p15;

// From codes of a pyramid's maxima to codes of planes, rounded up.
class FlatCodes {
 public:
  FlatCodes(const HeightCode& from, const HeightCode& to) {
    const bool same = from.base == to.base && from.step == to.step;
    scale_ = same ? 1 : from.step * to.per_step;
    shift_ = same ? 0 : (from.base - to.base) * to.per_step + 1 + kClear;
  }
  void convert(const std::uint16_t* maxima, int count, float* flat) const {
    for (int i = 0; i < count; ++i) {
      const double code = std::min(scale_ * maxima[i] + shift_, kTopCode);
      flat[i] = static_cast<float>(static_cast<int>(code));
    }
  }

 private:
  double scale_, shift_;
};

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

template <class T>
void fit_first(const SampleGrid<T>& grid, const HeightCode& code, const FlatCodes& flat_codes, const PlaneFit& fit,
               const PyramidLevel& level, const CellBox& part, const std::uint16_t* maxima, std::uint32_t* entries) {
  const int width = part.col_end - part.col_begin, samples = 2 * width + 1;
  parallel_for(part.row_end - part.row_begin, rows_per_piece(width), [&](std::int64_t first, std::int64_t last) {
    auto north = padded_row<float>(samples), middle = north, south = north, flat = padded_row<float>(width);
    auto row_entries = padded_row<std::uint32_t>(width);
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
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row) * level.cols + part.col_begin;
      flat_codes.convert(maxima + at, width, flat.data());
      fit_first_planes(fit, north.data(), middle.data(), south.data(), flat.data(), static_cast<std::size_t>(width),
                       row_entries.data());
      std::copy_n(row_entries.data(), width, entries + at);
    }
  });
}

void fit_coarser(const FlatCodes& flat_codes, const PlaneFit& fit, const PyramidLevel& finer, const PyramidLevel& level,
                 const CellBox& part, const std::uint16_t* maxima, std::uint32_t* all) {
  const int width = part.col_end - part.col_begin;
  parallel_for(part.row_end - part.row_begin, rows_per_piece(width), [&](std::int64_t first, std::int64_t last) {
    auto north = padded_row<std::uint32_t>(2 * width), south = north, row_entries = padded_row<std::uint32_t>(width);
    auto flat = padded_row<float>(width);
    const int begin = 2 * part.col_begin, children = std::min(2 * width, finer.cols - begin);
    // Beyond an odd end the last child is repeated.
    const auto load = [&](int row, std::vector<std::uint32_t>& to) {
      std::copy_n(all + finer.begin + static_cast<std::ptrdiff_t>(row) * finer.cols + begin, children, to.data());
      if (children < 2 * width) to[static_cast<std::size_t>(children)] = to[static_cast<std::size_t>(children - 1)];
    };
    for (int row = part.row_begin + static_cast<int>(first); row < part.row_begin + last; ++row) {
      load(2 * row, north);
      load(std::min(2 * row + 1, finer.rows - 1), south);
      const std::ptrdiff_t at = level.begin + static_cast<std::ptrdiff_t>(row) * level.cols + part.col_begin;
      flat_codes.convert(maxima + at, width, flat.data());
      fit_coarser_planes(fit, north.data(), south.data(), flat.data(), static_cast<std::size_t>(width),
                         row_entries.data());
      std::copy_n(row_entries.data(), width, all + at);
    }
  });
}

}  // namespace

void BlockPlanes::build(const HeightField& field, const std::vector<PyramidLevel>& levels,
                        const BlockExtremes& extremes, const std::optional<SampleRange>& reserve) {
  entries_.reset();
  count_ = 0;
  if (levels.empty() || field.nodata_count() > 0) return;
  const auto count = static_cast<std::size_t>(levels.back().begin + 1);
  if (count > kMostEntries) return;
  count_ = count;
  // Not zeroed: the thread that builds an entry writes it first.
  entries_.reset(new std::uint32_t[count_]);
  set_scale(field, levels.front(), extremes, reserve);
  fit(field, levels, extremes, {0, 0, field.cell_cols(), field.cell_rows()});
}

void BlockPlanes::update(const HeightField& field, const std::vector<PyramidLevel>& levels,
                         const BlockExtremes& extremes, const CellBox& changed) {
  if (entries_ && field.nodata_count() == 0 && field.max_sample() <= highest_) {
    for (const CellBox& part : parts_inside(field, changed)) fit(field, levels, extremes, part);
    return;
  }
  // With room for the next edits.
  const double low = field.min_sample(), high = field.max_sample(), room = (high - low) / 8;
  build(field, levels, extremes, SampleRange{low - room, high + room});
}

void BlockPlanes::set_scale(const HeightField& field, const PyramidLevel& first, const BlockExtremes& extremes,
                            const std::optional<SampleRange>& reserve) {
  const SampleRange range = code_range(field, reserve);
  highest_ = range.high;
  // Finer than those of the pyramid for 16-bit samples, which rarely use their whole range.
  code_ = height_code(SampleType::float32, range);
  const auto count = static_cast<std::int64_t>(first.cols) * first.rows;
  std::int64_t sum = 0, most = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const int relief = extremes.maxima[i] - extremes.minima[i];
    sum += relief, most = std::max<std::int64_t>(most, relief);
  }
  const double mean = static_cast<double>(sum) / static_cast<double>(count);
  const double steepest = std::min(static_cast<double>(most), kTimesMean * mean) * extremes.code.step * code_.per_step;
  unit_ = static_cast<float>(std::clamp(steepest, 1.0, kMostTilt) / kMostSteps);
}

void BlockPlanes::fit(const HeightField& field, const std::vector<PyramidLevel>& levels, const BlockExtremes& extremes,
                      const CellBox& changed) {
  CellBox part = changed;
  const FlatCodes flat_codes(extremes.code, code_);
  for (std::size_t l = 0; l < levels.size(); ++l) {
    part = coarser(part);
    // Cells from the middle of a child to its border; of a block it is twice that.
    const auto half = static_cast<float>(std::ldexp(0.5, static_cast<int>(l)));
    const PlaneFit plane_fit{unit_, half,
                             static_cast<std::int32_t>(std::min<double>(kMostSteps, kMostTilt / (2 * half * unit_)))};
    if (l == 0) {
      field.visit([&](const auto& grid) {
        fit_first(grid, code_, flat_codes, plane_fit, levels[0], part, extremes.maxima, entries_.get());
      });
    } else {
      fit_coarser(flat_codes, plane_fit, levels[l - 1], levels[l], part, extremes.maxima, entries_.get());
    }
  }
}

double BlockPlanes::height(std::ptrdiff_t entry, double x, double y) const {
  const std::uint32_t bits = entries_[static_cast<std::size_t>(entry)];
  const auto slope_x = static_cast<std::int8_t>(bits >> 16), slope_y = static_cast<std::int8_t>(bits >> 24);
  return code_.base +
         code_.step * (static_cast<double>(bits & 0xffff) + static_cast<double>(unit_) * (slope_x * x + slope_y * y));
}

}  // namespace scarp
