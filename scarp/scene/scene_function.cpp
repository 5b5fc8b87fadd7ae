// SPDX-License-Identifier: MIT
// Terrain functions in scenes. What is seen, what throws shadows on it, and what it is shaded by may have different
// octaves (FunctionUse): a shadow ray begins on the surface of the shadows, above or below the point that was seen.
#include <algorithm>
#include <utility>
#include <vector>

#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

dvec3 upward(const dvec2& slope) { return normalize(dvec3(-slope.x, -slope.y, 1)); }

class FunctionField final : public SceneField {
 public:
  FunctionField(HeightFunction function, const FunctionMarchEntry& march, const MarchSettings& settings)
      : function_(std::move(function)), march_(march), settings_(settings) {
    validate(settings_);
  }

  std::string_view kind() const override { return "function"; }
  std::string_view march() const override { return march_.name; }
  std::optional<WorldBox> box() const override { return {}; }
  std::optional<double> height(double x, double y) const override { return function_.value(x, y); }

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    return field_hit(march_.cpu(function_, started(ray, from, false), settings_, stats, FunctionUse::march));
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    return static_cast<bool>(march_.cpu(function_, started(ray, from, true), settings_, nullptr, FunctionUse::shadow));
  }
  bool likes_batches() const override { return march_.simd; }
  void closest_hits(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                    std::span<FieldHit> hits) const override {
    std::vector<Ray> begun(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) begun[i] = started(rays[i], from[i], false);
    std::vector<Hit> own(rays.size());
    march_.batch(function_, begun, own, settings_, {}, FunctionUse::march);
    std::transform(own.begin(), own.end(), hits.begin(), field_hit);
  }
  void occluded(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                std::span<std::uint8_t> blocked) const override {
    std::vector<Ray> begun(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) begun[i] = started(rays[i], from[i], true);
    std::vector<Hit> own(rays.size());
    march_.batch(function_, begun, own, settings_, {}, FunctionUse::shadow);
    std::transform(own.begin(), own.end(), blocked.begin(), [](const Hit& hit) { return hit ? 1 : 0; });
  }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    if (p.z > function_.value(p.x, p.y)) return {};
    const dvec3 normal = upward(function_.gradient(p.x, p.y, FunctionUse::march));
    return FieldSurface{normal, normal, {}};
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const dvec3 p = ray.at(hit.t);
    const dvec3 normal = upward(function_.gradient(p.x, p.y, FunctionUse::normal));
    return {function_.normals_are_of_march() ? normal : upward(function_.gradient(p.x, p.y, FunctionUse::march)),
            normal,
            {}};
  }
  SceneFieldParts parts() const override { return {SceneFieldParts::Function{&function_, &march_, &settings_}}; }
  Ray started(const Ray& ray, const FieldHit* from, bool shadow) const override {
    Ray r = SceneField::started(ray, from, shadow);
    if (shadow && from) {
      const dvec3 p = ray.at(ray.t_min);
      r.origin.z += function_.value(p.x, p.y, FunctionUse::shadow) - p.z;
    }
    return r;
  }

 private:
  static FieldHit field_hit(const Hit& hit) { return {hit.status, hit.t, hit}; }

  HeightFunction function_;
  const FunctionMarchEntry& march_;
  MarchSettings settings_;
};

}  // namespace

SceneFieldPtr scene_function(HeightFunction function, const FunctionMarchEntry& march, const MarchSettings& settings) {
  return std::make_shared<FunctionField>(std::move(function), march, settings);
}

}  // namespace scarp
