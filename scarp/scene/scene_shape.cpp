// SPDX-License-Identifier: MIT
// Shapes in scenes.
#include <utility>

#include "scarp/scene/scene_field.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {
namespace {

constexpr double kToleranceOfJudge = 1e-9;

class ShapeField final : public SceneField {
 public:
  ShapeField(DistanceField shape, const ShapeMarchEntry& march, const MarchSettings& settings)
      : shape_(std::move(shape)), march_(march), settings_(settings) {
    validate(settings_);
  }

  std::string_view kind() const override { return "shape"; }
  std::string_view march() const override { return march_.name; }
  std::optional<WorldBox> box() const override {
    const ShapeBox& box = shape_.box();
    if (box.empty()) return WorldBox{};
    if (!box.finite()) return {};
    return WorldBox{box.low, box.high};
  }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return march_.cpu(shape_, from ? started(ray, from) : ray, settings_, stats);
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    if (!rules.accept) return closest_hit(ray, from, stats);
    return march_.filtered(shape_, from ? started(ray, from) : ray, *rules.accept, settings_, stats);
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    return march_.occluded(shape_, from ? started(ray, from) : ray, settings_);
  }
  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    const dvec3 p = ray.at(hit.t), normal = shape_.normal(p);
    return {normal, normal, {}, shape_.material(p)};
  }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    if (shape_.value(p) > 0) return {};
    const dvec3 normal = shape_.normal(p);
    return FieldSurface{normal, normal, {}, shape_.material(p)};
  }
  SceneFieldPtr judge() const override {
    MarchSettings settings;
    settings.sphere_trace = {.tolerance = kToleranceOfJudge, .max_steps = kStepsOfJudge};
    return scene_shape(shape_, find_shape_march("sphere-trace"), settings);
  }
  SceneFieldParts parts() const override { return {SceneFieldParts::Shape{&shape_, &march_, &settings_}}; }

 private:
  DistanceField shape_;
  const ShapeMarchEntry& march_;
  MarchSettings settings_;
};

}  // namespace

SceneFieldPtr scene_shape(DistanceField shape, const ShapeMarchEntry& march, const MarchSettings& settings) {
  return std::make_shared<ShapeField>(std::move(shape), march, settings);
}

}  // namespace scarp
