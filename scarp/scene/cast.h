// SPDX-License-Identifier: MIT
// Ray queries against a Terrain, Voxels or any Scene: closest hit and occlusion, for single rays and batches.
//
//   rays in   [ r0 r1 r2 r3 ... ]      one call traces a batch on all threads; hits[i] belongs to rays[i]
//   hits out  [ h0 h1 h2 h3 ... ]
//
// These functions validate their rays. They throw Error if an origin or direction is not finite, a direction is zero, a
// range is empty, a range is infinite over terrain that wraps, or a start cell does not exist; batches can answer such
// rays `invalid` instead (BadRays). The corresponding
// members of Scene return `miss` for any of these numbers, and do not check start cells.
#pragma once

#include <cstdint>
#include <span>

#include "scarp/scene/scene.h"

namespace scarp {

/// Behaviour of a batch for rays that cannot be traced.
enum class BadRays : std::uint8_t {
  refuse,          ///< throw Error, before any answer is written
  answer_invalid,  ///< answer them HitStatus::invalid, or kInvalidRay in `blocked`, and all other rays as usual
};
/// The answer of occluded() to a ray that cannot be traced.
constexpr std::uint8_t kInvalidRay = 2;

/// Returns the closest hit: `if (hit) use(ray.at(hit.t))`. t is in units of the length of ray.direction. Without a hit,
/// the status is `miss`, `below` (the ray starts below ground and never emerges) or `exhausted`; see HitStatus.
///
/// `from` is the hit of this scene on whose surface the ray starts, for shadow and reflection rays; null if it starts
/// elsewhere. Do not offset the origin of the ray.
Hit cast(const Scene& scene, const Ray& ray, const Hit* from = nullptr);
/// Sets hits[i] to cast(scene, rays[i], from[i]), bit for bit except on devices. `from` is empty or as long as `rays`;
/// its entries may be null. Throws Error if spans differ in length, or naming the index of the first invalid ray unless
/// `bad` is BadRays::answer_invalid. Up to 16 rays are traced on the calling thread.
void cast(const Scene& scene, std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from = {},
          BadRays bad = BadRays::refuse);

/// Returns whether anything blocks the ray within [t_min, t_max]; faster than cast(). Returns false for a ray that
/// starts below ground and never emerges. For the segment from a to b use direction = b - a and t_max = 1.
bool occluded(const Scene& scene, const Ray& ray, const Hit* from = nullptr);
/// Sets blocked[i] to 1 if occluded(scene, rays[i], from[i]), else to 0. Throws as cast() does.
void occluded(const Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              std::span<const Hit* const> from = {}, BadRays bad = BadRays::refuse);

/// Sets heights[i] to scene.height(xs[i], ys[i]), in metres: the height of the highest ground, NaN where there is none.
/// Uses all threads. Throws Error if spans differ in length. heights_at() of a field (field/ground_points.h) also
/// returns normals.
void heights_at(const Scene& scene, std::span<const double> xs, std::span<const double> ys, std::span<double> heights);

}  // namespace scarp
