// SPDX-License-Identifier: MIT
#include "scarp/scene/tile_fan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/base/parallel.h"
#include "scarp/base/prefetch.h"
#include "scarp/march/height/max_mip_fan.h"

namespace scarp {
namespace {

constexpr std::int64_t kMostTilesOfFan = 4096, kRaysPerFanPiece = 8192;
constexpr std::size_t kAhead = 8;  // rows prefetched ahead
constexpr auto kColumns = static_cast<std::size_t>(kFanStrip);
// Distance in cells from the borders of a tile at which positions on a ray are certainly on this side: far above their
// rounding, far below a cell.
constexpr double kInside = 0x1p-10;
// Relative, far above the rounding of distances and slopes, which only skip tiles.
constexpr double kSlack = 0x1p-20;

// A tile with ground, seen from the origin of the fan.
struct SeenTile {
  const Tile* tile;
  double highest;
  int col, row;
  int ring;
  dvec3 corner;
  dvec2 low, high;  // of its ground widened by a cell, relative to the origin
  double near, far;
};

double cross_of(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

// Tiles between the origin and this one along an axis. An origin near a line between tiles is on both sides of it.
int ring_of(double origin, double length, double cell, int index) {
  const double slack = kInside * cell + std::abs(origin) * 0x1p-40;
  const auto tile_at = [&](double p) { return std::clamp(std::floor(p / length), -0x1p30, 0x1p30); };
  const double first = tile_at(origin - slack), last = tile_at(origin + slack);
  return static_cast<int>(index < first ? first - index : index > last ? index - last : 0);
}

std::vector<SeenTile> tiles_seen(const TileGrid& grid, const dvec3& origin) {
  const TileLayout& layout = grid.map().layout;
  std::vector<SeenTile> seen;
  for (int row = 0; row < layout.rows; ++row) {
    for (int col = 0; col < layout.cols; ++col) {
      const auto [tile, highest] = grid.at(col, row);
      if (!tile) continue;
      SeenTile s{tile, highest, col, row, 0, grid.map().corner(col, row), {}, {}, 0, 0};
      s.ring = ring_of(origin.x, grid.width(), layout.ground.cell_x, col) +
               ring_of(origin.y, grid.depth(), layout.ground.cell_y, layout.rows - 1 - row);
      const dvec2 wide(grid.wide_x(origin.x), grid.wide_y(origin.y));
      s.low = dvec2(s.corner) - dvec2(origin) - wide;
      s.high = dvec2(s.corner) - dvec2(origin) + dvec2(grid.width(), grid.depth()) + wide;
      s.near = length(max(max(s.low, -s.high), dvec2(0.0)));
      s.far = length(max(abs(s.low), abs(s.high)));
      seen.push_back(s);
    }
  }
  std::stable_sort(seen.begin(), seen.end(), [](const SeenTile& a, const SeenTile& b) { return a.ring < b.ring; });
  return seen;
}

// Up to 16 columns with all their rows, on one thread.
class TileFanStrip {
 public:
  TileFanStrip(const TileGrid& grid, std::span<const SeenTile> tiles, const FanBatch& batch, std::span<const Ray> rays,
               std::span<Hit> hits)
      : grid_(grid), tiles_(tiles), batch_(batch), rays_(rays), hits_(hits) {
    const std::size_t runs = rays.size() / batch.run;
    rows_ = batch.columns ? batch.run : runs;
    columns_ = batch.columns ? runs : batch.run;
    const std::size_t places = rows_ * kColumns;
    dx_.resize(places), dy_.resize(places), dz_.resize(places), least_slopes_.resize(rows_);
    states_.resize(places), sights_.resize(places);
  }

  /// Returns the rays that are left to other code.
  std::span<const std::uint32_t> answer(std::size_t strip) {
    others_.clear();
    first_ = strip * kColumns;
    width_ = std::min(kColumns, columns_ - first_);
    std::fill(states_.begin(), states_.end(), State::none);
    low_ = 0, high_ = rows_;
    if (!take_rays()) {
      for_each([&](std::size_t place, std::uint32_t ray) { leave(place, ray); });
      return others_;
    }
    find_wedge();
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      if (i == 0 || tiles_[i].ring != tiles_[i - 1].ring) end_ring();
      if (low_ == high_) break;
      if (!may_touch(tiles_[i])) continue;
      if (look(tiles_[i])) continue;
      // Not faster by a fan.
      for_each([&](std::size_t place, std::uint32_t ray) {
        if (is_left(place)) leave(place, ray);
      });
      break;
    }
    return others_;
  }

 private:
  std::uint32_t ray_at(std::size_t row, std::size_t lane) const {
    const std::size_t column = first_ + lane;
    return static_cast<std::uint32_t>(batch_.columns ? column * batch_.run + row : row * batch_.run + column);
  }
  struct Rows {
    std::size_t begin, end;
  };
  // Calls body(place, ray) for the rays of the rows that are left.
  template <class Body>
  void for_each(const Body& body) const {
    for_each_in({low_, high_}, body);
  }
  template <class Body>
  void for_each_in(const Rows& rows, const Body& body) const {
    for (std::size_t row = rows.begin; row < rows.end; ++row)
      for (std::size_t lane = 0; lane < width_; ++lane) body(row * kColumns + lane, ray_at(row, lane));
  }
  // The state of a ray. `hit`: it hits in this ring.
  enum class State : std::uint8_t { none, open, hit };

  bool is_left(std::size_t place) const { return states_[place] != State::none; }
  void leave(std::size_t place, std::uint32_t ray) {
    states_[place] = State::none;
    others_.push_back(ray);
  }

  void prefetch_row(std::size_t row) const {
    for (std::size_t lane = 0; lane < width_; ++lane) {
      const std::uint32_t i = ray_at(row, lane);
      const auto* begin = reinterpret_cast<const char*>(&rays_[i]);
      prefetch(begin), prefetch(begin + 64);  // two cache lines
      prefetch(&hits_[i]);
    }
  }
  // Returns false if a ray does not belong to the fan.
  bool take_rays() {
    const dvec3& origin = rays_[0].origin;
    bool all = true;
    reach_ = 0;
    for (std::size_t row = 0; row < rows_; ++row) {
      // Rows are far apart in memory.
      if (row + kAhead < rows_) prefetch_row(row + kAhead);
      least_slopes_[row] = std::numeric_limits<float>::infinity();
      for (std::size_t lane = 0; lane < width_; ++lane) {
        const std::size_t place = row * kColumns + lane;
        const std::uint32_t i = ray_at(row, lane);
        const Ray& ray = rays_[i];
        const dvec3& d = ray.direction;
        all = all && is_of_fan(ray, origin) && d == d && ray.t_max >= 0;
        dx_[place] = static_cast<float>(d.x), dy_[place] = static_cast<float>(d.y);
        dz_[place] = static_cast<float>(d.z);
        const double flat = std::sqrt(d.x * d.x + d.y * d.y);
        // Infinite for vertical rays.
        least_slopes_[row] = std::min(least_slopes_[row], static_cast<float>(d.z / flat));
        reach_ = std::max(reach_, flat == 0 ? 0 : flat * ray.t_max);
        hits_[i] = {};
        states_[place] = State::open;
      }
    }
    return all;
  }
  // Between which directions, seen from above, all rays are.
  void find_wedge() {
    const auto at = [&](std::size_t place) {
      return dvec2(static_cast<double>(dx_[place]), static_cast<double>(dy_[place]));
    };
    middle_ = at(rows_ / 2 * kColumns + width_ / 2);
    double right = 0, left = 0;
    all_round_ = middle_ == dvec2(0.0);
    for_each([&](std::size_t place, std::uint32_t) {
      const dvec2 d = at(place);
      const double ahead = dot(middle_, d), aside = cross_of(middle_, d);
      // Not within 84 degrees to the side.
      all_round_ = all_round_ || !(ahead > 0.1 * std::abs(aside));
      if (all_round_) return;
      right = std::min(right, aside / ahead), left = std::max(left, aside / ahead);
    });
    const dvec2 to_left(-middle_.y, middle_.x);
    left_ = middle_ + (left + kSlack) * to_left, right_ = middle_ + (right - kSlack) * to_left;
  }
  // Whether a ray may be over the tile.
  bool may_touch(const SeenTile& seen) const {
    if (seen.near > reach_ * (1 + kSlack)) return false;
    if (all_round_) return true;
    bool left = true, right = true, behind = true;  // of the wedge
    for (const dvec2& c : {seen.low, seen.high, dvec2(seen.low.x, seen.high.y), dvec2(seen.high.x, seen.low.y)}) {
      left = left && cross_of(left_, c) > 0, right = right && cross_of(right_, c) < 0;
      behind = behind && dot(middle_, c) < 0;
    }
    return !left && !right && !behind;
  }

  // The rows that are left and may come down to the ground of the tile.
  Rows low_rows(const SeenTile& seen) const {
    const double z = rays_[0].origin.z, highest = seen.highest;
    const auto is_low = [&](std::size_t row) {
      const auto slope = static_cast<double>(least_slopes_[row]);
      const double down = slope * (slope < 0 ? seen.far : seen.near);
      return !(z + down - highest > kSlack * (std::abs(z) + std::abs(down) + std::abs(highest)));
    };
    Rows rows{low_, high_};
    while (rows.begin < rows.end && !is_low(rows.begin)) ++rows.begin;
    while (rows.begin < rows.end && !is_low(rows.end - 1)) --rows.end;
    return rows;
  }

  // Traces the rays that are left over a tile. Returns false if a fan is not faster.
  bool look(const SeenTile& seen) {
    const Rows rows = low_rows(seen);
    if (rows.begin == rows.end) return true;
    const HeightTarget on = target_of(*seen.tile);
    Fan fan;
    fan.origin = rays_[0].origin - seen.corner;
    const std::size_t at = rows.begin * kColumns;
    fan.dx = dx_.data() + at, fan.dy = dy_.data() + at, fan.dz = dz_.data() + at;
    fan.columns = static_cast<int>(width_), fan.rows = static_cast<int>(rows_);
    fan.row_stride = kFanStrip;
    // Asked for all rows: the last ones that are left are few.
    const dvec3 &first = rays_[ray_at(0, 0)].direction, &last = rays_[ray_at(rows_ - 1, width_ - 1)].direction;
    if (!looks_by_fan(on, fan, first, last)) return false;
    fan.rows = static_cast<int>(rows.end - rows.begin);
    look_max_mip_fan(on, fan, sights_.data() + at, 0, fan.columns);
    own_.clear(), seen_.clear(), asked_.clear();
    for_each_in(rows, [&](std::size_t place, std::uint32_t i) {
      if (!is_left(place) || sights_[place].clear == std::numeric_limits<float>::infinity()) return;
      own_.push_back(rays_[i]);
      own_.back().origin = fan.origin;
      if (states_[place] == State::hit) own_.back().t_max = std::min(own_.back().t_max, hits_[i].t);
      seen_.push_back(sights_[place]), asked_.push_back(place);
    });
    if (found_.size() < own_.size()) found_.resize(own_.size());
    closest_hits_max_mip_seen(on, own_, seen_, std::span(found_).first(own_.size()));
    for (std::size_t j = 0; j < own_.size(); ++j) take(seen, own_[j], found_[j], asked_[j]);
    return true;
  }
  void take(const SeenTile& seen, const Ray& own, const Hit& found, std::size_t place) {
    if (found.status == HitStatus::miss) return;
    const std::uint32_t ray = ray_at(place / kColumns, place % kColumns);
    const HeightFieldSettings& cells = grid_.map().layout.ground;
    const dvec3 p = own.at(found.t);
    const double x = kInside * cells.cell_x, y = kInside * cells.cell_y;
    const bool inside = p.x > x && p.x < grid_.width() - x && p.y > y && p.y < grid_.depth() - y;
    if (!found || !inside) return leave(place, ray);
    hits_[ray] = found;
    hits_[ray].part = static_cast<std::uint32_t>(seen.row) * static_cast<std::uint32_t>(grid_.cols()) +
                      static_cast<std::uint32_t>(seen.col);
    states_[place] = State::hit;
  }

  // Drops rays that have hit, and rows without any that is left.
  void end_ring() {
    std::size_t low = high_, high = low_;
    for (std::size_t row = low_; row < high_; ++row) {
      bool any = false;
      for (std::size_t place = row * kColumns; place < row * kColumns + width_; ++place) {
        if (states_[place] == State::hit) states_[place] = State::none;
        if (states_[place] == State::none) continue;
        any = true;
      }
      if (any) low = std::min(low, row), high = row + 1;
    }
    low_ = std::min(low, high), high_ = high;
  }

  const TileGrid& grid_;
  std::span<const SeenTile> tiles_;
  const FanBatch& batch_;
  std::span<const Ray> rays_;
  std::span<Hit> hits_;
  std::size_t rows_ = 0, columns_ = 0, first_ = 0, width_ = 0;
  std::size_t low_ = 0, high_ = 0;  // rows with rays that are left
  double reach_ = 0;                // horizontal length of the longest ray
  dvec2 middle_{0.0}, left_{0.0}, right_{0.0};
  bool all_round_ = false;
  KeptVector<float> dx_, dy_, dz_, least_slopes_;
  KeptVector<State> states_;
  KeptVector<FanSight> sights_, seen_;
  KeptVector<Ray> own_;
  KeptVector<Hit> found_;
  KeptVector<std::size_t> asked_;
  std::vector<std::uint32_t> others_;
};

}  // namespace

bool closest_hits_in_tile_fan(const TileGrid& grid, const FanBatch& batch, std::span<const Ray> rays,
                              std::span<Hit> hits, const std::function<void(std::span<const std::uint32_t>)>& others) {
  const dvec3& origin = rays[0].origin;
  if (std::int64_t{grid.cols()} * grid.rows() > kMostTilesOfFan || !std::isfinite(origin.x + origin.y + origin.z))
    return false;
  bool below = false;
  grid.map().at(origin.x, origin.y, [&](const Tile& tile, int, int, double x, double y) {
    const auto height = tile.ground->field.height(x, y);
    return below = height && !(origin.z > *height);
  });
  if (below) return false;
  const std::vector<SeenTile> tiles = tiles_seen(grid, origin);
  const std::size_t runs = rays.size() / batch.run;
  const std::size_t columns = batch.columns ? runs : batch.run, rows = batch.columns ? batch.run : runs;
  const auto strips = static_cast<std::int64_t>((columns + kColumns - 1) / kColumns);
  const auto per_strip = static_cast<std::int64_t>(rows * kColumns);
  parallel_for(strips, std::max<std::int64_t>(1, kRaysPerFanPiece / per_strip),
               [&](std::int64_t begin, std::int64_t end) {
                 TileFanStrip strip(grid, tiles, batch, rays, hits);
                 for (std::int64_t i = begin; i < end; ++i) {
                   if (const auto left = strip.answer(static_cast<std::size_t>(i)); !left.empty()) others(left);
                 }
               });
  // An incomplete row or column.
  std::vector<std::uint32_t> rest;
  for (std::size_t i = runs * batch.run; i < rays.size(); ++i) rest.push_back(static_cast<std::uint32_t>(i));
  if (!rest.empty()) others(rest);
  return true;
}

}  // namespace scarp
