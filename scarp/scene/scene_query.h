// SPDX-License-Identifier: MIT
// Scene queries that ignore some objects or hits:
//
//   const SceneQuery solid = scene.query({.mask = kSolid});
//   const SceneQuery both = scene.query({.sides = Sides::both});
//   const SceneQuery dry = scene.query({.accept = [&](const Ray& ray, const Hit& hit) {
//     return scene.material(ray, hit) != kWater;
//   }});
//
// Behind a hit that the filter rejects, the ray continues as if there were a hole: through that voxel, triangle or
// solid, or below the ground, where it may emerge elsewhere. Over height fields with the march max-mip or exhaustive,
// tiles, voxels and meshes it is not restarted, so no other hit is lost or found twice. Over functions with the march
// lipschitz-local, and shapes, it restarts on the surface by the rule of its march, which may pass the same hit, within
// its tolerance, to the filter twice. Rejecting a hit of any other function march throws Error.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>

#include "scarp/scene/scene.h"

namespace scarp {

/// A contact or a closest point, in world space; `place` as in Hit.
struct SceneContact : FieldContact {
  std::uint32_t object = 0;
};
struct ScenePoint : FieldPoint {
  std::uint32_t object = 0;
};

/// Returned by Scene::query(). Refers to the scene, which must outlive it; for a LiveScene, to its Reading. Thread-safe
/// if the filter is.
class SceneQuery {
 public:
  /// Throws Error if the scene has objects and none matches the mask, or if it is on a device.
  SceneQuery(const Scene& scene, SceneRules rules);

  /// As Scene::closest_hit(), under the rules.
  Hit closest_hit(const Ray& ray, const Hit* from = nullptr, MarchStats* stats = nullptr) const;
  /// As Scene::occluded(), under the rules. With sides or a filter, rays from voxels with smooth normals start on the
  /// voxels.
  bool occluded(const Ray& ray, const Hit* from = nullptr) const;
  /// As Scene::closest_hits() and Scene::occluded(), under the rules. A mask without sides and filter costs nothing.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from = {}) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  /// Returns the first contact of a sphere or capsule that moves along `motion`; nullopt if there is none. If it
  /// touches several objects at once, the one with the lowest index counts. Only the mask applies, not sides or filter:
  /// height fields and tiles are touched from both sides. The hierarchy of the scene finds the objects along the
  /// motion. Throws Error for a capsule or a motion that validate() rejects, and if the mask selects a function, a
  /// shape, a mesh, a wrapped height field, or one not marched by max-mip.
  std::optional<SceneContact> sweep(const Capsule& capsule, const dvec3& motion) const;
  /// Returns whether a closed box overlaps a height field's surface or a solid voxel. Errors as for sweep().
  bool overlaps(const TurnedBox& box) const;
  /// Returns the point closest to p on any height field surface or solid voxel, within `max_distance` metres. Among
  /// objects at the same distance, the lowest index wins. Errors as for sweep().
  std::optional<ScenePoint> closest_point(const dvec3& p,
                                          double max_distance = std::numeric_limits<double>::infinity()) const;

  const SceneRules& rules() const { return rules_; }

 private:
  void find_no_contacts();
  template <class Bound, class Visit>
  void search(double end, const Bound& bound, const Visit& visit) const;

  const Scene& scene_;
  SceneRules rules_;
  std::string no_contacts_;  // why contacts are unsupported; empty: they are supported
};

}  // namespace scarp
