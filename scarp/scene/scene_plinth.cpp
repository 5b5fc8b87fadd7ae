// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_plinth.h"

#include <utility>

#include "scarp/scene/plinth.h"

namespace scarp {
namespace {

class PlinthField final : public SceneField {
 public:
  explicit PlinthField(const HeightField& field) : field_(field), plinth_(field, plinth_base(field)) {}

  std::string_view kind() const override { return "plinth"; }
  std::string_view march() const override { return "plinth"; }
  std::optional<WorldBox> box() const override {
    return WorldBox{{0, 0, plinth_base(field_)}, {field_.width(), field_.depth(), field_.max_height()}};
  }
  bool is_backdrop() const override { return true; }
  std::optional<std::uint64_t> edits() const override { return field_.edits(); }
  bool outdated() const override { return edits_ != field_.edits(); }
  SceneFieldPtr rebuilt() const override { return scene_plinth(field_); }
  const std::weak_ptr<const void>* memory() const override { return field_.memory(); }

  Hit closest_hit(const Ray& ray, const Hit*, MarchStats* stats) const override {
    if (stats) *stats = {};
    Hit hit;
    if (const auto wall = plinth_.intersect(ray)) set(hit, ray, *wall);
    return hit;
  }
  // Most rays of a picture hit no wall.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const>) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hits[i].status = HitStatus::miss;
      if (const auto wall = plinth_.intersect(rays[i])) set(hits[i] = Hit{}, rays[i], *wall);
    }
  }
  // A ray that passes through a wall is inside, where it hits no other wall.
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    const Hit hit = closest_hit(ray, from, stats);
    return hit && rules.accept && !(*rules.accept)(hit) ? Hit{} : hit;
  }
  bool occluded(const Ray&, const Hit*) const override { return false; }
  FieldSurface surface(const Ray&, const Hit& hit) const override {
    const int face = static_cast<int>(hit.face);
    dvec3 normal(0.0);
    normal[face / 2] = face % 2 ? 1 : -1;
    return {.normal = normal, .shading_normal = normal, .wall = true};
  }
  std::optional<FieldSurface> within(const dvec3&) const override { return {}; }
  // Batches test the plinth before the terrain: the ground behind a wall need not be marched.
  bool likes_batches() const override { return true; }

 private:
  static void set(Hit& hit, const Ray& ray, const Plinth::Wall& wall) {
    hit.status = HitStatus::hit;
    hit.wall = true;
    hit.face = wall.face;
    hit.t = wall.t;
    hit.height = ray.at(wall.t).z;
  }

  HeightField field_;
  Plinth plinth_;
  std::uint64_t edits_ = field_.edits();  // when the plinth was built
};

}  // namespace

SceneFieldPtr scene_plinth(const HeightField& field) { return std::make_shared<PlinthField>(field); }

Scene with_plinth(const Scene& terrain) {
  const HeightField* field = terrain.only_heights();
  if (!field || field->wraps() || !field->has_cells() || field->all_nodata()) return terrain;
  std::vector<SceneFieldPtr> fields = terrain.fields();
  std::vector<SceneObject> objects = terrain.objects();
  objects.push_back({.field = static_cast<std::uint32_t>(fields.size()), .material = objects[0].material});
  fields.push_back(scene_plinth(*field));
  return {std::move(fields), std::move(objects)};
}

}  // namespace scarp
