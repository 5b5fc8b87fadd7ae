// SPDX-License-Identifier: MIT
// Layout of voxel grids, and of the objects that place them, in device memory. DeviceVoxels (device_voxels.h) and
// DeviceVoxelObjects (march/voxel/voxel_queries_vk.h) write it; shaders read it through this file.
//
//   ScarpVoxelGrid ──first_masks──▶ a uint per page of 64 bricks ──masks──▶ a mask per brick, two words
//                  ──pages──▶ ScarpVoxelPage per stored page ──entries──▶ packed colour entries, by rank
//                  ──marks──▶ the accelerator: a byte per voxel (8 for octants), or a mask per sector
//
// These structs contain doubles, which only devices with float64 read.
#ifndef SCARP_ACCEL_VOXEL_BUFFERS_GLSL_H
#define SCARP_ACCEL_VOXEL_BUFFERS_GLSL_H

#include "scarp/accel/voxel_marks.glsl.h"
#include "scarp/vk/glsl_cpp.h"

#ifdef __cplusplus
#include "scarp/base/vec.h"
#endif

SCARP_GLSL_BEGIN

/// Entries of a page of 64 bricks.
struct ScarpVoxelPage {
  uint first_word;  ///< index of the first word of the entries
  uint ranks[8];    ///< number of entries before each group of 4 bricks, 16 bits each
};

struct ScarpVoxelGrid {
  Address first_masks;
  Address masks;
  Address coloured;  ///< masks of the voxels with an entry
  Address pages;
  Address entries;
  Address marks;
  ivec3 bricks;  ///< per axis
  ivec3 size;    ///< voxels per axis
  ivec3 low;     ///< the box in which rays are followed
  ivec3 high;
  uint entry_bits;
  uint march;
  uint octant_bytes;  ///< bytes of marks per octant; 0: all octants share them
  uint none;
};

/// A placed grid; p_grid = grid_from_world * (p_world - origin).
struct ScarpVoxelObject {
  dvec3 origin;
  uint grid;
  uint turn;
  uint part;  ///< Hit::part
  uint none;
};

/// Rows of grid_from_world, VoxelRay::room of unplaced rays, voxels per metre, and a byte of VoxelTies
/// (march/voxel/voxel_ray.h) for each frame of a ray.
struct ScarpVoxelTurn {
  dvec3 rows[3];
  double room;
  double per_metre;
  uint ties[16];
};

/// A node of BoxTree's hierarchy over the objects: four boxes relative to the centre of the whole hierarchy, and four
/// children, each a node or kScarpBoxLeaf plus an object.
struct ScarpBoxNode {
  vec4 low_x;
  vec4 low_y;
  vec4 low_z;
  vec4 high_x;
  vec4 high_y;
  vec4 high_z;
  uvec4 child;
};
const uint kScarpBoxLeaf = 0x80000000u;

/// The objects of a field.
struct ScarpVoxelObjects {
  Address grids;
  Address objects;
  Address turns;
  Address nodes;
  dvec3 middle;
  dvec3 low;  ///< the padded box around everything
  dvec3 high;
};

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VoxelWords { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelMasks { uvec2 masks[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VoxelPages { ScarpVoxelPage pages[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VoxelGrids { ScarpVoxelGrid grids[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelObjectList { ScarpVoxelObject of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelTurns { ScarpVoxelTurn of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VoxelNodes { ScarpBoxNode of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelObjects { ScarpVoxelObjects is; };

// Returns the index of a brick's mask.
uint voxel_mask_index(ScarpVoxelGrid grid, ivec3 brick) {
  uvec3 at = uvec3(brick), bricks = uvec3(grid.bricks);
  uint index = at.x + bricks.x * (at.y + bricks.y * at.z);
  return VoxelWords(grid.first_masks).words[index >> 6] + (index & 63u);
}
uvec2 voxel_mask(ScarpVoxelGrid grid, ivec3 brick) {
  return VoxelMasks(grid.masks).masks[voxel_mask_index(grid, brick)];
}
uvec2 voxel_sector(ScarpVoxelGrid grid, ivec3 sector) {
  ivec2 sectors = (grid.bricks.xy + 3) >> 2;
  return VoxelMasks(grid.marks).masks[sector.x + sectors.x * (sector.y + sectors.y * sector.z)];
}
uint voxel_byte(ScarpVoxelGrid grid, ivec3 voxel, uint octant) {
  uint at = octant * grid.octant_bytes + uint(voxel.x + grid.size.x * (voxel.y + grid.size.y * voxel.z));
  return VoxelWords(grid.marks).words[at >> 2] >> (8u * (at & 3u)) & 255u;
}
// Returns the entry of a solid voxel, as VoxelGrid::entry() does.
uint voxel_entry(ScarpVoxelGrid grid, ivec3 voxel) {
  uint index = voxel_mask_index(grid, voxel >> 2);
  uint bit = uint(voxel.x & 3) | uint(voxel.y & 3) << 2 | uint(voxel.z & 3) << 4;
  VoxelMasks coloured = VoxelMasks(grid.coloured);
  uvec2 mask = coloured.masks[index];
  if (((bit < 32u ? mask.x : mask.y) >> (bit & 31u) & 1u) == 0u) return 0u;
  ScarpVoxelPage page = VoxelPages(grid.pages).pages[index >> 6];
  uint group = index >> 2 & 15u;
  uint rank = page.ranks[group >> 1] >> (16u * (group & 1u)) & 0xffffu;
  for (uint i = index & ~3u; i < index; ++i) {
    uvec2 before = coloured.masks[i];
    rank += uint(bitCount(before.x) + bitCount(before.y));
  }
  uint below = (1u << (bit & 31u)) - 1u;
  rank += uint(bit < 32u ? bitCount(mask.x & below) : bitCount(mask.x) + bitCount(mask.y & below));
  uint first = rank * grid.entry_bits, shift = first & 31u;
  VoxelWords words = VoxelWords(grid.entries);
  uint word = page.first_word + (first >> 5);
  uint value = words.words[word] >> shift;
  if (shift + grid.entry_bits > 32u) value |= words.words[word + 1u] << (32u - shift);
  return value & ((1u << grid.entry_bits) - 1u);
}

#endif

SCARP_GLSL_END

#endif
