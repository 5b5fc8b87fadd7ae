// SPDX-License-Identifier: MIT
// What is at a hit, and all hits of a ray.
#include <algorithm>
#include <bit>
#include <vector>

#include "scarp/c/scene_handle.h"
#include "scarp/c/structures.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/scene/cast.h"

using namespace scarp::c;

namespace {

void put(const scarp::dvec3& from, double to[3]) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

}  // namespace

scarp_status scarp_surface_at(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* hit,
                              scarp_surface* surface) {
  return guarded([&] {
    const scarp::Scene& queries = scene_of(scene);
    const scarp::Ray own = ray_from(required(ray, "ray"));
    scarp::validate(own, queries);
    const scarp::SceneSurface found = queries.surface(own, checked_hit(*scene, required(hit, "hit")));
    scarp_surface to{};
    put(found.position, to.position);
    put(found.normal, to.normal);
    put(found.shading_normal, to.shading_normal);
    to.object = found.object;
    if (found.colour) {
      std::copy(found.colour->begin(), found.colour->end(), to.colour);
      to.has_colour = 1;
    }
    write(to, surface, "surface");
  });
}

scarp_status scarp_all_hits(const scarp_scene* scene, const scarp_ray* ray, scarp_hit* hits, size_t room,
                            size_t* count) {
  return guarded([&] {
    const scarp::Terrain& terrain = only_terrain(scene);
    const scarp::Ray own = ray_from(required(ray, "ray"));
    scarp::validate(own, terrain.scene());
    required(hits, room, "hits");
    required(count, "count");
    std::vector<scarp::Hit> found;
    scarp::all_hits_max_mip(terrain.target(), own, found);
    const std::size_t stored = std::min(room, found.size());
    std::transform(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(stored), hits,
                   [](const scarp::Hit& hit) { return std::bit_cast<scarp_hit>(hit); });
    *count = found.size();
  });
}
