// SPDX-License-Identifier: MIT
// Rays against voxel grids, and their quantisation.
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
// axis; within 2^-20 + 2^-14 along an axis on which it crosses at most one plane.
//
// Ties are decided by directions in the world, so that touching grids agree in any orientation (VoxelTies):
//
//   planes crossed at the same s   in the order x, y, z. Steps go through faces, so a ray through an edge or a corner
//                                  visits the voxels between, with zero length: solid voxels that touch at an edge let
//                                  nothing pass, in one grid or in two
//   a ray along a plane            belongs to the voxel on the plane's upper side: that of +x, +y or +z
//   a ray that starts on a plane   belongs to the voxel that it enters
//   a ray that enters the box      crosses the planes there in the same order; unless its path is exact, it crosses the
//                                  plane by which it enters before all others (kTouch)
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
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
  /// Bound on the rounding error of `origin` and of the grid's placement, in voxels. A ray along a plane counts as on
  /// it within this distance, within twice as much at the side of the box to which rays along it belong, and a slow ray
  /// (kSlow) enters the box this much earlier.
  double room = 0.0;
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

/// Orientation of a grid's axes in the world, as far as ties depend on it. The default is that of unrotated grids.
struct VoxelTies {
  static constexpr std::uint32_t kBits = 6;
  /// Bits 0 to 2: axes whose upper side is the low one. Bits 3, 4, 5: y is crossed before x, z before x, z before y.
  std::uint32_t bits = 0;

  VoxelTies() = default;
  explicit VoxelTies(const dmat3& grid_from_world) : VoxelTies(grid_from_world, VoxelTies()) {}
  /// `frame`: the ties of the space that the matrix maps from, if that is rotated, too (Ray::frame).
  VoxelTies(const dmat3& grid_from_world, VoxelTies frame);

  /// 1 or -1: the upper side of planes across this axis.
  int up(int axis) const { return bits >> axis & 1 ? -1 : 1; }
  /// Whether planes across axis a are crossed before those across b at the same t; a and b differ.
  bool before(int a, int b) const { return a > b ? (bits >> (a + b + 2) & 1) != 0 : (bits >> (a + b + 2) & 1) == 0; }
  /// Number of axes that are crossed before this one.
  int rank(int axis) const {
    const int one = (axis + 1) % 3, two = (axis + 2) % 3;
    return (before(one, axis) ? 1 : 0) + (before(two, axis) ? 1 : 0);
  }
};

/// A component below 2^-14 of the longest one crosses at most one plane. It is rounded down, and the position up, so
/// that the quantised ray does not leave its box before the given ray, and neighbours lose nothing.
constexpr std::int64_t kSlow = std::int64_t{1} << (kDirectionBits - 14);

/// Rays may be displaced where they leave one box and enter the next. Planes that a ray has passed by less than this
/// where it enters a box count as not crossed yet, so the ray touches the voxels at an edge there: no edge at which two
/// objects touch lets it pass. The unit is 2^-20 voxel. For boxes of 2,048 voxels a side, this covers 2^-20 + 2^-28 *
/// 2048 of slow components, and rounding.
constexpr std::int64_t kTouch = 10;

/// A path that is exact in one box must be exact in all others of the lattice, or one of them could leave a tie to
/// another that has rounded it away. Paths are exact if no component is slow, each is 0 or a power of two of the
/// longest one, and the ray starts at multiples of 1 / kExactStart voxel: then it reaches all planes at multiples of
/// 2^-16, and those of a grid with voxels of 16 times the size at multiples of 2^-20.
constexpr int kExactStart = 4;

/// A quantised direction.
struct QuantisedDirection {
  std::array<std::int64_t, 3> speed;  ///< per axis, 0..2^28; one of them is 2^28
  std::array<double, 3> slowness;     ///< 1 / speed
  std::array<int, 3> step;            ///< 1 or -1; VoxelTies::up() for a ray along planes
  VoxelTies ties;
  std::array<std::uint8_t, 3> after;  ///< per axis, a bit for each axis that is crossed after it
  bool exact;                         ///< paths in this direction are exact from exact starts (kExactStart)
  bool plain;                         ///< no speed is below kSlow, and t_per_s is finite
  double t_per_s;                     ///< t per unit of s = n / d; not finite if the direction is too short
};

/// Computed once for all boxes of a ray with the same orientation.
struct VoxelDirection {
  dvec3 given;
  dvec3 inverse;  ///< 1 / given; not finite for zero components
  QuantisedDirection quantised;

  explicit VoxelDirection(const dvec3& direction, VoxelTies ties = {});
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

/// Returns false if the ray misses the box within its range; `quantised` is then undefined. The box's sides are at most
/// 16,384.
bool quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box, QuantisedRay& quantised);
/// The same, but returns nullopt for a miss. Slower, because compilers clear an empty optional.
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelDirection& direction, const VoxelBox& box);
std::optional<QuantisedRay> quantise(const VoxelRay& ray, const VoxelBox& box);

}  // namespace scarp
