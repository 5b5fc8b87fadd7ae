// SPDX-License-Identifier: MIT
// Tiles as one field of a scene: each tile on the ray's path is traced by its own march; the closest hit counts; at the
// same t, the tile with the lower number.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/base/parallel.h"
#include "scarp/base/prefetch.h"
#include "scarp/march/height/closest_point.h"
#include "scarp/march/height/ground_contact.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/tile_fan.h"
#include "scarp/scene/tile_map.h"
#include "scarp/scene/tile_queues.h"
#include "scarp/scene/tile_walk.h"

namespace scarp {
namespace {

// Batches of fewer rays at a tile are traced ray by ray.
constexpr std::size_t kFewForVectors = 16;
// Number of rays of a batch that a thread takes at a time: enough to fill the queues of many tiles.
constexpr std::int64_t kLeastPiece = 256, kMostPiece = 1 << 14;

class Tiles final : public SceneField {
 public:
  Tiles(std::shared_ptr<const TileMap> map, const HeightMarchEntry& march)
      : map_(std::move(map)), layout_(map_->layout), march_(march), box_(ground_box()), grid_(*map_, box_.high.z) {
    for (int row = 0; row < layout_.rows; ++row) {
      for (int col = 0; col < layout_.cols; ++col) {
        if (const Tile* tile = map_->find(col, row))
          elements_ += std::int64_t{tile->ground->field.cols()} * tile->ground->field.rows();
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
      return march_.cpu(target_of(tile), own, {}, march);
    });
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    const bool from_above = rules.sides == Sides::above;
    return closest(
        ray, from, from_above, stats, [&](const Tile& tile, std::uint32_t part, const Ray& own, MarchStats* march) {
          const HitFilter accept = [&](Hit hit) {
            hit.part = part;
            return (*rules.accept)(hit);
          };
          return march_.by_rules(target_of(tile), own, {rules.sides, rules.accept ? &accept : nullptr}, march);
        });
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    if (box_.empty()) return false;
    const Starts starts = find_starts(ray, from);
    TileWalk walk(grid_, ray, true);
    while (const Tile* tile = walk.next(grid_, ray, kNever)) {
      if (march_.occluded(target_of(*tile), own_ray(ray, walk.col(), walk.row(), starts), {})) return true;
    }
    return false;
  }

  bool likes_batches() const override { return march_.simd; }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::closest_hits(rays, hits, from);
    ClosestBatch(*this, rays, from, hits).run();
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::occluded(rays, blocked, from);
    AnyBatch(*this, rays, from, blocked).run();
  }
  void closest_hits_on_all_threads(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                                   std::span<const Hit* const> from) const override {
    if (!march_.simd || !steps.empty()) return SceneField::closest_hits_on_all_threads(rays, hits, steps, from);
    if (march_.fans && from.empty() && !box_.empty()) {
      const auto others = [&](std::span<const std::uint32_t> left) { closest_hits_of(left, rays, hits); };
      if (const auto fan = find_fan(rays); fan && closest_hits_in_tile_fan(grid_, *fan, rays, hits, others)) return;
    }
    for_each_piece(rays, from, [&](std::size_t first, std::span<const Ray> some, std::span<const Hit* const> starts) {
      closest_hits(some, hits.subspan(first, some.size()), starts);
    });
  }
  void occluded_on_all_threads(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                               std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::occluded_on_all_threads(rays, blocked, from);
    for_each_piece(rays, from, [&](std::size_t first, std::span<const Ray> some, std::span<const Hit* const> starts) {
      occluded(some, blocked.subspan(first, some.size()), starts);
    });
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
      const auto found =
          scarp::sweep(target_of(tile), {capsule.a - corner, capsule.b - corner, capsule.radius}, motion);
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
      found = scarp::overlaps(target_of(tile), own);
    });
    return found;
  }
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const override {
    std::optional<FieldPoint> best;
    for_each_tile([&](const Tile& tile, int col, int row, const WorldBox& box) {
      const dvec3 corner = map_->corner(col, row);
      const double most = best ? best->distance : max_distance;
      if (length(min(max(p, box.low), box.high) - p) > most) return;
      const auto found = scarp::closest_point(target_of(tile), p - corner, most);
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
  WorldBox ground_box() const {
    WorldBox box;
    for_each_tile([&](const Tile&, int, int, const WorldBox& of_tile) { box = around(box, of_tile); });
    return box;
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

  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // tile_hit(tile, part, ray, stats) returns the closest hit on one tile.
  template <class March>
  Hit closest(const Ray& ray, const Hit* from, bool only_from_above, MarchStats* stats, const March& tile_hit) const {
    Hit best;
    if (stats) *stats = {};
    if (box_.empty()) return best;
    const Starts starts = find_starts(ray, from);
    TileWalk walk(grid_, ray, only_from_above);
    while (const Tile* tile = walk.next(grid_, ray, best.t)) {
      const int col = walk.col(), row = walk.row();
      Ray own = own_ray(ray, col, row, starts);
      end_at(best, starts, own);
      MarchStats march;
      const Hit hit = tile_hit(*tile, number(col, row), own, stats ? &march : nullptr);
      if (stats)
        stats->steps += march.steps, stats->level_changes += march.level_changes, stats->cell_tests += march.cell_tests,
            ++stats->boxes;
      take(ray, hit, col, row, best);
    }
    return best;
  }

  // Hits at the same t on a tile with a lower number count.
  static void end_at(const Hit& best, const Starts& starts, Ray& own) {
    if (best) own.t_max = std::min(own.t_max, starts.count > 0 ? std::nextafter(best.t, kNever) : best.t);
  }
  // Replaces `best` by a better hit on a tile.
  void take(const Ray& ray, const Hit& hit, int col, int row, Hit& best) const {
    const std::uint32_t part = number(col, row);
    if (hit) {
      if (best && !(hit.t < best.t || (hit.t == best.t && part < best.part))) return;
      best = hit;
      best.part = part;
    } else if (hit.status == HitStatus::below && !best && grid_.begins_on(ray, col, row)) {
      best.status = hit.status;
    }
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

  // Answers some of the rays, by their indices.
  void closest_hits_of(std::span<const std::uint32_t> some, std::span<const Ray> rays, std::span<Hit> hits) const {
    std::vector<Ray> asked;
    for (const std::uint32_t i : some) asked.push_back(rays[i]);
    std::vector<Hit> answers(asked.size());
    closest_hits(asked, answers, {});
    for (std::size_t j = 0; j < some.size(); ++j) hits[some[j]] = answers[j];
  }

  // Calls piece(first, rays, from) on all threads.
  template <class Piece>
  static void for_each_piece(std::span<const Ray> rays, std::span<const Hit* const> from, const Piece& piece) {
    const auto count = static_cast<std::int64_t>(rays.size());
    parallel_for(count, std::clamp(count / 8, kLeastPiece, kMostPiece), [&](std::int64_t begin, std::int64_t end) {
      const auto first = static_cast<std::size_t>(begin), some = static_cast<std::size_t>(end - begin);
      piece(first, rays.subspan(first, some), from.empty() ? from : from.subspan(first, some));
    });
  }

  // A batch on one thread: rays wait at their tiles (tile_queues.h). Each ray takes the same tiles as alone, with the
  // same range. The answer type decides between closest hits and occlusion.
  template <class Answer>
  class Batch {
   public:
    Batch(const Tiles& tiles, std::span<const Ray> rays, std::span<const Hit* const> from, std::span<Answer> answers)
        : tiles_(tiles),
          rays_(rays),
          from_(from),
          answers_(answers),
          queues_(std::int64_t{tiles.layout_.cols} * tiles.layout_.rows) {}

    void run() {
      std::fill(answers_.begin(), answers_.end(), Answer{});
      if (tiles_.box_.empty()) return;
      for (std::size_t i = 0; i < rays_.size(); ++i) begin(static_cast<std::uint32_t>(i));
      queues_.run([this](std::uint32_t part, const std::vector<Waiting>& waiting) { trace(part, waiting); });
    }

   private:
    static constexpr bool any = std::is_same_v<Answer, std::uint8_t>;
    static constexpr std::size_t kAhead = 8;  // rays prefetched ahead
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    struct Waiting {
      std::uint32_t ray;
      std::uint32_t walk;    // index into walks_; kNone: there are no further tiles
      std::uint32_t starts;  // index into starts_; kNone: the ray starts free
    };

    void begin(std::uint32_t i) {
      const Ray& ray = rays_[i];
      const Hit* from = from_.empty() ? nullptr : from_[i];
      Waiting waiting{i, kNone, kNone};
      if (from || (from_.empty() && ray.start == RayStart::on_surface)) {
        if (!is_followable(ray)) return;
        starts_.push_back(tiles_.find_starts(ray, from));
        if (starts_.back().count > 0) waiting.starts = static_cast<std::uint32_t>(starts_.size() - 1);
      }
      int col, row;
      if (tiles_.grid_.only_tile(ray, col, row) && is_followable(ray)) {
        const auto [tile, highest] = tiles_.grid_.at(col, row);
        if (tile && !is_above(highest, ray, {ray.t_min, ray.t_max})) queues_.push(tiles_.number(col, row), waiting);
        return;
      }
      TileWalk walk(tiles_.grid_, ray, true);
      if (!walk.next(tiles_.grid_, ray, kNever)) return;
      waiting.walk = static_cast<std::uint32_t>(walks_.size());
      walks_.push_back(walk);
      queues_.push(tiles_.number(walk.col(), walk.row()), waiting);
    }

    void trace(std::uint32_t part, const std::vector<Waiting>& waiting) {
      const int col = static_cast<int>(part % static_cast<std::uint32_t>(tiles_.layout_.cols)),
                row = static_cast<int>(part / static_cast<std::uint32_t>(tiles_.layout_.cols));
      const HeightTarget on = target_of(*tiles_.map_->find(col, row));
      const dvec3 corner = tiles_.map_->corner(col, row);
      own_.clear();
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        const Waiting& one = waiting[i];
        if (i + kAhead < waiting.size()) prefetch_ray(waiting[i + kAhead].ray);
        const Ray& ray = rays_[one.ray];
        if (one.starts == kNone) {
          own_.push_back(ray);
          own_.back().origin -= corner;
          own_.back().start = RayStart::free;
          if constexpr (!any) end_at(answers_[one.ray], {}, own_.back());
        } else {
          own_.push_back(tiles_.own_ray(ray, col, row, starts_[one.starts]));
          if constexpr (!any) end_at(answers_[one.ray], starts_[one.starts], own_.back());
        }
      }
      if (found_.size() < own_.size()) found_.resize(own_.size());
      answer(on, std::span(found_).first(own_.size()));
      for (std::size_t i = 0; i < waiting.size(); ++i) go_on(waiting[i], col, row, found_[i]);
    }
    void prefetch_ray(std::uint32_t ray) const {
      const auto* begin = reinterpret_cast<const char*>(&rays_[ray]);
      prefetch(begin), prefetch(begin + 64);  // two cache lines
      prefetch(&answers_[ray]);
    }
    void answer(const HeightTarget& on, std::span<Answer> found) {
      if constexpr (any) {
        if (own_.size() >= kFewForVectors) return tiles_.march_.occluded_batch(on, own_, found, {});
        for (std::size_t i = 0; i < own_.size(); ++i) found[i] = tiles_.march_.occluded(on, own_[i], {});
      } else {
        if (own_.size() >= kFewForVectors) return tiles_.march_.batch(on, own_, found, {});
        for (std::size_t i = 0; i < own_.size(); ++i) found[i] = tiles_.march_.cpu(on, own_[i], {}, nullptr);
      }
    }
    void go_on(const Waiting& one, int col, int row, const Answer& found) {
      const Ray& ray = rays_[one.ray];
      Answer& answer = answers_[one.ray];
      if constexpr (any) {
        if ((answer = found)) return;
      } else {
        tiles_.take(ray, found, col, row, answer);
      }
      if (one.walk == kNone) return;
      TileWalk& walk = walks_[one.walk];
      double until = kNever;
      if constexpr (!any) until = answer.t;
      if (walk.next(tiles_.grid_, ray, until)) queues_.push(tiles_.number(walk.col(), walk.row()), one);
    }

    const Tiles& tiles_;
    std::span<const Ray> rays_;
    std::span<const Hit* const> from_;
    std::span<Answer> answers_;
    TileQueues<Waiting> queues_;
    KeptVector<TileWalk> walks_;
    std::vector<Starts> starts_;
    KeptVector<Ray> own_;
    KeptVector<Answer> found_;
  };
  using ClosestBatch = Batch<Hit>;
  using AnyBatch = Batch<std::uint8_t>;

  std::shared_ptr<const TileMap> map_;
  const TileLayout& layout_;
  const HeightMarchEntry& march_;
  WorldBox box_;
  TileGrid grid_;
  std::int64_t elements_ = 0;
};

}  // namespace

SceneFieldPtr scene_tiles(std::shared_ptr<const TileMap> map, const HeightMarchEntry& march) {
  return std::make_shared<Tiles>(std::move(map), march);
}

}  // namespace scarp
