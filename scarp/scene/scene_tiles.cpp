// SPDX-License-Identifier: MIT
// Tiles as one field of a scene: each tile on the ray's path is traced by its own march; the closest hit counts; at the
// same t, the tile with the lower number.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "scarp/march/height/closest_point.h"
#include "scarp/march/height/ground_contact.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/tile_map.h"

namespace scarp {
namespace {

struct Span {
  double begin, end;
  bool empty() const { return !(begin <= end); }
};

// The times at which a ray is between two coordinates along an axis.
Span between(double low, double high, double origin, double direction, const Span& span) {
  if (direction == 0) return low <= origin && origin <= high ? span : Span{1, 0};
  const double a = (low - origin) / direction, b = (high - origin) / direction;
  return {std::max(span.begin, std::min(a, b)), std::min(span.end, std::max(a, b))};
}

double along(double origin, double direction, double t) { return direction == 0 ? origin : origin + direction * t; }

class Tiles final : public SceneField {
 public:
  Tiles(std::shared_ptr<const TileMap> map, const HeightMarchEntry& march)
      : map_(std::move(map)), layout_(map_->layout), march_(march) {
    for (int row = 0; row < layout_.rows; ++row) {
      for (int col = 0; col < layout_.cols; ++col) {
        const Tile* tile = map_->find(col, row);
        if (!tile) continue;
        const HeightField& field = tile->ground->field;
        elements_ += std::int64_t{field.cols()} * field.rows();
        if (field.all_nodata()) continue;
        box_ = around(box_, box_of(*tile, col, row));
      }
    }
  }

  std::string_view kind() const override { return "tiles"; }
  std::string_view march() const override { return march_.name; }
  Sampling sampling() const override { return march_.sampling; }
  std::optional<WorldBox> box() const override { return box_; }
  double cell_side() const override { return std::min(layout_.ground.cell_x, layout_.ground.cell_y); }
  std::int64_t elements() const override { return elements_; }
  std::optional<std::uint64_t> edits() const override {
    std::uint64_t edits = 0;
    for (int row = 0; row < layout_.rows; ++row) {
      for (int col = 0; col < layout_.cols; ++col) {
        if (const Tile* tile = map_->find(col, row)) edits += tile->given.edits();
      }
    }
    return edits;
  }
  SceneFieldPtr judge() const override { return scene_tiles(map_, find_height_march("exhaustive")); }

  std::optional<double> height(double x, double y) const override {
    std::optional<double> height;
    map_->at(x, y, [&](const Tile& tile, int, int, double own_x, double own_y) {
      height = tile.ground->field.height(own_x, own_y);
      return height.has_value();
    });
    return height;
  }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return closest(ray, from, true, stats, [&](const Tile& tile, std::uint32_t, const Ray& own, MarchStats* march) {
      return march_.cpu(target(tile), own, {}, march);
    });
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    const bool from_above = rules.sides == Sides::above;
    return closest(ray, from, from_above, stats,
                   [&](const Tile& tile, std::uint32_t part, const Ray& own, MarchStats* march) {
                     const HitFilter accept = [&](Hit hit) {
                       hit.part = part;
                       return (*rules.accept)(hit);
                     };
                     return march_.by_rules(target(tile), own, {rules.sides, rules.accept ? &accept : nullptr}, march);
                   });
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    bool blocked = false;
    const Starts starts = find_starts(ray, from);
    for_each_on_way(ray, Hit{}, true, [&](const Tile& tile, int col, int row, bool) {
      return blocked = march_.occluded(target(tile), own_ray(ray, col, row, starts), {});
    });
    return blocked;
  }

  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    const Tile& tile = tile_of(hit);
    const int col = static_cast<int>(hit.part % static_cast<std::uint32_t>(layout_.cols)),
              row = static_cast<int>(hit.part / static_cast<std::uint32_t>(layout_.cols));
    return {.normal = tile.ground->field.normal(hit.cell, hit.u, hit.v),
            .shading_normal = shading_normal(tile, col, row, hit.cell, hit.u, hit.v),
            .material = material(ray, hit),
            .height = hit.height};
  }
  std::string no_contacts() const override { return {}; }
  std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const override {
    std::optional<FieldContact> best;
    for_each_tile([&](const Tile& tile, int col, int row, const WorldBox& box) {
      const dvec3 corner = map_->corner(col, row);
      const double last = best ? best->t : 1;
      if (sweep_bound(capsule, motion, box.low, box.high, last) > last) return;
      const auto found = scarp::sweep(target(tile), {capsule.a - corner, capsule.b - corner, capsule.radius}, motion);
      if (!found || (best && found->t >= best->t)) return;
      best = FieldContact{*found, {.cell = found->cell, .part = number(col, row)}};
      best->point += corner;
    });
    return best;
  }
  bool overlaps(const TurnedBox& box) const override {
    bool found = false;
    for_each_tile([&](const Tile& tile, int col, int row, const WorldBox& ground) {
      if (found || !scarp::overlaps(box, ground.low, ground.high)) return;
      TurnedBox own = box;
      own.centre -= map_->corner(col, row);
      found = scarp::overlaps(target(tile), own);
    });
    return found;
  }
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const override {
    std::optional<FieldPoint> best;
    for_each_tile([&](const Tile& tile, int col, int row, const WorldBox& box) {
      const dvec3 corner = map_->corner(col, row);
      const double most = best ? best->distance : max_distance;
      if (length(min(max(p, box.low), box.high) - p) > most) return;
      const auto found = scarp::closest_point(target(tile), p - corner, most);
      if (!found || (best && found->distance >= best->distance)) return;
      best = FieldPoint{
          found->point + corner, found->normal, found->distance, {.cell = found->cell, .part = number(col, row)}};
    });
    return best;
  }
  int material(const Ray&, const Hit& hit) const override { return tile_of(hit).material(hit.cell); }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    std::optional<FieldSurface> found;
    map_->at(p.x, p.y, [&](const Tile& tile, int col, int row, double x, double y) {
      const HeightField& field = tile.ground->field;
      const auto place = field.place(x, y);
      const auto height = field.height(x, y);
      if (!place || !height || p.z > *height) return false;
      const auto& [cell, u, v] = field.ground_at(*place);
      found = FieldSurface{.normal = field.normal(cell, u, v),
                           .shading_normal = shading_normal(tile, col, row, cell, u, v),
                           .material = tile.material(cell)};
      return true;
    });
    return found;
  }
  Ray started(const Ray& ray, const Hit* from) const override {
    Ray r = ray;
    r.start = from ? RayStart::on_surface : RayStart::free;
    if (from) r.start_cell = from->cell;
    return r;
  }

 private:
  // The tiles on which a ray from the surface starts: several at a seam.
  struct Starts {
    int count = 0;
    std::uint32_t part[4];
    Cell cell[4];
  };

  // Calls f(tile, col, row, box) for the tiles that have ground.
  template <class F>
  void for_each_tile(const F& f) const {
    for (int row = 0; row < layout_.rows; ++row) {
      for (int col = 0; col < layout_.cols; ++col) {
        const Tile* tile = map_->find(col, row);
        if (tile && !tile->ground->field.all_nodata()) f(*tile, col, row, box_of(*tile, col, row));
      }
    }
  }
  WorldBox box_of(const Tile& tile, int col, int row) const {
    const HeightField& field = tile.ground->field;
    const dvec3 low = map_->corner(col, row);
    return {{low.x, low.y, field.min_height()}, {low.x + field.width(), low.y + field.depth(), field.max_height()}};
  }

  const Tile& tile_of(const Hit& hit) const {
    const auto cols = static_cast<std::uint32_t>(layout_.cols);
    return *map_->find(static_cast<int>(hit.part % cols), static_cast<int>(hit.part / cols));
  }
  std::uint32_t number(int col, int row) const {
    return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(layout_.cols) + static_cast<std::uint32_t>(col);
  }
  static HeightTarget target(const Tile& tile) {
    return {&tile.ground->field, &tile.ground->pyramid, std::numeric_limits<double>::quiet_NaN(), kTileSeam,
            tile.seam_step};
  }

  Starts find_starts(const Ray& ray, const Hit* from) const {
    Starts starts;
    if (!from && ray.start != RayStart::on_surface) return starts;
    const dvec3 p = ray.at(ray.t_min);
    const auto add = [&](std::uint32_t part, const Cell& cell) {
      if (starts.count == 4) return;
      starts.part[starts.count] = part;
      starts.cell[starts.count++] = cell;
    };
    if (from) add(from->part, from->cell);
    map_->at(p.x, p.y, [&](const Tile& tile, int col, int row, double x, double y) {
      if (from && number(col, row) == from->part) return false;
      const HeightField& field = tile.ground->field;
      if (const auto place = field.place(x, y)) {
        const auto ground = field.ground_at(*place);
        // Uses the caller's cell if it is the cell at the point or an adjacent one: rounding may decide between them.
        const Cell own = ray.start_cell;
        const bool near = !from && std::abs(own.col - ground.cell.col) <= 1 && std::abs(own.row - ground.cell.row) <= 1;
        if (field.cell_heights(near ? own : ground.cell)) add(number(col, row), near ? own : ground.cell);
      }
      return false;
    });
    return starts;
  }

  // tile_hit(tile, part, ray, stats) returns the closest hit on one tile.
  template <class March>
  Hit closest(const Ray& ray, const Hit* from, bool only_from_above, MarchStats* stats, const March& tile_hit) const {
    Hit best;
    if (stats) *stats = {};
    const Starts starts = find_starts(ray, from);
    for_each_on_way(ray, best, only_from_above, [&](const Tile& tile, int col, int row, bool first) {
      Ray own = own_ray(ray, col, row, starts);
      if (best) own.t_max = starts.count > 0 ? std::nextafter(best.t, std::numeric_limits<double>::infinity()) : best.t;
      own.t_max = std::min(own.t_max, ray.t_max);
      MarchStats march;
      Hit hit = tile_hit(tile, number(col, row), own, stats ? &march : nullptr);
      if (stats)
        stats->steps += march.steps, stats->level_changes += march.level_changes, stats->cell_tests += march.cell_tests,
            ++stats->boxes;
      hit.part = number(col, row);
      if (hit) {
        if (!best || hit.t < best.t || (hit.t == best.t && hit.part < best.part)) best = hit;
      } else if (hit.status == HitStatus::below && first && !best) {
        best.status = hit.status;
      }
      return false;
    });
    return best;
  }

  Ray own_ray(const Ray& ray, int col, int row, const Starts& starts) const {
    Ray own = ray;
    own.origin -= map_->corner(col, row);
    own.start = RayStart::free;
    for (int i = 0; i < starts.count; ++i) {
      if (starts.part[i] != number(col, row)) continue;
      own.start = RayStart::on_surface;
      own.start_cell = starts.cell[i];
    }
    return own;
  }

  // Calls f(tile, col, row, first) for the tiles that the ray may hit before the hit `best`, nearest first to within a
  // cell, until f returns true. `only_from_above`: skips tiles whose ground the ray stays above. `first`: whether the
  // ray is over this tile where it reaches the terrain.
  template <class F>
  void for_each_on_way(const Ray& ray, const Hit& best, bool only_from_above, const F& f) const {
    if (box_.empty() || !is_followable(ray)) return;
    const dvec3& o = ray.origin;
    const dvec3& d = ray.direction;
    const double width = map_->tile_width(), depth = map_->tile_depth();
    // Tiles are widened by a cell, far more than rounding: an unnecessary test of a tile costs little.
    const double wide_x = layout_.ground.cell_x + std::abs(o.x) * 0x1p-48,
                 wide_y = layout_.ground.cell_y + std::abs(o.y) * 0x1p-48;
    Span whole{ray.t_min, ray.t_max};
    whole = between(-wide_x, layout_.cols * width + wide_x, o.x, d.x, whole);
    whole = between(-wide_y, layout_.rows * depth + wide_y, o.y, d.y, whole);
    if (whole.empty()) return;
    // Where the ray enters the terrain, or starts over it.
    const Span over =
        between(0, layout_.rows * depth, o.y, d.y, between(0, layout_.cols * width, o.x, d.x, {ray.t_min, ray.t_max}));
    const double begin_x = along(o.x, d.x, over.begin), begin_y = along(o.y, d.y, over.begin);
    const auto begins_in = [&](int col, int north) {
      const double slack_x = kTileSeam * wide_x, slack_y = kTileSeam * wide_y;
      return begin_x >= col * width - slack_x && begin_x <= (col + 1) * width + slack_x &&
             begin_y >= north * depth - slack_y && begin_y <= (north + 1) * depth + slack_y;
    };
    const auto done = [&](const Span& span) { return span.begin > best.t && best; };
    // The range of tiles between two coordinates, in the order in which the ray crosses them.
    const auto range = [](double from, double to, double wide, double length, int count, bool forward, int& first,
                          int& last) {
      const double low = std::floor((std::min(from, to) - wide) / length);
      const double high = std::floor((std::max(from, to) + wide) / length);
      first = static_cast<int>(std::clamp(low, 0.0, count - 1.0));
      last = static_cast<int>(std::clamp(high, 0.0, count - 1.0));
      if (!forward) std::swap(first, last);
    };
    int first_col, last_col;
    range(along(o.x, d.x, whole.begin), along(o.x, d.x, whole.end), wide_x, width, layout_.cols, d.x >= 0, first_col,
          last_col);
    const int col_step = d.x >= 0 ? 1 : -1, north_step = d.y >= 0 ? 1 : -1;
    for (int col = first_col; col != last_col + col_step; col += col_step) {
      const Span in_col = between(col * width - wide_x, (col + 1) * width + wide_x, o.x, d.x, whole);
      if (in_col.empty()) continue;
      if (done(in_col)) return;
      int first_north, last_north;  // rows counted from the south
      range(along(o.y, d.y, in_col.begin), along(o.y, d.y, in_col.end), wide_y, depth, layout_.rows, d.y >= 0,
            first_north, last_north);
      for (int north = first_north; north != last_north + north_step; north += north_step) {
        const Span span = between(north * depth - wide_y, (north + 1) * depth + wide_y, o.y, d.y, in_col);
        if (span.empty()) continue;
        if (done(span)) break;
        const int row = layout_.rows - 1 - north;
        const Tile* tile = map_->find(col, row);
        if (!tile || (only_from_above && above(*tile, ray, span))) continue;
        if (f(*tile, col, row, begins_in(col, north))) return;
      }
    }
  }

  // Whether the ray is above all ground of a tile, by more than rounding.
  bool above(const Tile& tile, const Ray& ray, const Span& span) const {
    const HeightField& field = tile.ground->field;
    if (field.all_nodata()) return true;
    const double lowest = along(ray.origin.z, ray.direction.z, ray.direction.z < 0 ? span.end : span.begin);
    const double highest = field.max_height();
    // Products below the smallest normal number have a larger relative rounding error.
    const double rounding = 0x1p-40 * (std::abs(ray.origin.z) + std::abs(lowest) + std::abs(highest));
    return lowest - highest > rounding + std::numeric_limits<double>::min();
  }

  // As HeightField::shading_normal(), with the heights of adjacent tiles at the borders.
  dvec3 shading_normal(const Tile& tile, int col, int row, Cell cell, double u, double v) const {
    const HeightField& field = tile.ground->field;
    const bool inner = cell.col > 0 && cell.row > 0 && cell.col + 2 < field.cols() && cell.row + 2 < field.rows();
    if (inner) return field.shading_normal(cell, u, v);
    const double cell_x = field.settings().cell_x, cell_y = field.settings().cell_y;
    const dvec3 corner = map_->corner(col, row);
    const auto slope = [&](double x, double y, double dx, double dy) {
      const auto ahead = height(x + dx, y + dy), behind = height(x - dx, y - dy), here = height(x, y);
      if ((!ahead && !behind) || !here) return 0.0;
      return (ahead.value_or(*here) - behind.value_or(*here)) / ((dx + dy) * (ahead && behind ? 2 : 1));
    };
    dvec2 sum(0.0);
    for (int dr = 0; dr < 2; ++dr) {
      for (int dc = 0; dc < 2; ++dc) {
        const double weight = (dc ? u : 1 - u) * (dr ? v : 1 - v);
        const double x = corner.x + (cell.col + dc) * cell_x,
                     y = corner.y + (field.rows() - 1 - cell.row - dr) * cell_y;
        sum += weight * dvec2(slope(x, y, cell_x, 0), slope(x, y, 0, cell_y));
      }
    }
    return normalize(dvec3(-sum.x, -sum.y, 1.0));
  }

  std::shared_ptr<const TileMap> map_;
  const TileLayout& layout_;
  const HeightMarchEntry& march_;
  WorldBox box_;
  std::int64_t elements_ = 0;
};

}  // namespace

SceneFieldPtr scene_tiles(std::shared_ptr<const TileMap> map, const HeightMarchEntry& march) {
  return std::make_shared<Tiles>(std::move(map), march);
}

}  // namespace scarp
