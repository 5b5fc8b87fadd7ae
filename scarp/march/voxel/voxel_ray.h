// SPDX-License-Identifier: MIT
// Rays against voxel grids, and the one place where they are quantised.
//
// A ray that meets a box of voxels is moved onto whole numbers there, once: the point where it comes in to multiples of
// 2^-20 voxel, its direction to multiples of 2^-28 of its longest component. From then on the ray crosses planes
// between voxels at
//
//   s = n / d      n: distance along an axis to the plane in 2^-20 voxel, at most 2^31 (2,048 voxels)
//                  d: the direction's component in 2^-28, at most 2^28
//
// and which of two planes comes first is n_a d_b < n_b d_a: 59 bits, exact in 64. Nothing is accumulated, nothing is
// pushed, and every march, on every machine, visits the same voxels.
//
// The quantised ray stays within 2^-21 + 2^-29 * 2048 < 2^-17 voxel of the ray in every axis. The voxel it starts in is
// that of the ray itself.
//
// Ties: planes that are crossed at once are crossed in the order x, y, z. Steps go through faces, so a ray through an
// edge or a corner visits the voxels between, for no length: solid voxels that touch at an edge let nothing pass.
// A point on a plane belongs to the voxel that the ray goes into, or, where it runs along the plane, to the higher one.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "scarp/base/ray.h"
#include "scarp/field/voxel_box.h"

namespace scarp {

/// In the space of a grid, where voxels have the side 1. The direction is any finite vector but zero; t counts in its
/// length. One so short that t for 2^8 of its length is no finite number (below 10^-305) meets nothing; scenes bring
/// such near 1 (usual_ray.h).
/// [t_min, t_max] is closed, t_min finite.
struct VoxelRay {
  dvec3 origin{0.0};
  dvec3 direction{0.0, 0.0, -1.0};
  double t_min = 0.0;
  double t_max = std::numeric_limits<double>::infinity();
  /// The voxel that the ray is in at t_min, when that is known better than by its coordinates: a shadow ray starts in
  /// the empty neighbour of the voxel that was hit, and cannot hit that voxel again.
  std::optional<ivec3> start_voxel{};
};

/// The face by which a ray came into a voxel: 2 * axis + (1 where the ray goes towards lower coordinates).
enum class VoxelFace : std::uint8_t { low_x, high_x, low_y, high_y, low_z, high_z, inside };

/// Outward unit normal; zero for `inside`.
ivec3 normal_of(VoxelFace face);

/// All but `status` is set for hits only.
struct VoxelHit {
  HitStatus status = HitStatus::miss;
  VoxelFace face = VoxelFace::inside;  ///< inside: the ray began in this solid voxel
  ivec3 voxel{-1};
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t entry = 0;  ///< the voxel's, of its grid

  explicit operator bool() const { return status == HitStatus::hit; }
  friend bool operator==(const VoxelHit&, const VoxelHit&) = default;
};

/// Fractions of a voxel that places are counted in, and of the longest component of a direction.
constexpr int kPlaceBits = 20, kDirectionBits = 28;
constexpr std::int64_t kVoxelPlaces = std::int64_t{1} << kPlaceBits;

/// A direction on whole numbers.
struct QuantisedDirection {
  std::array<std::int64_t, 3> speed;  ///< of each axis, 0..2^28, one of them 2^28
  std::array<double, 3> slowness;     ///< 1 / speed
  std::array<int, 3> step;            ///< 1 or -1
  double t_per_s;                     ///< t for s = n / d as above; not finite: the direction is too short
};

/// Computed once for all boxes that a ray meets without turning.
struct VoxelDirection {
  dvec3 given;
  dvec3 inverse;  ///< 1 / given; not finite where that is zero
  QuantisedDirection quantised;

  explicit VoxelDirection(const dvec3& direction);
};

/// A ray from where it comes into a box.
struct QuantisedRay {
  QuantisedDirection direction;
  ivec3 voxel;                           ///< the first one, in the box
  std::array<std::int64_t, 3> to_plane;  ///< 0..2^20, to the next plane of each axis; kNever where speed is 0
  VoxelFace face;                        ///< by which it came into the box; inside: it began there
  double t;                              ///< of the place
  double t_max;

  static constexpr std::int64_t kNever = std::int64_t{1} << 32;

  /// Of the crossing of a plane of an axis at a distance in 2^-20 voxel.
  double t_at(int axis, std::int64_t distance) const {
    return t + static_cast<double>(distance) / static_cast<double>(direction.speed[axis]) * direction.t_per_s;
  }
};

/// Nothing when the ray passes the box within its range. The box's sides are at most 2,048.
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box);
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelBox& box);

}  // namespace scarp
