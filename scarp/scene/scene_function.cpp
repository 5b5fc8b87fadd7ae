// SPDX-License-Identifier: MIT
// Terrain functions in scenes. Shadows are those of the surface that is seen, so rays from it begin on it; normals for
// shading may have more octaves.
#include <utility>

#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

dvec3 upward(const dvec2& slope) { return normalize(dvec3(-slope.x, -slope.y, 1)); }

class FunctionField final : public SceneField {
 public:
  FunctionField(HeightFunction function, const MarchEntry& march, const MarchSettings& settings)
      : function_(std::move(function)), march_(march), settings_(settings) {
    validate(settings_);
  }

  std::string_view kind() const override { return "function"; }
  std::string_view march() const override { return march_.name; }
  std::optional<WorldBox> box() const override { return {}; }
  std::optional<double> height(double x, double y) const override { return function_.value(x, y); }

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    Ray r = ray;
    r.start = from ? RayStart::on_surface : RayStart::free;
    const Hit hit = march_.function_cpu(function_, r, settings_, stats, FunctionUse::march);
    return {hit.status, hit.t, hit};
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    return static_cast<bool>(closest_hit(ray, from, nullptr));
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const dvec3 p = ray.at(hit.t);
    return {upward(function_.gradient(p.x, p.y, FunctionUse::march)),
            upward(function_.gradient(p.x, p.y, FunctionUse::normal)),
            {}};
  }

 private:
  HeightFunction function_;
  const MarchEntry& march_;
  MarchSettings settings_;
};

}  // namespace

SceneFieldPtr scene_function(HeightFunction function, const MarchEntry& march, const MarchSettings& settings) {
  return std::make_shared<FunctionField>(std::move(function), march, settings);
}

}  // namespace scarp
