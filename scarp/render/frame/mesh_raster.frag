// SPDX-License-Identifier: MIT
// The mesh in the light of sun and sky (render/light/light.h): whether terrain hides the sun is asked by an any-hit ray
// from the fragment, whether the mesh itself does by the map.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/render/frame/mesh_view.glsl.h"
#include "scarp/render/light/air.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer View { MeshView is; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SunHeights { float heights[]; };
layout(push_constant, scalar) uniform Push { MeshPush push; };

#include "scarp/march/height/float_ray.glsl.h"
#include "scarp/march/height/ground_host.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
layout(location = 3) flat in vec3 plane_normal;

layout(location = 0) out vec4 shown;  // and 1 where the mesh is seen
layout(location = 1) out vec4 facing;

// The sun at less than 2^-20 cell per sample unit sideways is straight above.
const float kUpright = 9.5367431640625e-7;

bool terrain_hides_sun(View view) {
  ScarpField field = open_ground(view.is.ground);
  if (field.top_level < 1) return false;
  vec3 from_base = position * view.is.grid_per_metre;
  vec3 direction = view.is.to_sun * view.is.grid_per_metre;
  if (max(abs(direction.x), abs(direction.y)) < kUpright * abs(direction.z)) direction.xy = vec2(0.0);
  ScarpTwoFloat z = scarp_two_add(scarp_two_sum(view.is.base_z, view.is.base_z_low), scarp_two(from_base.z));
  // The sun is above the horizon: nothing is above the highest sample.
  if (z.high > field.highest) return false;
  vec2 over = view.is.base_place + from_base.xy;
  ivec2 whole = ivec2(floor(over));
  ivec2 cell = view.is.base_cell + whole;
  if ((field.flags & kScarpWraps) != 0u) {
    cell -= ivec2(floor(vec2(cell) / vec2(field.cells))) * field.cells;
    cell = clamp(cell, ivec2(0), field.cells - 1);
  }
  ScarpRay ray;
  float rise = (field.highest - field.lowest) + (field.highest - z.high);
  if (all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, field.cells))) {
    ray = scarp_ray(cell, over - vec2(whole), z.high, direction, 0.0, 0u);
    ray.z_low = z.low;
    ray.end = rise / ray.direction.z;
  } else {
    if (!scarp_ray_from(field, vec3(vec2(view.is.base_cell) + over, z.high), direction, kScarpNever, ray)) return false;
    ray.end = min(ray.end, rise / ray.direction.z);
  }
  int status = scarp_max_mip(field, ray, true).status;
  return status == kScarpHit || status == kScarpWall;
}

// As SunShadow::hides (sun_shadow.cpp), for a point of the mesh on a plane.
bool mesh_hides_sun(View view, vec3 plane) {
  SunMap map = view.is.sun_map;
  vec3 from_low = position - map.low;
  ivec2 texel = ivec2(floor(vec2(dot(from_low, map.across), dot(from_low, map.up)) / map.texel));
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(map.side)))) return false;
  float slope = abs(dot(plane, map.across)) + abs(dot(plane, map.up));
  float granted = map.reach * map.texel * slope / abs(dot(plane, map.to_sun));
  float height = (dot(from_low, map.to_sun) + granted) / map.range + map.rounding;
  return SunHeights(view.is.map).heights[texel.y * map.side + texel.x] > max(height, 0.0);
}

void main() {
  View view = View(push.view);
  // Vectors are loaded whole: of one in a buffer Mesa's lavapipe (22.3) takes the first number for any.
  vec4 eye = view.is.eye;
  vec3 sky_side = view.is.sky_side;
  // Both sides of a triangle are seen: the one that is turned to the eye.
  vec3 to_eye = eye.xyz - position * eye.w;
  vec3 plane = dot(plane_normal, to_eye) < 0.0 ? -plane_normal : plane_normal;
  vec3 n = normalize(normal);
  n = dot(n, plane) < 0.0 ? -n : n;
  float sun = max(0.0, dot(n, view.is.to_sun));
  // A triangle that turns away from the sun is hidden by itself, whatever its corners' normals say.
  if (dot(plane, view.is.to_sun) <= 0.0) sun = 0.0;
  if (sun > 0.0 && view.is.shadows != 0u && (mesh_hides_sun(view, plane) || terrain_hides_sun(view))) sun = 0.0;
  shown = vec4(colour * scarp_light(n, sky_side, view.is.sun, sun, 1.0), 1.0);
  facing = vec4(n, 0.0);
}
