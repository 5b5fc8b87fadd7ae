// SPDX-License-Identifier: MIT
// Private to the station: shared by single-ray and batch queries of a scene.
#pragma once

#include <algorithm>
#include <span>

#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/voxel_ray.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// A world-space ray and how it starts: as Ray::start states if `own`, else on the surface of `from`, or free if that
/// is null.
struct Scene::StartedRay {
  const Ray& ray;
  bool own = true;
  const Hit* from = nullptr;
  const SceneRules* rules = nullptr;  ///< null: all objects and hits count

  StartedRay(const Ray& world_ray, const Hit* hit, const SceneRules* scene_rules = nullptr)
      : ray(world_ray), own(!hit), from(hit), rules(scene_rules) {}
  StartedRay(std::span<const Ray> rays, From hits, std::size_t i, const SceneRules* scene_rules = nullptr)
      : ray(rays[i]), own(hits.empty()), from(own ? nullptr : hits[i]), rules(scene_rules) {}

  /// The same start for another ray, which must outlive the result.
  StartedRay with(const Ray& other) const {
    StartedRay started(other, from, rules);
    started.own = own;
    return started;
  }
  /// Returns the hit on this object on which the ray starts, or null.
  const Hit* from_on(std::uint32_t object) const { return from && from->object == object ? from : nullptr; }
};

/// Returns Ray::frame of rays in the space of a field with this placement.
inline std::uint8_t frame_of(const Placement& placement) {
  return static_cast<std::uint8_t>(VoxelTies(transpose(placement.turn)).bits);
}

/// Whether placements may make the direction overflow. Such a ray is shortened by 2^kShorter, which lengthens its t.
constexpr int kShorter = 100;
inline bool is_too_long(const Ray& ray) { return !(longest_of(ray.direction) < 0x1p900); }
/// Whether one of the rays is such a ray, or one that cast() rejects: then each is traced individually.
inline bool any_odd(std::span<const Ray> rays) {
  return std::any_of(rays.begin(), rays.end(), [](const Ray& ray) { return is_too_long(ray) || !is_followable(ray); });
}

/// Whether a query, with or without rules, sees an object.
inline bool sees(const SceneRules* rules, const SceneObject& object) {
  return !rules || (rules->mask & object.mask) != 0;
}

/// Whether rules are about hits, not just about objects.
inline bool about_hits(const SceneRules* rules) { return rules && (rules->sides != Sides::above || rules->accept); }

/// Sets `local` to the ray in the object's space, ending at the best hit so far. Its start is valid if from_on() is
/// null. Written in place: in batches a copy of each ray would cost as much as the rest.
inline void Scene::make_local(const StartedRay& started, std::uint32_t object, const Hit& best, Ray& local) const {
  if (in_place_[object]) {
    local = started.ray;
  } else {
    local = objects_[object].placement.field_from_world(started.ray);
    local.frame = frames_[object];
  }
  local.room = rooms_[object];
  if (!started.own || started.ray.start_object != object) local.start = RayStart::free;
  if (!best) return;
  local.t_max = best.t;
  // Hits of a ray from a surface must be before t_max. Extends the range to find a hit at the same t, which counts if
  // its object has the lower index.
  if (local.start == RayStart::on_surface)
    local.t_max = std::nextafter(best.t, std::numeric_limits<double>::infinity());
}

inline Ray Scene::local(const StartedRay& started, std::uint32_t object, const Hit& best) const {
  Ray ray;
  make_local(started, object, best, ray);
  return ray;
}

/// Throws Error unless the spans of a batch have the same length.
void require_same_length(std::size_t rays, std::size_t answers);

/// Replaces `best` if `hit` is better: closest hit first, then exhausted, below, miss.
inline void take(const Hit& hit, std::uint32_t object, Hit& best) {
  const auto rank = [](HitStatus status) {
    return status == HitStatus::hit ? 3 : status == HitStatus::exhausted ? 2 : status == HitStatus::below ? 1 : 0;
  };
  const int now = rank(hit.status), before = rank(best.status);
  if (now < before || now == 0) return;
  if (now == before && !(hit.t < best.t || (hit.t == best.t && object < best.object))) return;
  best = hit;
  best.object = object;
}

}  // namespace scarp
