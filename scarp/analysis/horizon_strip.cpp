// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_strip.h"

#include <algorithm>
#include <cmath>

namespace scarp {
namespace {

int floor_of(double x) { return static_cast<int>(std::floor(x)); }

}  // namespace

StripShape::StripShape(int cols, int rows, bool along_columns, double drift, int width, int begin, int end)
    : cols_(cols),
      rows_(rows),
      along_columns_(along_columns),
      drift_(drift),
      width_(width),
      begin_(begin - kMargin),
      end_(end + kMargin) {
  const int whole = cols + 2 * kMargin;
  if (!along_columns) {
    // The rows below begin up to one column further west.
    pitch_ = width + 2;
    return;
  }
  const double length = std::abs(drift) > 0 ? (width + 1) / std::abs(drift) + 4 : HUGE_VAL;
  whole_rows_ = !(length < whole);
  pitch_ = whole_rows_ ? whole : static_cast<std::ptrdiff_t>(std::ceil(length));
}

int StripShape::row_begin(double offset) const {
  if (!along_columns_) return begin_;
  return std::clamp(floor_of(offset + std::min(drift_ * begin_, drift_ * end_)), -kMargin, rows_ + kMargin - 1);
}

int StripShape::row_end(double offset) const {
  if (!along_columns_) return end_;
  const int end = floor_of(offset + std::max(drift_ * begin_, drift_ * end_)) + width_ + 1;
  return std::clamp(end, row_begin(offset) + 1, rows_ + kMargin);
}

int StripShape::col_begin(double offset, int row) const {
  if (!along_columns_) return floor_of(offset + drift_ * row);
  if (whole_rows_) return -kMargin;
  // Rows of the strip at a column: offset + drift col up to width more.
  return floor_of((row - offset - (drift_ > 0 ? width_ : 0)) / drift_);
}

int StripShape::col_end(double offset, int row) const {
  if (!along_columns_) return col_begin(offset, row) + width_;
  if (whole_rows_) return cols_ + kMargin;
  return floor_of((row - offset - (drift_ > 0 ? 0 : width_)) / drift_) + 2;
}

std::ptrdiff_t StripShape::origin(double offset) const {
  const int row = row_begin(offset);
  return -(row * pitch_ + col_begin(offset, row)) + kMargin;
}

std::size_t StripShape::samples(double offset) const {
  const int last = row_end(offset) - 1;
  return static_cast<std::size_t>(last * pitch_ + col_end(offset, last) + origin(offset) + kMargin);
}

double StripShape::most_samples() const {
  const double length = end_ - begin_;
  const double rows = along_columns_ ? std::min(std::abs(drift_) * length + width_ + 2, rows_ + 2.0 * kMargin) : length;
  // From one row to the next, the first column moves by less than the pitch.
  const double per_row = along_columns_ && !whole_rows_ ? 1 / std::abs(drift_) : std::abs(drift_);
  return rows * (static_cast<double>(pitch_) + (drift_ > 0 && !whole_rows_ ? per_row : 0)) +
         static_cast<double>(pitch_) + 2 * kMargin;
}

}  // namespace scarp
