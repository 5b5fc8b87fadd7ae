// SPDX-License-Identifier: MIT
// Private to the station: what single rays and batches of a scene have in common.
#pragma once

#include "scarp/scene/scene.h"

namespace scarp {

/// A world ray and how it begins: by its own start, or, when hits are given, on the surface of one or free.
struct Scene::Asking {
  const Ray& ray;
  bool own = true;
  const Hit* from = nullptr;

  Asking(const Ray& world_ray, const Hit* hit) : ray(world_ray), own(!hit), from(hit) {}
  Asking(std::span<const Ray> rays, From hits, std::size_t i)
      : ray(rays[i]), own(hits.empty()), from(own ? nullptr : hits[i]) {}

  /// The hit on that object where it begins, or null.
  const Hit* from_on(std::uint32_t object) const { return from && from->object == object ? from : nullptr; }
};

/// The ray in the object's space, no further than to the best hit so far. Its start counts where from_on() is null.
/// Written in place: batches turn many rays, and a copy of each costs as much as the rest.
inline void Scene::make_local(const Asking& asking, std::uint32_t object, const Hit& best, Ray& local) const {
  if (in_place_[object]) {
    local = asking.ray;
  } else {
    local = objects_[object].placement.field_from_world(asking.ray);
  }
  if (!asking.own || asking.ray.start_object != object) local.start = RayStart::free;
  if (best) local.t_max = best.t;
}

inline Ray Scene::local(const Asking& asking, std::uint32_t object, const Hit& best) const {
  Ray ray;
  make_local(asking, object, best, ray);
  return ray;
}

/// Keeps the better of two answers about one ray. Answers without a hit are ranked by how much they leave open.
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
