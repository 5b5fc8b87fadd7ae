// SPDX-License-Identifier: MIT
// Qubicle Binary (.qb), version 1.1.
//
//   version (1 1 0 0)  colour format (0: RGBA, 1: BGRA)  z axis (0: left-handed, 1: right-handed)
//   compressed (0, 1)  visibility mask in alpha (0, 1)  number of matrices          4 bytes each, little-endian
//   a matrix:  length of its name (1 byte), name;  size x y z;  position x y z;  colours, x fastest, then y, then z
//
// A colour has 4 bytes; alpha 0 is an empty voxel. Compressed slices along z end with the number 6; the number 2 is
// followed by a count and the colour of a run. y is up in the file.
//
// Source: Minddesk, "Qubicle Binary", the format's published description.
#pragma once

#include "scarp/source/voxel/voxel_parts.h"

namespace scarp {

/// Throws Error, in one line: not this format or version, truncated, sizes out of range, runs beyond their slice, or
/// more than kMostListedVoxels.
VoxelParts parse_qubicle(std::string_view bytes);

}  // namespace scarp
