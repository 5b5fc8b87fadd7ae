// SPDX-License-Identifier: MIT
// Queries of single rays.
#include "scarp/scene/cast.h"

#include <new>

#include "scarp/c/scene_handle.h"

using namespace scarp::c;

scarp_status scarp_cast(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* from, scarp_hit* hit) {
  return guarded([&] {
    const scarp::Scene& queries = scene_of(scene);
    const scarp::Ray own = ray_from(required(ray, "ray"));
    required(hit, "hit");
    if (!from) {
      new (hit) scarp::Hit(scarp::cast(queries, own));  // in place, without a copy
    } else {
      const scarp::Hit start = checked_hit(*scene, *from);
      new (hit) scarp::Hit(scarp::cast(queries, own, &start));
    }
  });
}

scarp_status scarp_occluded(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* from, uint8_t* blocked) {
  return guarded([&] {
    const scarp::Scene& queries = scene_of(scene);
    const scarp::Ray own = ray_from(required(ray, "ray"));
    required(blocked, "blocked");
    if (!from) {
      *blocked = scarp::occluded(queries, own);
    } else {
      const scarp::Hit start = checked_hit(*scene, *from);
      *blocked = scarp::occluded(queries, own, &start);
    }
  });
}
