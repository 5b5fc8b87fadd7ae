// SPDX-License-Identifier: MIT
// A mesh between terrain, for the shaders that draw it (mesh_raster_vk.h): corners, the camera, the light, the way into
// the field, and the map of what the mesh hides from the sun.
//
// Positions are metres from a base in the middle of the mesh, which the host has in double: floats hold the mesh's size
// and not its place.
#ifndef SCARP_RENDER_MESH_VIEW_GLSL_H
#define SCARP_RENDER_MESH_VIEW_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

struct MeshVertex {
  vec3 position;  // metres from the base
  vec3 normal;    // for its light
  vec3 plane;     // unit normal of the triangle, either way
  vec3 colour;    // linear light
};

// What of the mesh is nearest to the sun, on a square of texels across its direction. Texel (i, j) tells of the line to
// the sun through low + ((i + 1/2) across + (j + 1/2) up) texel, in heights h along the sun from `low`:
//
//        sun
//         \  | |      map: h / range of the highest point of the mesh on that line; 0: none
//          \_|_|__    A point is hidden where its own h is below that.
//             ^ ^     The line is up to 1/2 texel beside the point along either axis, and a corner of the mesh up to
//             | p     2^-(bits + 1) texel beside its place (vk/raster.h); so edges of shadows are right to
//           line      `reach` = 1/2 + 2^-(bits + 1) texel along each axis.
//
// Bias. On the plane of the point itself, with unit normal n, h changes by |n across / n sun| per metre: as much as
// over `reach` along both axes is granted to a point of the mesh, so that a plane does not hide itself, and no more.
// Terrain is not in the map and needs none. For both `rounding` (16 v of the mesh's size, over range) covers h: 8
// roundings in the map, as many in the point's.
struct SunMap {
  vec3 low;                 // metres from the base
  vec3 across, up, to_sun;  // unit vectors
  float texel;              // metres
  int side;                 // texels; 0: there is no map
  float range;              // metres
  float reach;              // texels
  float rounding;           // of h / range
};

struct MeshView {
  Address corners;  // MeshVertex
  Address ground;   // GroundBuffers
  Address map;      // floats of the SunMap
  Address colours;  // of the terrain: vec3, row by row
  Address depths;   // and depths as in the depth buffer
  // Clip coordinates of (position, 1).
  vec4 clip_x, clip_y, clip_z, clip_w;
  vec4 eye;  // metres from the base and 1; or, where all rays are parallel, a unit vector against them and 0
  vec3 to_sun, sun, sky_side;  // of render/light/light.h
  SunMap sun_map;
  // The base, over the field: cell, place in it, sample units (high + low); and grid units per metre.
  ivec2 base_cell;
  vec2 base_place;
  float base_z, base_z_low;
  vec3 grid_per_metre;
  uint width;    // of the target
  uint shadows;  // 0 or 1
};

struct MeshPush {
  Address view;  // MeshView
};

SCARP_GLSL_END

#endif
