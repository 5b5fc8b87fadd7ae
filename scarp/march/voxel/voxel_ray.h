// SPDX-License-Identifier: MIT
// Rays against voxel grids, and the one place where they are quantised.
//
// A ray that hits a box of voxels is quantised there, once: its entry point to multiples of 2^-20 voxel, its direction
// to multiples of 2^-28 of its longest component. From then on the ray crosses planes between voxels at
//
//   s = n / d      n: distance along an axis to the plane in 2^-20 voxel, at most 2^34 + 2^20 (16,384 voxels)
//                  d: the direction's component in 2^-28, at most 2^28
//
// and the order of two planes is n_a d_b < n_b d_a: below 2^63, exact in 64 bits. Nothing accumulates, nothing is
// offset, and every march visits the same voxels on all machines.
//
// The quantised ray stays within 2^-21 + 2^-29 * 16384 < 2^-14 voxel (2^-17 in boxes of 2,048) of the ray along every
// axis. Its first voxel is that of the ray itself.
//
// Ties: planes crossed at the same s are crossed in the order x, y, z. Steps go through faces, so a ray through an edge
// or a corner visits the voxels between, with zero length: solid voxels that touch at an edge let nothing pass. A point
// on a plane belongs to the voxel that the ray enters or, if it runs along the plane, to the higher one.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "scarp/base/ray.h"
#include "scarp/field/voxel_box.h"

namespace scarp {

/// A ray in the space of a grid, where voxels have side 1. The direction is any finite non-zero vector; t is in units
/// of its length. A direction so short that t for 2^8 of its length overflows (below 10^-305) hits nothing; scenes
/// scale such directions to near 1 (usual_ray.h). [t_min, t_max] is closed, t_min finite.
struct VoxelRay {
  dvec3 origin{0.0};
  dvec3 direction{0.0, 0.0, -1.0};
  double t_min = 0.0;
  double t_max = std::numeric_limits<double>::infinity();
  /// The ray's voxel at t_min, if known more exactly than by its coordinates: a shadow ray starts in the empty
  /// neighbour of the voxel that was hit, and cannot hit that voxel again.
  std::optional<ivec3> start_voxel{};
};

/// Returns the outward unit normal; zero for `inside`.
ivec3 normal_of(VoxelFace face);

/// Result of a closest-hit query of a quantised ray in one grid, in that grid's space; all other queries return `Hit`.
/// Members other than `status` are set for hits only.
struct VoxelHit {
  HitStatus status = HitStatus::miss;
  VoxelFace face = VoxelFace::inside;  ///< inside: the ray started in this solid voxel
  ivec3 voxel{-1};
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t entry = 0;  ///< the voxel's entry in its grid

  explicit operator bool() const { return status == HitStatus::hit; }
  friend bool operator==(const VoxelHit&, const VoxelHit&) = default;
};

/// Bits of the fraction of a voxel for positions, and of the longest component for directions.
constexpr int kPlaceBits = 20, kDirectionBits = 28;
constexpr std::int64_t kVoxelPlaces = std::int64_t{1} << kPlaceBits;

/// A quantised direction.
struct QuantisedDirection {
  std::array<std::int64_t, 3> speed;  ///< per axis, 0..2^28; one of them is 2^28
  std::array<double, 3> slowness;     ///< 1 / speed
  std::array<int, 3> step;            ///< 1 or -1
  double t_per_s;                     ///< t per unit of s = n / d; not finite if the direction is too short
};

/// Computed once for all boxes of a ray with the same orientation.
struct VoxelDirection {
  dvec3 given;
  dvec3 inverse;  ///< 1 / given; not finite for zero components
  QuantisedDirection quantised;

  explicit VoxelDirection(const dvec3& direction);
};

/// A ray from its entry into a box.
struct QuantisedRay {
  QuantisedDirection direction;
  ivec3 voxel;                           ///< the first one, in the box
  std::array<std::int64_t, 3> to_plane;  ///< 0..2^20, to the next plane of each axis; kNever if speed is 0
  VoxelFace face;                        ///< by which it enters the box; inside: it starts there
  double t;                              ///< at the entry point
  double t_max;

  static constexpr std::int64_t kNever = std::int64_t{1} << 32;

  /// Returns t of the crossing with a plane of an axis at a distance in 2^-20 voxel.
  double t_at(int axis, std::int64_t distance) const {
    return t + static_cast<double>(distance) / static_cast<double>(direction.speed[static_cast<std::size_t>(axis)]) *
                   direction.t_per_s;
  }
};

/// Returns nullopt if the ray misses the box within its range. The box's sides are at most 16,384.
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box);
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelBox& box);

}  // namespace scarp
