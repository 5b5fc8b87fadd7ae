// SPDX-License-Identifier: MIT
// Files of the Voxlap engine and its editor SLAB6. x is right, y towards the viewer and z down in all of them.
//
//   .kv6  'Kvxl'; size x y z; pivot x y z (floats); number of voxels; then 8 bytes per voxel: blue, green, red, unused;
//         z (2 bytes); visible faces; normal. Then a count per x (4 bytes), and a count per x and y (2 bytes, y
//         fastest). Lists surface voxels only
//   .vox  size x y z; a palette index per voxel, z fastest, then y, then x; 255: empty; 256 colours of 3 bytes, 0..63
//   .vxl  maps, also those of Ace of Spades: a column per x and y, x fastest; a column is a list of spans from the top.
//         A span begins with 4 bytes: its length in units of 4 bytes, including these (0: the last span, whose length
//         follows from its colours), the first and last z of the colours that follow, and the z where the air above it
//         begins. Further colours belong to the ceiling below, right above the air of the next span. Voxlap's own maps
//         begin with the number 0x09072000, the size x y, and the camera (96 bytes); those of Ace of Spades have
//         512 x 512 columns
//
// Source: K. Silverman, "slab6.txt" of SLAB6 and "voxlap.txt" of Voxlap; silverspaceship.com/aosmap for the maps.
#pragma once

#include "scarp/source/voxel/voxel_parts.h"

namespace scarp {

// All functions throw Error, in one line: not this format, truncated, sizes out of range, inconsistent counts.

VoxelParts parse_kv6(std::string_view bytes);
/// Returns whether a file with these first bytes is a Voxlap .vox file: they determine its size.
bool is_voxlap_vox(std::string_view first, std::uint64_t file_bytes);
VoxelParts parse_voxlap_vox(std::string_view bytes);
/// Leaves the ground between coloured surfaces empty, except at the border of the map.
VoxelParts parse_vxl(std::string_view bytes);

}  // namespace scarp
