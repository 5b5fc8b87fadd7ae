// SPDX-License-Identifier: MIT
// Height fields in scenes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/find_entry.h"
#include "scarp/march/height/closest_point.h"
#include "scarp/march/height/ground_contact.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/height/wall.h"
#include "scarp/march/sampling/shrink_factor.h"
#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerCopy = 4096;
// Maximum distance or overlap, in cells, at which placed neighbours still meet without a gap. The origin of each is
// rounded by 2^-53 of itself along every axis, and transforming a ray from world to field space takes 8 roundings of
// their distance: together less than 16 for both, if neither is beyond 2^23 cells (an earth-centred field with cells of
// 1 m).
constexpr double kSeam = 0x1p-26;
constexpr const char* kNotOnCpu =
    "scene: these heights were made for a back end, and nothing was built for rays on the CPU";

class Heights final : public SceneField {
 public:
  Heights(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings, AnsweredBy answered_by)
      : field_(std::move(field)), march_(march), settings_(settings), answered_by_(answered_by) {
    validate(settings_);
    require_field(field_, march.fields, march.name);
    if (answered_by == AnsweredBy::back_end) return;
    if (march.needs_pyramid) pyramid_.emplace(field_);
    if (march.needs_slope) slope_ = slope_bound(field_);
  }
  Heights(HeightField field, MaxPyramid pyramid, CellMaterials materials)
      : field_(std::move(field)),
        march_(find_height_march("max-mip")),
        answered_by_(AnsweredBy::cpu),
        pyramid_(std::move(pyramid)),
        materials_(std::move(materials)) {
    require_materials(field_, materials_);
  }

  std::optional<std::uint64_t> edits() const override { return field_.edits(); }
  bool outdated() const override {
    return (pyramid_ ? pyramid_->edits() : !std::isnan(slope_) ? slope_edits_ : field_.edits()) != field_.edits();
  }
  SceneFieldPtr rebuilt() const override { return marched_by(march_, answered_by_); }
  const std::weak_ptr<const void>* memory() const override { return field_.memory(); }

  std::string_view kind() const override { return "heights"; }
  std::string_view march() const override { return march_.name; }
  Sampling sampling() const override { return march_.sampling; }
  std::string caveat() const override {
    if (march_.sampling != Sampling::lipschitz || settings_.lipschitz.shrink == 0) return {};
    return lipschitz_caveat(settings_.lipschitz, std::isnan(slope_) ? slope_bound(field_) : slope_);
  }
  std::optional<WorldBox> box() const override {
    if (nothing()) return WorldBox{};
    // Walls of solid ground reach as deep as any ray.
    if (field_.settings().solid || field_.wraps()) return {};
    return ground_box();
  }
  std::optional<WorldBox> extent() const override {
    if (field_.wraps()) return {};
    return nothing() ? WorldBox{} : ground_box();
  }
  std::optional<double> height(double x, double y) const override { return field_.height(x, y); }
  std::int64_t elements() const override { return std::int64_t{field_.cols()} * field_.rows(); }
  double cell_side() const override { return std::min(field_.settings().cell_x, field_.settings().cell_y); }
  SceneFieldPtr judge() const override { return marched_by(find_height_march("exhaustive"), AnsweredBy::cpu); }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return march_.cpu(target(), from ? started(ray, from) : ray, settings_, stats);
  }
  std::string no_trace() const override { return march_.traced ? "" : records_nothing(height_marches(), march_.name); }
  Hit traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const override {
    return march_.traced ? march_.traced(target(), ray, settings_, stats, trace)
                         : SceneField::traced_hit(ray, stats, trace);
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    if (!march_.by_rules) {
      throw Error(
          fmt::format("scene: the march {} has hits from above only, without a filter (use max-mip)", march_.name));
    }
    return march_.by_rules(target(), from ? started(ray, from) : ray, rules, stats);
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    const Ray r = from ? started(ray, from) : ray;
    return march_.occluded(target(), r, settings_);
  }
  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    if (hit.wall) {
      const dvec3 normal = wall_normal(ray, hit);
      return {.normal = normal, .shading_normal = normal, .material = material(ray, hit), .wall = true};
    }
    return {.normal = field_.normal(hit.cell, hit.u, hit.v),
            .shading_normal = field_.shading_normal(hit.cell, hit.u, hit.v),
            .material = material(ray, hit),
            .height = height_at(hit)};
  }
  void prefetch_surface(const Hit& hit) const override { field_.prefetch_around(hit.cell); }
  std::string no_contacts() const override {
    if (answered_by_ == AnsweredBy::back_end) return kNotOnCpu;
    if (!pyramid_) return fmt::format("scene: contacts need the march max-mip, not {}", march_.name);
    return field_.wraps() ? "scene: contacts need heights that do not wrap round (exclude them by their mask)" : "";
  }
  std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const override {
    const auto found = scarp::sweep(with_pyramid(), capsule, motion);
    if (!found) return {};
    return FieldContact{*found, {.cell = found->cell}};
  }
  bool overlaps(const TurnedBox& box) const override { return scarp::overlaps(with_pyramid(), box); }
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const override {
    const auto found = scarp::closest_point(with_pyramid(), p, max_distance);
    if (!found) return {};
    return FieldPoint{found->point, found->normal, found->distance, {.cell = found->cell}};
  }
  int material(const Ray&, const Hit& hit) const override { return material_of(hit.cell); }

  std::optional<FieldSurface> within(const dvec3& p) const override {
    const auto place = field_.place(p.x, p.y);
    const auto height = field_.height(p.x, p.y);
    if (!place || !height || p.z > *height) return {};
    const auto& [cell, u, v] = *place;
    return FieldSurface{.normal = field_.normal(cell, u, v),
                        .shading_normal = field_.shading_normal(cell, u, v),
                        .material = material_of(cell)};
  }

  std::optional<HeightTarget> fan_target() const override {
    return march_.fans && pyramid_ ? std::optional(target()) : std::nullopt;
  }
  bool likes_batches() const override { return march_.simd; }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::closest_hits(rays, hits, from);
    if (from.empty()) return march_.batch(target(), rays, hits, settings_);
    march_.batch(target(), begun(rays, from), hits, settings_);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::occluded(rays, blocked, from);
    if (from.empty()) return march_.occluded_batch(target(), rays, blocked, settings_);
    march_.occluded_batch(target(), begun(rays, from), blocked, settings_);
  }
  // Sorts the rays by the ground below their origins, if that is faster (march/height/queries.h).
  void closest_hits_on_all_threads(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                                   std::span<const Hit* const> from) const override {
    if (!steps.empty()) return SceneField::closest_hits_on_all_threads(rays, hits, steps, from);
    if (from.empty()) return scarp::closest_hits(target(), rays, hits, march_, settings_);
    scarp::closest_hits(target(), begun_on_all_threads(rays, from), hits, march_, settings_);
  }
  void occluded_on_all_threads(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                               std::span<const Hit* const> from) const override {
    if (from.empty()) return scarp::occluded(target(), rays, blocked, march_, settings_);
    scarp::occluded(target(), begun_on_all_threads(rays, from), blocked, march_, settings_);
  }
  SceneFieldParts parts() const override { return {SceneFieldParts::Heights{&field_, &march_, &settings_, kSeam}}; }
  // A ray from a wall starts free: the wall is behind it.
  Ray started(const Ray& ray, const Hit* from) const override {
    Ray r = ray;
    r.start = RayStart::free;
    if (from && !from->wall) {
      r.start = RayStart::on_surface;
      r.start_cell = from->cell;
    }
    return r;
  }

 private:
  SceneFieldPtr marched_by(const HeightMarchEntry& march, AnsweredBy answered_by) const {
    auto field = std::make_shared<Heights>(field_, march, settings_, answered_by);
    field->materials_ = materials_;
    return field;
  }
  int material_of(Cell cell) const {
    if (!materials_) return 0;
    return 1 + (*materials_)[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(field_.cell_cols()) +
                             static_cast<std::size_t>(cell.col)];
  }
  bool nothing() const { return !field_.has_cells() || field_.all_nodata(); }
  WorldBox ground_box() const {
    return {{0, 0, field_.min_height()}, {field_.width(), field_.depth(), field_.max_height()}};
  }
  double height_at(const Hit& hit) const {
    const CellHeights h = field_.cell_heights(hit.cell).value();
    const double north = h.h00 + hit.u * (h.h10 - h.h00), south = h.h01 + hit.u * (h.h11 - h.h01);
    return field_.height_from_sample(north + hit.v * (south - north));
  }
  std::vector<Ray> begun(std::span<const Ray> rays, std::span<const Hit* const> from) const {
    std::vector<Ray> r(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) r[i] = started(rays[i], from[i]);
    return r;
  }
  std::vector<Ray> begun_on_all_threads(std::span<const Ray> rays, std::span<const Hit* const> from) const {
    std::vector<Ray> r(rays.size());
    parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerCopy, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
        r[i] = started(rays[i], from[i]);
    });
    return r;
  }
  HeightTarget with_pyramid() const {
    if (const std::string why = no_contacts(); !why.empty()) throw Error(why);
    return target();
  }
  HeightTarget target() const {
    if (answered_by_ == AnsweredBy::back_end) throw Error(kNotOnCpu);
    return {&field_, pyramid_ ? &*pyramid_ : nullptr, slope_, kSeam};
  }

  HeightField field_;
  const HeightMarchEntry& march_;
  MarchSettings settings_;
  AnsweredBy answered_by_;
  std::optional<MaxPyramid> pyramid_;
  CellMaterials materials_;  // null: that of the object
  double slope_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t slope_edits_ = field_.edits();  // when the slope was taken
};

}  // namespace

SceneFieldPtr scene_heights(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings,
                            AnsweredBy answered_by) {
  return std::make_shared<Heights>(std::move(field), march, settings, answered_by);
}

SceneFieldPtr scene_heights(HeightField field, MaxPyramid pyramid, CellMaterials materials) {
  return std::make_shared<Heights>(std::move(field), std::move(pyramid), std::move(materials));
}

void require_materials(const HeightField& field, const CellMaterials& materials) {
  const std::int64_t cells = std::int64_t{field.cell_cols()} * field.cell_rows();
  if (!materials || static_cast<std::int64_t>(materials->size()) == cells) return;
  throw Error(fmt::format("heights: {} materials for {} x {} cells (one for each cell)", materials->size(),
                          field.cell_cols(), field.cell_rows()));
}

}  // namespace scarp
