// SPDX-License-Identifier: MIT
// Shapes in scenes.
#include <utility>

#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

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

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    const Hit hit = march_.cpu(shape_, started(ray, from, false), settings_, stats);
    return {hit.status, hit.t, hit};
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    return march_.occluded(shape_, started(ray, from, true), settings_);
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const dvec3 p = ray.at(hit.t), normal = shape_.normal(p);
    return {normal, normal, {}, shape_.material(p)};
  }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    if (shape_.value(p) > 0) return {};
    const dvec3 normal = shape_.normal(p);
    return FieldSurface{normal, normal, {}, shape_.material(p)};
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
