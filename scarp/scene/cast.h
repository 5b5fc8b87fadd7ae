// SPDX-License-Identifier: MIT
// What rays hit: closest hits and occlusion, for one ray and for batches, against a Terrain, Voxels or any Scene.
//
//   rays in   [ r0 r1 r2 r3 ... ]      one call answers a batch on all threads; answers stand where their rays stand
//   hits out  [ h0 h1 h2 h3 ... ]
//
// These functions check their rays and throw Error for one that cannot be followed: not finite, a direction of zero, an
// empty range, an infinite range over ground that wraps round, a start on a cell that does not exist. The members of
// Scene do the same work without the check.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/scene/scene.h"

namespace scarp {

/// The nearest hit, if any: `if (hit) use(ray.at(hit.t))`. t counts in lengths of ray.direction, which need not be 1.
/// Otherwise a miss, `below` (the ray started below ground) or `exhausted`; see HitStatus.
///
/// `from`: a hit of this scene on whose surface the ray starts, for shadows and reflections; do not offset its origin.
Hit cast(const Scene& scene, const Ray& ray, const Hit* from = nullptr);
/// hits[i] is cast(scene, rays[i], from[i]), bit for bit, except on devices. `from` is empty or as long as `rays`; its
/// entries may be null. Throws Error for spans that differ in length, or for a ray, by its index.
void cast(const Scene& scene, std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from = {});

/// Whether anything blocks the ray within [t_min, t_max]; faster than cast(). For the segment from a to b use
/// direction = b - a and t_max = 1.
bool occluded(const Scene& scene, const Ray& ray, const Hit* from = nullptr);
/// blocked[i] is 1 if occluded(scene, rays[i], from[i]), else 0. Throws as cast() does.
void occluded(const Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              std::span<const Hit* const> from = {});

}  // namespace scarp
