// SPDX-License-Identifier: MIT
// Queries of a scene in which some objects or hits do not count:
//
//   const SceneQuery solid = scene.query({.mask = kSolid});
//   const SceneQuery both = scene.query({.sides = Sides::both});
//   const SceneQuery dry = scene.query({.accept = [&](const Ray& ray, const Hit& hit) {
//     return scene.material(ray, hit) != kWater;
//   }});
//
// A ray goes on behind a hit that the filter rejects as if there were a hole: through that voxel, that triangle, or the
// ground, which it can leave elsewhere. It is never started anew, so no other hit is lost and none found twice. Height
// fields with the march max-mip or exhaustive, tiles, voxels and meshes go on; functions and shapes cannot: to reject
// a hit on one throws Error.
#pragma once

#include <span>

#include "scarp/scene/scene.h"

namespace scarp {

/// Returned by Scene::query(). Refers to the scene, which must outlive it; of a LiveScene, its Reading. Thread-safe if
/// the filter is.
class SceneQuery {
 public:
  /// Throws Error if the scene has objects and the mask is that of none, or if it is on a device.
  SceneQuery(const Scene& scene, SceneRules rules);

  /// As Scene::closest_hit(), by the rules.
  Hit closest_hit(const Ray& ray, const Hit* from = nullptr, MarchStats* stats = nullptr) const;
  /// As Scene::occluded(), by the rules. With sides or a filter, rays from voxels with smooth normals start on the
  /// voxels.
  bool occluded(const Ray& ray, const Hit* from = nullptr) const;
  /// As Scene::closest_hits() and Scene::occluded(), by the rules. With a mask alone as fast as without.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from = {}) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  const SceneRules& rules() const { return rules_; }

 private:
  const Scene& scene_;
  SceneRules rules_;
};

}  // namespace scarp
