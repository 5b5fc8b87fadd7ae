// SPDX-License-Identifier: MIT
// Voxels in scenes.
#include <string>
#include <utility>
#include <vector>

#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

class Voxels final : public SceneField {
 public:
  Voxels(VoxelScene scene, std::string_view march) : scene_(std::move(scene)), march_(march) {}

  std::string_view kind() const override { return "voxels"; }
  std::string_view march() const override { return march_; }
  std::optional<WorldBox> box() const override { return scene_.box(); }

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    VoxelSceneStats counted;
    const VoxelSceneHit hit = scene_.closest_hit(ray, from_of(from), stats ? &counted : nullptr);
    if (stats) *stats = {.steps = counted.steps};
    return {hit.hit.status, hit.hit.t, hit};
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    const VoxelSceneHit* voxel = from_of(from);
    return voxel ? scene_.occluded_from(*voxel, ray) : scene_.occluded(ray);
  }
  bool likes_batches() const override { return true; }
  void closest_hits(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                    std::span<FieldHit> hits) const override {
    std::vector<VoxelSceneHit> own(rays.size());
    scene_.closest_hits(rays, own, all_from(from));
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = {own[i].hit.status, own[i].hit.t, own[i]};
  }
  void occluded(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                std::span<std::uint8_t> blocked) const override {
    scene_.occluded(rays, blocked, all_from(from));
  }
  FieldSurface surface(const Ray&, const FieldHit& hit) const override {
    const VoxelSceneHit& own = std::get<VoxelSceneHit>(hit.own);
    const dvec3 normal = scene_.normal(own);
    return {normal, normal, scene_.colour(own)};
  }
  SceneFieldParts parts() const override { return {&scene_, nullptr, nullptr}; }

 private:
  static const VoxelSceneHit* from_of(const FieldHit* from) {
    return from ? std::get_if<VoxelSceneHit>(&from->own) : nullptr;
  }
  static std::vector<const VoxelSceneHit*> all_from(std::span<const FieldHit* const> from) {
    std::vector<const VoxelSceneHit*> own;
    for (const FieldHit* hit : from) own.push_back(from_of(hit));
    return own;
  }

  VoxelScene scene_;
  std::string march_;
};

}  // namespace

SceneFieldPtr scene_voxels(VoxelScene scene, std::string_view march) {
  return std::make_shared<Voxels>(std::move(scene), march);
}

}  // namespace scarp
