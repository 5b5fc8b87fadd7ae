// SPDX-License-Identifier: MIT
#include "scarp/accel/max_pyramid.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "scarp/accel/block_planes.h"
#include "scarp/accel/height_encode.h"
#include "scarp/accel/relief_map.h"
#include "scarp/base/parallel.h"
#include "scarp/base/prefetch.h"

namespace scarp {
namespace {

// Rows prefetched ahead. More would delay other memory requests.
constexpr int kRowsAhead = 4;

// One row of cells, columns [begin, end), of a field with holes: the extremes of each cell's four corners. Holes get
// the lowest value for both, so that they raise no maximum and leave no minimum.
template <class T>
void extremes_of_cells(const SampleGrid<T>& grid, int row, int begin, int end, T* highest, T* lowest) {
  constexpr T kHole =
      std::numeric_limits<T>::has_infinity ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
  const T *north = grid.row(row), *south = grid.row(grid.south(row));
  const auto extremes = [&](int col, int east) {
    highest[col - begin] = std::max(std::max(north[col], north[east]), std::max(south[col], south[east]));
    lowest[col - begin] = std::min(std::min(north[col], north[east]), std::min(south[col], south[east]));
  };
  const int plain_end = std::min(end, grid.cols - 1);
  for (int col = begin; col < plain_end; ++col) extremes(col, col + 1);
  if (plain_end < end) extremes(plain_end, grid.east(plain_end));
  for (int col = begin; col < end; ++col) {
    if (grid.is_hole(col, row)) highest[col - begin] = lowest[col - begin] = kHole;
  }
}

// A row of coarser entries from two finer ones (the same twice at an odd end). An odd last column stands alone.
template <class T, class Pick>
void pick_of_four(const T* north, const T* south, int fine_cols, T* coarse, Pick pick) {
  const int pairs = fine_cols / 2;
  for (int col = 0; col < pairs; ++col) {
    coarse[col] = pick(pick(north[2 * col], north[2 * col + 1]), pick(south[2 * col], south[2 * col + 1]));
  }
  if (fine_cols % 2 != 0) coarse[pairs] = pick(north[2 * pairs], south[2 * pairs]);
}
constexpr auto kHigher = [](auto a, auto b) { return std::max(a, b); };
constexpr auto kHigherMaximum = [](std::uint32_t a, std::uint32_t b) { return std::max(a & 0xffff, b & 0xffff); };
constexpr auto kLower = [](auto a, auto b) { return std::min(a, b); };

// Extremes of blocks of 2 x 2 cells without holes, from 3 x 3 samples: first down each sample column, then across.
// `south` equals `middle` at an odd end of the field.
template <class T>
void extremes_of_samples(const SampleGrid<T>& grid, const T* north, const T* middle, const T* south, int begin, int end,
                         T* highest, T* lowest, T* high, T* low) {
  const int plain = std::min(end + 1, grid.cols) - begin;
  for (int i = 0; i < plain; ++i) {
    const T a = north[begin + i], b = middle[begin + i], c = south[begin + i];
    const T most = a > b ? a : b, least = a < b ? a : b;
    highest[i] = most > c ? most : c;
    lowest[i] = least < c ? least : c;
  }
  if (end == grid.cols) {
    // The last cell of a wrapped field ends at the first column.
    highest[plain] = std::max({north[0], middle[0], south[0]});
    lowest[plain] = std::min({north[0], middle[0], south[0]});
  }
  const int pairs = (end - begin) / 2;
  for (int i = 0; i < pairs; ++i) {
    high[i] = std::max({highest[2 * i], highest[2 * i + 1], highest[2 * i + 2]});
    low[i] = std::min({lowest[2 * i], lowest[2 * i + 1], lowest[2 * i + 2]});
  }
  if ((end - begin) % 2 != 0) {
    high[pairs] = std::max(highest[2 * pairs], highest[2 * pairs + 1]);
    low[pairs] = std::min(lowest[2 * pairs], lowest[2 * pairs + 1]);
  }
}

// The largest difference between the codes of an entry.
int most_relief(const std::uint16_t* maxima, const std::uint16_t* minima, int count) {
  std::uint16_t most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, static_cast<std::uint16_t>(maxima[i] - minima[i]));
  return most;
}

void raise(std::atomic<int>& to, int value) {
  for (int now = to.load(std::memory_order_relaxed); now < value;) {
    if (to.compare_exchange_weak(now, value, std::memory_order_relaxed)) return;
  }
}

// Level 1, from the samples. Intermediate rows are temporary.
template <class T>
void build_first(const SampleGrid<T>& grid, const HeightCode& code, const CellBox& part, int cols,
                 std::uint32_t* blocks, std::uint16_t* minima, std::atomic<int>& relief) {
  const int begin = 2 * part.col_begin, end = std::min(2 * part.col_end, grid.cell_cols);
  const int width = part.col_end - part.col_begin;
  parallel_for(part.row_end - part.row_begin, rows_per_piece(width), [&](std::int64_t first, std::int64_t last) {
    const auto cells = static_cast<std::size_t>(end - begin);
    std::vector<T> highest(2 * cells + 1), lowest(2 * cells + 1), high(static_cast<std::size_t>(width)),
        low(high.size());
    std::vector<std::uint16_t> maxima(high.size());
    for (int row = part.row_begin + static_cast<int>(first); row < part.row_begin + last; ++row) {
      if (row + kRowsAhead < part.row_begin + last) {
        const std::ptrdiff_t ahead = static_cast<std::ptrdiff_t>(row + kRowsAhead) * cols + part.col_begin;
        prefetch_for_write(blocks + ahead, width);
        prefetch_for_write(minima + ahead, width);
      }
      const std::size_t second = 2 * row + 1 < grid.cell_rows ? cells : 0;
      if (grid.has_holes) {
        extremes_of_cells(grid, 2 * row, begin, end, highest.data(), lowest.data());
        if (second) extremes_of_cells(grid, 2 * row + 1, begin, end, highest.data() + cells, lowest.data() + cells);
        pick_of_four(highest.data(), highest.data() + second, end - begin, high.data(), kHigher);
        pick_of_four(lowest.data(), lowest.data() + second, end - begin, low.data(), kLower);
      } else {
        const int middle = grid.south(2 * row), beyond = second ? grid.south(middle) : middle;
        extremes_of_samples(grid, grid.row(2 * row), grid.row(middle), grid.row(beyond), begin, end, highest.data(),
                            lowest.data(), high.data(), low.data());
      }
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row) * cols + part.col_begin;
      encode_above(code, high.data(), width, maxima.data());
      std::copy(maxima.begin(), maxima.end(), blocks + at);
      encode_below(code, low.data(), width, minima + at);
      raise(relief, most_relief(maxima.data(), minima + at, width));
    }
  });
}

// A coarser level of maxima or minima from the finer one.
template <class T, class Pick>
void build_coarser(const T* fine, const MaxPyramid::Level& finer, const CellBox& part, int cols, T* coarse, Pick pick) {
  const int begin = 2 * part.col_begin, end = std::min(2 * part.col_end, finer.cols);
  parallel_for(part.row_end - part.row_begin, rows_per_piece(part.col_end - part.col_begin),
               [&](std::int64_t first, std::int64_t last) {
                 for (int row = part.row_begin + static_cast<int>(first); row < part.row_begin + last; ++row) {
                   const T* north = fine + static_cast<std::ptrdiff_t>(2 * row) * finer.cols + begin;
                   const T* south = 2 * row + 1 < finer.rows ? north + finer.cols : north;
                   pick_of_four(north, south, end - begin,
                                coarse + static_cast<std::ptrdiff_t>(row) * cols + part.col_begin, pick);
                 }
               });
}

}  // namespace

struct MaxPyramid::State : Shared {
  BlockPlanes planes;
  ReliefMap relief;
};

MaxPyramid::MaxPyramid(const HeightField& field, const std::optional<SampleRange>& reserve) {
  auto state = std::make_shared<State>();
  planes_ = &state->planes;
  relief_ = &state->relief;
  shared_ = std::move(state);
  shared_->edits = field.edits();
  levels_ = pyramid_levels(field);
  if (levels_.empty()) return;
  entries_ = static_cast<std::size_t>(levels_.back().begin + 1);
  // Not zeroed: the thread that builds an entry writes it first.
  shared_->blocks.reset(new std::uint32_t[entries_ + kSpareEntries]);
  shared_->minima.reset(new std::uint16_t[entries_ + kSpareEntries]);
  std::fill_n(shared_->blocks.get() + entries_, kSpareEntries, 0);
  std::fill_n(shared_->minima.get() + entries_, kSpareEntries, kNoMinimum);
  set_range(field, reserve);
  build(field, {0, 0, field.cell_cols(), field.cell_rows()});
  planes_->build(field, all_blocks(), reserve);
  relief_->build(field);
}

std::size_t MaxPyramid::bytes() const {
  return entries_ * (sizeof(std::uint32_t) + sizeof(std::uint16_t)) + relief_->bytes();
}

Blocks MaxPyramid::all_blocks() const { return {levels_, shared_->blocks.get(), minima(), code()}; }

void MaxPyramid::set_range(const HeightField& field, const std::optional<SampleRange>& reserve) {
  shared_->cell_relief = 0;
  shared_->range = code_range(field, reserve);
  shared_->code = height_code(field.sample_type(), shared_->range);
}

void MaxPyramid::update(const HeightField& field, const CellBox& changed) {
  shared_->edits = field.edits();
  if (levels_.empty()) return;
  relief_->update(field, changed);
  if (!is_in_range(field, shared_->range)) {
    set_range(field, shared_->range);
    build(field, {0, 0, field.cell_cols(), field.cell_rows()});
    return planes_->build(field, all_blocks(), shared_->range);
  }
  for (const CellBox& part : parts_inside(field, changed)) build(field, part);
  planes_->update(field, all_blocks(), changed);
}

void MaxPyramid::build(const HeightField& field, const CellBox& changed) {
  std::uint32_t* blocks = shared_->blocks.get();
  std::uint16_t* minima = shared_->minima.get();
  CellBox part = changed;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    part = coarser(part);
    const Level& level = levels_[l];
    if (l == 0) {
      std::atomic<int> relief = shared_->cell_relief;
      field.visit(
          [&](const auto& grid) { build_first(grid, shared_->code, part, level.cols, blocks, minima, relief); });
      shared_->cell_relief = relief;
      continue;
    }
    const Level& finer = levels_[l - 1];
    build_coarser(blocks + finer.begin, finer, part, level.cols, blocks + level.begin, kHigherMaximum);
    build_coarser(minima + finer.begin, finer, part, level.cols, minima + level.begin, kLower);
  }
}

double MaxPyramid::maximum(int level, int col, int row) const {
  const Level& at = levels_[static_cast<std::size_t>(level - 1)];
  return code().height(maximum_code(at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col));
}

double MaxPyramid::minimum(int level, int col, int row) const {
  const Level& at = levels_[static_cast<std::size_t>(level - 1)];
  const std::uint16_t lowest = minima()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
  return lowest == kNoMinimum ? -std::numeric_limits<double>::infinity() : code().height(lowest);
}

}  // namespace scarp
