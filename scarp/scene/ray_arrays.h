// SPDX-License-Identifier: MIT
// Rays and hits as arrays of floats, one per component, as engines and numerical programs store them.
//
//   const scarp::RayArrays rays{.origin_x = ox, .origin_y = oy, .origin_z = oz, .direction_x = dx, ...};
//   scarp::cast(scene, rays, {.t = t, .object = object});
//
// The results are those of cast() and occluded() for the same numbers as doubles; only the returned t, u, v and normals
// are rounded to floats. Rays are converted piece by piece: no copy of the whole batch is made.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "scarp/scene/cast.h"

namespace scarp {

/// A batch of rays. All spans have the same length; the spans for t_min, t_max and the start may be empty.
struct RayArrays {
  std::span<const float> origin_x, origin_y, origin_z;           ///< metres
  std::span<const float> direction_x, direction_y, direction_z;  ///< any length except zero; the unit of t
  std::span<const float> t_min{};                                ///< empty: 0
  std::span<const float> t_max{};                                ///< empty: infinity
  /// Cells on whose ground the rays start, as in HitArrays. A ray with a negative column starts free; if both spans are
  /// empty, all rays do. Give both or neither. For height fields: voxels and meshes need the hit itself (cast() with
  /// `from`).
  std::span<const std::int32_t> start_col{}, start_row{};
  std::span<const std::uint32_t> start_object{};  ///< objects of these cells; empty: object 0
};

/// The members of hits to write: spans as long as the rays, or empty. For a miss, t is infinite, cells are -1, and
/// everything else is 0.
struct HitArrays {
  std::span<float> t{};
  std::span<HitStatus> status{};
  std::span<std::uint32_t> object{}, part{};
  std::span<std::int32_t> col{}, row{};                 ///< Hit::cell
  std::span<float> u{}, v{};                            ///< position in the cell
  std::span<float> normal_x{}, normal_y{}, normal_z{};  ///< SceneSurface::normal: all three or none
};

/// Finds the closest hits of a batch. Throws Error for spans of different lengths, for an incomplete pair or triple,
/// and as cast() of rays does, naming the first invalid ray unless `bad` is BadRays::answer_invalid.
void cast(const Scene& scene, const RayArrays& rays, const HitArrays& hits, BadRays bad = BadRays::refuse);
/// Sets blocked[i] to 1 if anything blocks ray i, else to 0. Throws as cast() does.
void occluded(const Scene& scene, const RayArrays& rays, std::span<std::uint8_t> blocked,
              BadRays bad = BadRays::refuse);

}  // namespace scarp
