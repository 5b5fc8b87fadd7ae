// SPDX-License-Identifier: MIT
// Private to the station: what single rays and batches of a scene do with the answers of objects.
#pragma once

#include "scarp/scene/scene.h"

namespace scarp {

/// Keeps the better of two answers about one ray; what is no hit is kept by how much it leaves open.
inline void take(const FieldHit& hit, std::uint32_t object, SceneHit& best) {
  const auto rank = [](HitStatus status) {
    return status == HitStatus::hit ? 3 : status == HitStatus::exhausted ? 2 : status == HitStatus::below ? 1 : 0;
  };
  const int now = rank(hit.status), before = rank(best.field.status);
  if (now < before || now == 0) return;
  if (now == before && !(hit.t < best.field.t || (hit.t == best.field.t && object < best.object))) return;
  best = {hit, object};
}

/// The ray in an object's space, no further than to what is known already.
inline Ray shortened(const Placement& placement, const Ray& ray, const SceneHit& best) {
  Ray local = placement.field_from_world(ray);
  local.start = RayStart::free;
  if (best) local.t_max = best.field.t;
  return local;
}

}  // namespace scarp
