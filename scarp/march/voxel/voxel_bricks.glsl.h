// SPDX-License-Identifier: MIT
// `voxel-bricks` in shaders (voxel_bricks.h). Compiles as C++ and GLSL. The host defines scarp_voxel_mask() and
// scarp_voxel_sector().
#ifndef SCARP_MARCH_VOXEL_BRICKS_GLSL_H
#define SCARP_MARCH_VOXEL_BRICKS_GLSL_H

#include "scarp/march/voxel/voxel_planes.glsl.h"

SCARP_GLSL_BEGIN

/// The mask of a sector, as BrickMasks::sector(): the low word first.
#ifdef __cplusplus
uvec2 scarp_voxel_sector(const ivec3& sector);
#endif

/// kAhead: the voxels of a brick, or bricks of a sector, that a ray can still reach from one of them.
SCARP_FN uvec2 scarp_ahead(ivec3 from, uint back) {
  uint x = uint(from.x & 3), y = uint(from.y & 3), z = uint(from.z & 3);
  uint row = (back & 1u) != 0u ? 0xfu >> (3u - x) : 0xfu << x & 0xfu;
  uint layer = (back & 2u) != 0u ? 0xffffu >> (12u - 4u * y) : 0xffffu << (4u * y) & 0xffffu;
  layer = (layer & row * 0x1111u) * 0x10001u;
  // The second layer of a word.
  uint part = 0xffff0000u;
  uvec2 up = uvec2(z == 0u ? layer : z == 1u ? layer & part : 0u, z == 3u ? layer & part : layer);
  uvec2 down = uvec2(z == 0u ? layer & ~part : layer, z < 2u ? 0u : z == 2u ? layer & ~part : layer);
  return (back & 4u) != 0u ? down : up;
}

/// Whether the block of 2 x 2 x 2 around a bit is empty.
SCARP_FN bool scarp_pair_empty(uvec2 mask, uint bit) {
  return ((bit < 32u ? mask.x : mask.y) >> (bit & 10u) & 0x00330033u) == 0u;
}

/// Planes until the ray leaves the aligned block with sides of 2^level voxels.
SCARP_FN ivec3 scarp_planes_of_block(ScarpVoxelWalk walk, int level) {
  int side = 1 << level;
  ivec3 planes;
  for (int i = 0; i < 3; ++i) {
    int place = walk.voxel[i] & (side - 1);
    planes[i] = (walk.back >> uint(i) & 1u) != 0u ? place + 1 : side - place;
  }
  return planes;
}

/// Advances by one step and returns whether the ray is still in the box, or sets `solid`.
SCARP_FN bool scarp_bricks_turn(SCARP_INOUT(ScarpVoxelWalk) walk, SCARP_OUT(bool) solid) {
  ivec3 brick = ivec3(walk.voxel.x >> 2, walk.voxel.y >> 2, walk.voxel.z >> 2);
  uint bit = scarp_voxel_bit(walk.voxel);
  uvec2 mask = scarp_voxel_mask(brick), ahead = scarp_ahead(walk.voxel, walk.back);
  mask = uvec2(mask.x & ahead.x, mask.y & ahead.y);
  int level = 0;
  solid = scarp_mask_has(mask, bit);
  if ((mask.x | mask.y) != 0u) {
    level = scarp_pair_empty(mask, bit) ? 1 : 0;
  } else {
    SCARP_COUNT(sector);
    uint brick_bit = scarp_voxel_bit(brick);
    uvec2 sector = scarp_voxel_sector(ivec3(brick.x >> 2, brick.y >> 2, brick.z >> 2));
    ahead = scarp_ahead(brick, walk.back);
    sector = uvec2(sector.x & ahead.x, sector.y & ahead.y);
    // The brick's own bit may be set by voxels behind the ray.
    uint own = 1u << (brick_bit & 31u);
    uint others = brick_bit < 32u ? (sector.x & ~own) | sector.y : sector.x | (sector.y & ~own);
    level = others == 0u ? 4 : scarp_pair_empty(sector, brick_bit) ? 3 : 2;
  }
  bool inside = false;
  if (level > 0) {
    inside = scarp_voxel_leave(walk, scarp_planes_of_block(walk, level));
  } else if (!solid) {
    inside = scarp_voxel_cross(walk);
  }
  return inside;
}

SCARP_GLSL_END

#endif
