// SPDX-License-Identifier: MIT
#include "scarp/source/raster/decimate.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Number of columns whose sums stay in the L1 cache.
constexpr int kColumns = 1024;
// Number of rows whose sum of 16-bit samples always fits in an int32: 2^15 * 65535 < 2^31.
constexpr std::int64_t kMostRows = 1 << 15;

// Sums, extremes and number of valid samples of adjacent columns: loops over columns that compilers vectorise.
template <class T>
struct Columns {
  using Sum = std::conditional_t<std::is_floating_point_v<T>, double, std::int32_t>;
  Sum sum[kColumns] = {};
  std::int32_t valid[kColumns] = {};
  T low[kColumns], high[kColumns];

  explicit Columns(int count) {
    std::fill(low, low + count, std::numeric_limits<T>::max());
    std::fill(high, high + count, std::numeric_limits<T>::lowest());
  }

  void add_whole(const T* samples, int count) {
    for (int i = 0; i < count; ++i) {
      const T sample = samples[i];
      sum[i] += sample;
      low[i] = sample < low[i] ? sample : low[i];
      high[i] = sample > high[i] ? sample : high[i];
    }
  }

  void add(const T* samples, int count, T nodata) {
    for (int i = 0; i < count; ++i) {
      const T sample = samples[i];
      const bool hole = sample == nodata || sample != sample;
      const T lowest = hole ? std::numeric_limits<T>::max() : sample;
      const T highest = hole ? std::numeric_limits<T>::lowest() : sample;
      sum[i] += hole ? T{} : sample;
      valid[i] += !hole;
      low[i] = lowest < low[i] ? lowest : low[i];
      high[i] = highest > high[i] ? highest : high[i];
    }
  }
};

std::int64_t reduced(int side, std::int64_t block) {
  return std::max((side + block - 1) / block, std::int64_t{std::min(side, 2)});
}

}  // namespace

DecimatedSize decimated_size(int cols, int rows, std::int64_t most) {
  const double share = static_cast<double>(cols) * rows / static_cast<double>(most);
  std::int64_t block = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::sqrt(share)));
  while (reduced(cols, block) * reduced(rows, block) > most) ++block;
  return {static_cast<int>(reduced(cols, block)), static_cast<int>(reduced(rows, block)), static_cast<int>(block)};
}

template <class T>
Decimator<T>::Decimator(int cols, int rows, int out_cols, int out_rows, std::optional<T> nodata)
    : cols_(cols), rows_(rows), out_cols_(out_cols), out_rows_(out_rows), nodata_(nodata) {
  hole_ = nodata ? *nodata : std::is_floating_point_v<T> ? std::numeric_limits<T>::quiet_NaN() : T{};
  out_.resize(static_cast<std::size_t>(out_cols) * static_cast<std::size_t>(out_rows));
}

// Returns the last block that starts at or before the sample.
template <class T>
int Decimator<T>::out_col_of(int col) const {
  return static_cast<int>(((std::int64_t{col} + 1) * out_cols_ - 1) / cols_);
}

template <class T>
int Decimator<T>::out_row_of(int row) const {
  return static_cast<int>(((std::int64_t{row} + 1) * out_rows_ - 1) / rows_);
}

template <class T>
void Decimator<T>::add(const RasterWindow& rect, const T* samples) {
  const int first = out_row_of(rect.row), last = out_row_of(rect.row + rect.rows - 1);
  while (next_row_ + static_cast<int>(open_.size()) <= last) {
    Row row;
    row.sum.resize(static_cast<std::size_t>(out_cols_));
    row.valid.resize(static_cast<std::size_t>(out_cols_));
    open_.push_back(std::move(row));
  }
  parallel_for(last - first + 1, 1, [&](std::int64_t begin, std::int64_t end) {
    for (int out = first + static_cast<int>(begin); out < first + end; ++out) {
      const std::int64_t from = std::max<std::int64_t>(first_row(out), rect.row),
                         to = std::min<std::int64_t>(first_row(out + 1), std::int64_t{rect.row} + rect.rows);
      Row& row = open_[static_cast<std::size_t>(out - next_row_)];
      for (std::int64_t at = from; at < to; at += kMostRows)
        add_to_row(row, rect, samples, at, std::min(kMostRows, to - at));
    }
  });
}

template <class T>
void Decimator<T>::add_to_row(Row& row, const RasterWindow& rect, const T* samples, std::int64_t first,
                              std::int64_t count) {
  // Integers without a nodata value have no holes.
  const bool whole = !nodata_ && !std::is_floating_point_v<T>;
  for (int begin = 0; begin < rect.cols; begin += kColumns) {
    const int width = std::min(kColumns, rect.cols - begin);
    Columns<T> columns(width);
    for (std::int64_t r = first; r < first + count; ++r) {
      const T* line = samples + (r - rect.row) * rect.cols + begin;
      if (whole) {
        columns.add_whole(line, width);
      } else {
        columns.add(line, width, hole_);
      }
    }
    int out = out_col_of(rect.col + begin);
    std::int64_t next = first_col(out + 1);
    for (int i = 0; i < width; ++i) {
      while (rect.col + begin + i >= next) next = first_col(++out + 1);
      const std::int64_t valid = whole ? count : columns.valid[i];
      if (valid == 0) continue;
      row.sum[static_cast<std::size_t>(out)] += static_cast<double>(columns.sum[i]);
      row.valid[static_cast<std::size_t>(out)] += valid;
      if (const auto low = static_cast<double>(columns.low[i]); low < row.ends.low) {
        row.ends.low = low;
        row.low_col = out;
      }
      if (const auto high = static_cast<double>(columns.high[i]); high > row.ends.high) {
        row.ends.high = high;
        row.high_col = out;
      }
    }
  }
}

template <class T>
void Decimator<T>::close_rows(int end) {
  int closed = 0;
  for (; next_row_ < out_rows_ && first_row(next_row_ + 1) <= end; ++next_row_, ++closed) {
    if (static_cast<std::size_t>(closed) < open_.size()) {
      write(open_[static_cast<std::size_t>(closed)]);
    } else {
      std::fill_n(&at({0, next_row_}), out_cols_, hole_);
    }
  }
  open_.erase(open_.begin(), open_.begin() + std::min<std::ptrdiff_t>(closed, std::ssize(open_)));
}

template <class T>
void Decimator<T>::write(const Row& row) {
  const std::int64_t high = first_row(next_row_ + 1) - first_row(next_row_);
  for (int col = 0; col < out_cols_; ++col) {
    const auto i = static_cast<std::size_t>(col);
    const std::int64_t samples = (first_col(col + 1) - first_col(col)) * high;
    at({col, next_row_}) = 2 * row.valid[i] < samples ? hole_ : average(row.sum[i], row.valid[i]);
  }
  if (row.ends.low < ends_.low) {
    ends_.low = row.ends.low;
    low_ = {row.low_col, next_row_};
  }
  if (row.ends.high > ends_.high) {
    ends_.high = row.ends.high;
    high_ = {row.high_col, next_row_};
  }
}

// An average that equals the nodata value must not become a hole: it moves to the next value.
template <class T>
T Decimator<T>::average(double sum, std::int64_t valid) const {
  const double mean = sum / static_cast<double>(valid);
  const bool down = nodata_ && mean < static_cast<double>(*nodata_);
  if constexpr (std::is_floating_point_v<T>) {
    const T value = static_cast<T>(mean);
    if (value != hole_) return value;
    return std::nextafter(value, down ? std::numeric_limits<T>::lowest() : std::numeric_limits<T>::max());
  } else {
    const T value = static_cast<T>(std::lround(mean));
    if (!nodata_ || value != *nodata_) return value;
    return static_cast<T>(down || value == std::numeric_limits<T>::max() ? value - 1 : value + 1);
  }
}

// Returns a neighbour of a block, for the second extreme: one block cannot hold both.
template <class T>
typename Decimator<T>::Place Decimator<T>::beside(const Place& place) const {
  if (out_cols_ > 1) return {place.col + 1 < out_cols_ ? place.col + 1 : place.col - 1, place.row};
  if (out_rows_ > 1) return {place.col, place.row + 1 < out_rows_ ? place.row + 1 : place.row - 1};
  return place;
}

template <class T>
std::vector<T> Decimator<T>::finish(const SampleEnds& known) {
  if (ends_.low <= ends_.high) {
    const double low = std::min(ends_.low, known.low), high = std::max(ends_.high, known.high);
    if (low < high && low_.col == high_.col && low_.row == high_.row) low_ = beside(high_);
    at(low_) = static_cast<T>(low);
    at(high_) = static_cast<T>(high);
  }
  return std::move(out_);
}

template class Decimator<std::int16_t>;
template class Decimator<std::uint16_t>;
template class Decimator<float>;

}  // namespace scarp
