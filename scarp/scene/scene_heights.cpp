// SPDX-License-Identifier: MIT
// Height fields in scenes.
#include <algorithm>
#include <utility>
#include <vector>

#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/height/wall.h"
#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

FieldHit field_hit(const Hit& hit) { return {hit.status, hit.t, hit}; }

class Heights final : public SceneField {
 public:
  Heights(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings)
      : field_(std::move(field)), march_(march), settings_(settings) {
    if (field_.wraps()) throw Error("heights in a scene: the field must not wrap round");
    validate(settings_);
    if (march.needs_pyramid) pyramid_.emplace(field_);
    if (march.needs_slope) slope_ = slope_bound(field_);
  }

  std::string_view kind() const override { return "heights"; }
  std::string_view march() const override { return march_.name; }
  std::optional<WorldBox> box() const override {
    if (!field_.has_cells() || field_.all_nodata()) return WorldBox{};
    // Solid ground has walls as deep as anybody asks.
    if (field_.settings().solid) return {};
    return WorldBox{{0, 0, field_.min_height()}, {field_.width(), field_.depth(), field_.max_height()}};
  }
  std::optional<double> height(double x, double y) const override { return field_.height(x, y); }

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    return field_hit(march_.cpu(target(), started(ray, from, false), settings_, stats));
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    const Ray r = started(ray, from, true);
    return march_.occluded(target(), r, settings_);
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const Hit& own = std::get<Hit>(hit.own);
    if (own.wall) {
      const dvec3 normal = wall_normal(ray, own);
      return {normal, normal, {}};
    }
    return {field_.normal(own.cell, own.u, own.v), field_.shading_normal(own.cell, own.u, own.v), {}};
  }

  std::optional<FieldSurface> within(const dvec3& p) const override {
    const auto place = field_.place(p.x, p.y);
    const auto height = field_.height(p.x, p.y);
    if (!place || !height || p.z > *height) return {};
    const auto& [cell, u, v] = *place;
    return FieldSurface{field_.normal(cell, u, v), field_.shading_normal(cell, u, v), {}};
  }

  bool likes_batches() const override { return march_.simd; }
  void closest_hits(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                    std::span<FieldHit> hits) const override {
    std::vector<Hit> own(rays.size());
    march_.batch(target(), begun(rays, from), own, settings_);
    std::transform(own.begin(), own.end(), hits.begin(), field_hit);
  }
  void occluded(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                std::span<std::uint8_t> blocked) const override {
    march_.occluded_batch(target(), begun(rays, from), blocked, settings_);
  }
  SceneFieldParts parts() const override { return {SceneFieldParts::Heights{&field_, &march_, &settings_}}; }
  // In which cell it begins the march knows from the ray. On a wall it begins free: the wall is behind it.
  Ray started(const Ray& ray, const FieldHit* from, bool) const override {
    Ray r = ray;
    r.start = RayStart::free;
    if (const Hit* hit = from ? std::get_if<Hit>(&from->own) : nullptr; hit && !hit->wall) {
      r.start = RayStart::on_surface;
      r.start_cell = hit->cell;
    }
    return r;
  }

 private:
  std::vector<Ray> begun(std::span<const Ray> rays, std::span<const FieldHit* const> from) const {
    std::vector<Ray> r(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) r[i] = started(rays[i], from[i], false);
    return r;
  }
  HeightTarget target() const { return {&field_, pyramid_ ? &*pyramid_ : nullptr, slope_}; }

  HeightField field_;
  const HeightMarchEntry& march_;
  MarchSettings settings_;
  std::optional<MaxPyramid> pyramid_;
  double slope_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

SceneFieldPtr scene_heights(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings) {
  return std::make_shared<Heights>(std::move(field), march, settings);
}

}  // namespace scarp
