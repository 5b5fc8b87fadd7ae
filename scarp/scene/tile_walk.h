// SPDX-License-Identifier: MIT
// Private to the station: the tiles on the way of a ray, one after the other, for single rays and batches.
//
// Tiles are widened by a cell, far more than rounding: an unnecessary test of a tile costs little, and neither it nor
// the order of the tiles changes an answer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "scarp/march/usual_ray.h"
#include "scarp/scene/tile_map.h"

namespace scarp {

/// A range of times; empty if the end is before the begin.
struct TileSpan {
  double begin, end;
  bool empty() const { return !(begin <= end); }
};

/// One horizontal axis of a ray.
struct TileAxis {
  TileAxis(double axis_origin, double axis_direction)
      : origin(axis_origin), direction(axis_direction), inverse(1 / axis_direction) {}

  double at(double t) const { return direction == 0 ? origin : origin + direction * t; }
  /// The part of a span in which the ray is between two coordinates.
  TileSpan between(double low, double high, const TileSpan& span) const {
    if (direction == 0) return low <= origin && origin <= high ? span : TileSpan{1, 0};
    // The reciprocal of a very short direction overflows.
    const bool usual = std::abs(inverse) < std::numeric_limits<double>::infinity();
    const double a = usual ? (low - origin) * inverse : (low - origin) / direction;
    const double b = usual ? (high - origin) * inverse : (high - origin) / direction;
    return {std::max(span.begin, std::min(a, b)), std::min(span.end, std::max(a, b))};
  }

  double origin, direction, inverse;
};

/// The grid of tiles, with the numbers that walks need.
class TileGrid {
 public:
  /// `highest`: the highest ground of all tiles, in metres.
  TileGrid(const TileMap& map, double highest)
      : map_(&map),
        highest_(highest),
        width_(map.tile_width()),
        depth_(map.tile_depth()),
        per_width_(1 / width_),
        per_depth_(1 / depth_) {
    const std::int64_t tiles = std::int64_t{cols()} * rows();
    if (tiles > kMostListed) return;
    listed_.reserve(static_cast<std::size_t>(tiles));
    for (int row = 0; row < rows(); ++row)
      for (int col = 0; col < cols(); ++col) listed_.push_back(found(col, row));
  }

  const TileMap& map() const { return *map_; }
  int cols() const { return map_->layout.cols; }
  int rows() const { return map_->layout.rows; }
  double width() const { return width_; }
  double depth() const { return depth_; }
  double per_width() const { return per_width_; }
  double per_depth() const { return per_depth_; }
  double highest() const { return highest_; }
  /// A tile with its highest ground; null if it is missing or has no ground.
  struct Found {
    const Tile* tile;
    double highest;
  };
  Found at(int col, int row) const {
    if (listed_.empty()) return found(col, row);
    return listed_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols()) + static_cast<std::size_t>(col)];
  }
  /// By how much tiles are widened for a ray from here, in metres.
  double wide_x(double x) const { return map_->layout.ground.cell_x + std::abs(x) * 0x1p-48; }
  double wide_y(double y) const { return map_->layout.ground.cell_y + std::abs(y) * 0x1p-48; }

  /// Whether the ray is over a tile where it reaches the terrain, or starts over it.
  bool begins_on(const Ray& ray, int col, int row) const {
    const TileAxis x(ray.origin.x, ray.direction.x), y(ray.origin.y, ray.direction.y);
    const TileSpan over = y.between(0, rows() * depth_, x.between(0, cols() * width_, TileSpan{ray.t_min, ray.t_max}));
    const double begin_x = x.at(over.begin), begin_y = y.at(over.begin);
    const double slack_x = kTileSeam * wide_x(x.origin), slack_y = kTileSeam * wide_y(y.origin);
    const int north = rows() - 1 - row;
    return begin_x >= col * width_ - slack_x && begin_x <= (col + 1) * width_ + slack_x &&
           begin_y >= north * depth_ - slack_y && begin_y <= (north + 1) * depth_ + slack_y;
  }

  /// Finds the only tile that a ray may touch. Returns false if there may be others, or none.
  bool only_tile(const Ray& ray, int& col, int& row) const {
    if (!(ray.t_max < std::numeric_limits<double>::infinity())) return false;
    const auto only = [&](double from, double to, double wide, double per_length, int count, int& at) {
      const double low = (std::min(from, to) - wide) * per_length, high = (std::max(from, to) + wide) * per_length;
      if (!(low >= 0 && high < count)) return false;
      at = static_cast<int>(low);
      return high < at + 1;
    };
    const dvec3 &o = ray.origin, &d = ray.direction;
    int north = 0;
    if (!only(o.x + d.x * ray.t_min, o.x + d.x * ray.t_max, wide_x(o.x), per_width_, cols(), col)) return false;
    if (!only(o.y + d.y * ray.t_min, o.y + d.y * ray.t_max, wide_y(o.y), per_depth_, rows(), north)) return false;
    row = rows() - 1 - north;
    return true;
  }

 private:
  static constexpr std::int64_t kMostListed = 4096;

  Found found(int col, int row) const {
    const Tile* tile = map_->find(col, row);
    if (!tile || tile->ground->field.all_nodata()) return {nullptr, 0};
    return {tile, tile->ground->field.max_height()};
  }

  const TileMap* map_;
  std::vector<Found> listed_;  // of all tiles, unless there are very many
  double highest_;
  double width_, depth_, per_width_, per_depth_;
};

// Rounding of the height of a ray that is compared with a height. Products below the smallest normal number have a
// larger relative rounding error.
inline double rounding_of_height(double origin, double at, double height) {
  return 0x1p-40 * (std::abs(origin) + std::abs(at) + std::abs(height)) + std::numeric_limits<double>::min();
}

/// Whether the ray is above a height in a span, by more than rounding.
inline bool is_above(double highest, const Ray& ray, const TileSpan& span) {
  const TileAxis z(ray.origin.z, ray.direction.z);
  const double lowest = z.at(ray.direction.z < 0 ? span.end : span.begin);
  return lowest - highest > rounding_of_height(ray.origin.z, lowest, highest);
}

/// Visits the tiles that a ray may hit, nearest first to within a cell. `only_from_above`: skips tiles whose ground the
/// ray stays above.
class TileWalk {
 public:
  TileWalk(const TileGrid& grid, const Ray& ray, bool only_from_above)
      : x_(ray.origin.x, ray.direction.x), y_(ray.origin.y, ray.direction.y), only_from_above_(only_from_above) {
    whole_ = {ray.t_min, ray.t_max};
    const double wide_x = grid.wide_x(x_.origin), wide_y = grid.wide_y(y_.origin);
    whole_ = x_.between(-wide_x, grid.cols() * grid.width() + wide_x, whole_);
    whole_ = y_.between(-wide_y, grid.rows() * grid.depth() + wide_y, whole_);
    if (only_from_above && ray.direction.z != 0) come_down(grid, ray);
    if (whole_.empty() || !is_followable(ray)) return;
    range(x_, whole_, wide_x, grid.per_width(), grid.cols(), next_col_, last_col_);
    left_cols_ = std::abs(last_col_ - next_col_) + 1;
  }

  /// Moves on to the next tile before the time `until` and returns it; null if there is none.
  const Tile* next(const TileGrid& grid, const Ray& ray, double until) {
    const double wide_x = grid.wide_x(x_.origin), wide_y = grid.wide_y(y_.origin);
    for (;;) {
      while (left_norths_ > 0) {
        const int north = next_north_;
        next_north_ += y_.direction >= 0 ? 1 : -1, --left_norths_;
        const TileSpan span = y_.between(north * grid.depth() - wide_y, (north + 1) * grid.depth() + wide_y, in_col_);
        if (span.empty()) continue;
        if (span.begin > until) break;
        row_ = grid.rows() - 1 - north;
        const auto [tile, highest] = grid.at(col_, row_);
        if (tile && !(only_from_above_ && is_above(highest, ray, span))) return tile;
      }
      left_norths_ = 0;
      if (left_cols_ == 0) return nullptr;
      col_ = next_col_;
      next_col_ += x_.direction >= 0 ? 1 : -1, --left_cols_;
      in_col_ = x_.between(col_ * grid.width() - wide_x, (col_ + 1) * grid.width() + wide_x, whole_);
      if (in_col_.empty()) continue;
      if (in_col_.begin > until) return nullptr;
      int last_north = 0;
      range(y_, in_col_, wide_y, grid.per_depth(), grid.rows(), next_north_, last_north);
      left_norths_ = std::abs(last_north - next_north_) + 1;
    }
  }

  /// The tile that next() returned.
  int col() const { return col_; }
  int row() const { return row_; }

 private:
  // Leaves out where the ray is above the highest ground, by more than rounding.
  void come_down(const TileGrid& grid, const Ray& ray) {
    const double o = ray.origin.z, h = grid.highest();
    const double t = (h + 4 * rounding_of_height(o, o, h) - o) / ray.direction.z;
    if (ray.direction.z < 0) {
      whole_.begin = std::max(whole_.begin, t);
    } else {
      whole_.end = std::min(whole_.end, t);
    }
  }
  // The range of tiles in a span, in the order in which the ray crosses them.
  static void range(const TileAxis& axis, const TileSpan& span, double wide, double per_length, int count, int& first,
                    int& last) {
    const double from = axis.at(span.begin), to = axis.at(span.end);
    const double low = std::floor((std::min(from, to) - wide) * per_length);
    const double high = std::floor((std::max(from, to) + wide) * per_length);
    first = static_cast<int>(std::clamp(low, 0.0, count - 1.0));
    last = static_cast<int>(std::clamp(high, 0.0, count - 1.0));
    if (axis.direction < 0) std::swap(first, last);
  }

  TileAxis x_, y_;
  bool only_from_above_;
  TileSpan whole_{1, 0}, in_col_{1, 0};
  int next_col_ = 0, last_col_ = 0, left_cols_ = 0;
  int next_north_ = 0, left_norths_ = 0;  // rows counted from the south
  int col_ = 0, row_ = 0;
};

}  // namespace scarp
