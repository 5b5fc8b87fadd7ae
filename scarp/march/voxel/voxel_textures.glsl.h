// SPDX-License-Identifier: MIT
// A voxel grid in integer textures, for hosts without buffers and addresses, such as WebGL 2: defines the functions
// that the marches require of their host (voxel_planes.glsl.h, voxel_cubes.glsl.h, voxel_bricks.glsl.h).
//
//   scarp_masks    RG32UI: texel (x, y, z) is the mask of brick (x, y, z), which is 4 x 4 x 4 voxels: bit
//                  x + 4 y + 16 z, the low word first. For voxel-planes and voxel-bricks
//   scarp_sectors  RG32UI: the same for sectors, which are 4 x 4 x 4 bricks; a bit is set if its brick has solid
//                  voxels. For voxel-bricks
//   scarp_bytes    R8UI: the byte of each voxel, of EmptyCubes (accel/empty_cubes.h) for voxel-cubes, of EmptySpheres
//                  for voxel-spheres
//   scarp_octants  RG32UI: the eight bytes of each voxel, of OctantCubes; that of octant 0 is the lowest of the first
//                  word. For voxel-octants
//
// All with the filter NEAREST and one mip level. Textures of unused marches need not be bound.
//
// GLSL, including GLSL ES 3.0. The host must first declare
//   uniform highp usampler3D scarp_masks, scarp_sectors, scarp_bytes, scarp_octants;
//   uniform bool scarp_has_octants;    whether voxels have eight bytes
#ifndef SCARP_MARCH_VOXEL_TEXTURES_GLSL_H
#define SCARP_MARCH_VOXEL_TEXTURES_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// The mask of a brick: the low word first.
SCARP_FN uvec2 scarp_voxel_mask(ivec3 brick) { return texelFetch(scarp_masks, brick, 0).xy; }

/// The mask of a sector.
SCARP_FN uvec2 scarp_voxel_sector(ivec3 sector) { return texelFetch(scarp_sectors, sector, 0).xy; }

/// The byte of a voxel for rays of an octant.
SCARP_FN uint scarp_voxel_byte(ivec3 voxel, uint octant) {
  if (!scarp_has_octants) return texelFetch(scarp_bytes, voxel, 0).x;
  uvec2 octants = texelFetch(scarp_octants, voxel, 0).xy;
  return (octant < 4u ? octants.x : octants.y) >> (8u * (octant & 3u)) & 255u;
}

SCARP_GLSL_END

#endif
