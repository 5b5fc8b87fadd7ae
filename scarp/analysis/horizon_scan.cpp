// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {

HorizonTable::HorizonTable(const HorizonLayout& heights, const HorizonCrossings& crossings)
    : col_sign_(crossings.col_sign()), row_sign_(crossings.row_sign()) {
  const std::ptrdiff_t pitch = heights.pitch;
  entries_.reserve(crossings.all().size());
  for (const HorizonCrossing& c : crossings.all()) {
    distances_.push_back(static_cast<float>(c.steps * crossings.step()));
    entries_.push_back({c.row * pitch + c.col, static_cast<std::int32_t>(c.second_row * pitch + c.second_col), c.w,
                        c.per_distance, static_cast<float>(heights.sign) * c.drop});
  }
  const bool along_columns = crossings.along_columns();
  const auto counts = [](int lines, const auto& count) {
    std::vector<std::int32_t> all;
    for (int i = 0; i < lines; ++i) all.push_back(static_cast<std::int32_t>(count(i)));
    return all;
  };
  const auto to_major = [&](int i) { return crossings.count_to_major(i); };
  const auto to_minor = [&](int i) { return crossings.tilt() > 0 ? crossings.count_to_minor(i) : entries_.size(); };
  by_col_ = along_columns ? counts(heights.cols, to_major) : counts(heights.cols, to_minor);
  by_row_ = along_columns ? counts(heights.rows, to_minor) : counts(heights.rows, to_major);
  const double per_row = along_columns ? 0 : (1 + crossings.tilt()) * kGroupRows;
  shift_ = static_cast<std::int32_t>(std::lround(per_row)) * -row_sign_;

  const int levels = HorizonGround::levels_of(heights.cols, heights.rows);
  segments_.resize(static_cast<std::size_t>(levels));
  const double steps = crossings.all().empty() ? 0 : crossings.all().back().steps;
  for (int level = 0; level < levels; ++level) {
    const int length = HorizonGround::steps_of(level), window = length + 2;
    for (int p = 0; p * length <= steps; ++p) {
      Segment to{};
      to.begin = static_cast<std::int32_t>(crossings.count_to_major(p * length));
      to.end = static_cast<std::int32_t>(crossings.count_to_major((p + 1) * length));
      const int minor = static_cast<int>(p * length * crossings.tilt());
      const int ahead_col = along_columns ? p * length : minor, ahead_row = along_columns ? minor : p * length;
      to.corner_col = col_sign_ > 0 ? ahead_col : -(ahead_col + window - 1);
      to.corner_row = row_sign_ > 0 ? ahead_row : -(ahead_row + window - 1);
      to.most_per_distance = 0, to.least_per_distance = std::numeric_limits<float>::infinity();
      to.least_drop = std::numeric_limits<float>::infinity();
      for (std::int32_t i = to.begin; i < to.end; ++i) {
        const Entry& e = entries_[static_cast<std::size_t>(i)];
        to.most_per_distance = std::max(to.most_per_distance, e.per_distance);
        to.least_per_distance = std::min(to.least_per_distance, e.per_distance);
        to.least_drop = std::min(to.least_drop, e.drop);
      }
      segments_[static_cast<std::size_t>(level)].push_back(to);
    }
  }
}

std::int32_t HorizonTable::reachable(int cols_ahead, int rows_ahead) const {
  return std::min(by_col_[static_cast<std::size_t>(cols_ahead)], by_row_[static_cast<std::size_t>(rows_ahead)]);
}

void scan_horizon_by_all(const HorizonGround& ground, const HorizonTable& table, float eye, const NodeRect& rect,
                         float* slope, std::int32_t* entry, std::ptrdiff_t pitch) {
  for (int row = rect.row_begin; row < rect.row_end; ++row) {
    for (int col = rect.col_begin; col < rect.col_end; ++col) {
      const float* node = ground.heights().height(col, row);
      const float z = *node + eye;
      float best = -std::numeric_limits<float>::infinity();
      std::int32_t winner = -1;
      const int cols_ahead = table.col_sign() > 0 ? ground.cols() - 1 - col : col;
      const int rows_ahead = table.row_sign() > 0 ? ground.rows() - 1 - row : row;
      const std::int32_t count = table.reachable(cols_ahead, rows_ahead);
      for (std::int32_t i = 0; i < count; ++i) {
        const HorizonTable::Entry& e = table.entries()[static_cast<std::size_t>(i)];
        const float first = node[e.first], second = node[e.first + e.second];
        const float above = std::fma(e.w, second - first, first - z);
        const float to = std::fma(above, e.per_distance, -e.drop);
        if (to > best) best = to, winner = i;
      }
      const std::ptrdiff_t at = (row - rect.row_begin) * pitch + (col - rect.col_begin);
      slope[at] = std::isnan(z) ? z : best;
      if (entry) entry[at] = winner;
    }
  }
}

}  // namespace scarp
