// SPDX-License-Identifier: MIT
// Voxels in scenes.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

class Voxels final : public SceneField {
 public:
  Voxels(VoxelScene scene, std::string_view march, const VoxelShading& shading)
      : scene_(std::move(scene)), march_(march), shading_(shading) {
    validate(shading);
  }

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
    if (!voxel) return scene_.occluded(ray);
    return shading_.normals == VoxelNormals::smooth ? occluded_above_steps(ray, *voxel)
                                                    : scene_.occluded_from(*voxel, ray);
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
    if (shading_.normals == VoxelNormals::smooth) return SceneField::occluded(rays, from, blocked);
    scene_.occluded(rays, blocked, all_from(from));
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const VoxelSceneHit& own = std::get<VoxelSceneHit>(hit.own);
    FieldSurface surface;
    surface.normal = scene_.normal(ray, own);
    surface.shading_normal = shading_normal(own, ray.at(own.hit.t), surface.normal);
    surface.colour = scene_.colour(own);
    if (shading_.corner_ao)
      surface.openness =
          corner_openness(scene_.grid(own), own.hit.voxel, own.hit.face, scene_.place_in_grid(own, ray.at(own.hit.t)));
    return surface;
  }
  SceneFieldParts parts() const override { return {&scene_}; }

  std::optional<FieldSurface> within(const dvec3& p) const override {
    const auto colour = scene_.colour_at(p);
    if (!colour) return {};
    return FieldSurface{{0, 0, 1}, {0, 0, 1}, colour};
  }
  double detail() const override { return scene_.voxel_side(); }
  SceneFieldPtr coarser(int level) const override { return scene_voxels(scene_.coarser(level), march_, shading_); }

 private:
  // A surface that is shaded as a smooth one is not shaded by its own steps. Voxels with their middles below a plane
  // have corners up to sqrt(3) / 2 voxel above it, and faces as far below: above all of them the ray begins free.
  bool occluded_above_steps(const Ray& ray, const VoxelSceneHit& from) const {
    const dvec3 p = ray.at(ray.t_min), normal = scene_.normal(p, from);
    Ray above = ray;
    above.origin += std::sqrt(3.0) * scene_.voxel_side(from) * shading_normal(from, p, normal);
    return scene_.occluded(above);
  }

  dvec3 shading_normal(const VoxelSceneHit& hit, const dvec3& p, const dvec3& normal) const {
    if (shading_.normals == VoxelNormals::flat || hit.hit.face == VoxelFace::inside) return normal;
    const dvec3 point = shading_.normals == VoxelNormals::smooth
                            ? scene_.place_in_grid(hit, p)
                            : dvec3(hit.hit.voxel) + 0.5 + 0.5 * dvec3(normal_of(hit.hit.face));
    const dvec3 smooth = smooth_normal(scene_.grid(hit), point, shading_.normal_radius, dvec3(normal_of(hit.hit.face)));
    if (smooth == dvec3(0.0)) return normal;
    const dvec3 in_world = scene_.world_from_grid(hit, smooth);
    const double towards = dot(in_world, normal);
    if (towards > 0) return in_world;
    // A face of a step that looks up the slope is lit as the slope along it; of a leaf or a thread, where the other
    // side may weigh more, the face itself comes in.
    const dvec3 along = in_world - towards * normal;
    return normalize(along + std::max(0.0, 1 - 2 * length(along)) * normal);
  }

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
  VoxelShading shading_;
};

}  // namespace

SceneFieldPtr scene_voxels(VoxelScene scene, std::string_view march, const VoxelShading& shading) {
  return std::make_shared<Voxels>(std::move(scene), march, shading);
}

}  // namespace scarp
