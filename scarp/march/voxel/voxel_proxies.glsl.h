// SPDX-License-Identifier: MIT
// Voxel objects drawn as boxes, whose fragments march: shared by voxel_proxies.vert, .frag and .comp and the C++ code
// that draws with them (voxel_pictures_vk.h).
//
//   .vert   a box per object, a little larger, with a depth in front of all hits in it
//   .frag   the ray of the pixel through the object ──▶ depth, object, t, voxel, face
//   .comp   the winner of each pixel ──▶ ScarpVoxelHit; kScarpVoxelTied where another object may be as near
//
// The depth of a hit has 24 bits, its t 53. Two objects may therefore have hits at the same depth, of which the first
// one drawn stays and the nearer one may be lost. The last shader finds all pixels where this is possible: those whose
// ray enters another box within the part at this depth. Compute traces these.
#ifndef SCARP_MARCH_VOXEL_PROXIES_GLSL_H
#define SCARP_MARCH_VOXEL_PROXIES_GLSL_H

#include "scarp/march/voxel/voxel_double.glsl.h"
#include "scarp/march/voxel/voxel_rays.glsl.h"

SCARP_GLSL_BEGIN

/// Layout of the rays of a picture. A point p has (x, y, w) = rows (p - origin) + (parallel: (-1, -1, 1)), x / w and y
/// / w from -1 to 1 from left to right and from top to bottom of the picture, and hits at p have t >= depth (p -
/// origin).
struct ScarpVoxelView {
  dvec3 origin;
  dvec3 x;
  dvec3 y;
  dvec3 w;
  dvec3 depth;
  dvec3 direction;  ///< of parallel rays
  double margin;    ///< enlargement of boxes, per w
  uint parallel;
  uint none;
};

/// Push constants of all three shaders.
struct VoxelProxies {
  Address objects;
  Address rays;  ///< of all pixels, row by row
  Address view;
  Address first;   ///< of each pixel: object, t in two words, status + 8 face + 64 steps
  Address second;  ///< voxel, entry
  Address hits;
  uint width;
  uint count;  ///< pixels
  int turns;   ///< steps of a ray in an object
  float room;  ///< maximum distance of hits from their object's box, in metres
};

// Binades of t with distinct depths; nearer and farther t share one.
const int kScarpLeastBinade = -63;
const uint kScarpBinades = 126u;
const uint kScarpDepthsPerBinade = 1u << 23;

/// Bits of a depth, larger for nearer ones: normal numbers below 1, with as many values per binade as floats have.
SCARP_FN uint scarp_depth_bits(double t) {
  uvec2 words = unpackDouble2x32(t);
  int binade = int(words.y >> 20 & 0x7ffu) - 1023 - kScarpLeastBinade;
  uint distance = 0u;
  if (t > double(0.0f) && binade >= 0) {
    distance = binade < int(kScarpBinades) ? uint(binade) << 23 | (words.y & 0xfffffu) << 3 | words.x >> 29
                                           : kScarpBinades * kScarpDepthsPerBinade - 1u;
  }
  return 0x3f7fffffu - distance;
}

/// Whether t that differ by more than 2^-23 share this depth.
SCARP_FN bool scarp_depth_is_coarse(double t) {
  uint distance = 0x3f7fffffu - scarp_depth_bits(t);
  return distance == 0u || distance == kScarpBinades * kScarpDepthsPerBinade - 1u;
}
/// The smallest and the largest t of the same depth, unless that is coarse.
SCARP_FN double scarp_least_of_depth(double t) {
  uvec2 words = unpackDouble2x32(t);
  return packDouble2x32(uvec2(words.x & 0xe0000000u, words.y));
}
SCARP_FN double scarp_largest_of_depth(double t) {
  uvec2 words = unpackDouble2x32(t);
  return packDouble2x32(uvec2(words.x | 0x1fffffffu, words.y));
}

#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer VoxelViews { ScarpVoxelView is; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer VoxelPixels { uvec4 of[]; };
layout(push_constant, scalar) uniform Push { VoxelProxies push; };

#endif

SCARP_GLSL_END

#endif
