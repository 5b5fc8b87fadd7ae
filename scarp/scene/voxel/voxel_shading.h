// SPDX-License-Identifier: MIT
// Shading of voxels: normals and corner darkening, computed only from the grid.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp {

enum class VoxelNormals : std::uint8_t {
  flat,   ///< normal of the face that was hit
  voxel,  ///< one per face, smooth_normal() at its centre: cubes oriented with the shape that they belong to
  smooth  ///< smooth_normal() where the ray hit: no cubes in the shading, and no shadows of the surface's own steps
};

struct VoxelShading {
  VoxelNormals normals = VoxelNormals::flat;
  double normal_radius = 3;  ///< radius of smooth_normal(), in voxels, 1..8
  bool corner_ao = false;    ///< applies corner_openness() to the sky light, if that is not sampled
};

/// Throws Error naming the setting out of range.
void validate(const VoxelShading& shading);

/// Returns the normal that points away from the solid voxels within `radius` of a point in the grid's space: the
/// gradient of density, in which the centre of each voxel has the weight (1 - d^2 / radius^2)^2 at a distance d. Where
/// the gradient is shorter than half of that at a plane (threads, sheets of a single voxel, edges that touch), it is
/// blended with `face`, a unit vector or zero, which takes over where all sides are equally solid. Unit or zero;
/// continuous in the point. On a ball of radius 12 it is off by 3.4 degrees (rms) for a radius of 3, by 5 for 2.5 and
/// 1.8 for 4. Cost: (2 radius)^3 voxels.
dvec3 smooth_normal(const VoxelGrid& grid, const dvec3& point, double radius, const dvec3& face = dvec3(0.0));

/// Returns the fraction of the sky open at a point on a face of a voxel, from the eight voxels around the one in front
/// of the face:
///
///   four voxels in front of the face meet at each of its corners; each solid one hides a quarter of what a wall of any
///   height would leave; two at the sides hide the one between them: 1, 3/4, 1/2 or 1/4; linear in between
///
/// Source: M. Lysenko, "Ambient occlusion for Minecraft-like worlds", 0fps.net 2013, whose four levels these are. 1 for
/// `inside`.
double corner_openness(const VoxelGrid& grid, const ivec3& voxel, VoxelFace face, const dvec3& point);

}  // namespace scarp
