// SPDX-License-Identifier: MIT
// Shared by the stages of a picture (terrain_frame.glsl.h): constants, buffers, positions and directions. GLSL; a stage
// includes this first.

#include "scarp/march/height/ground_host.glsl.h"
#include "scarp/render/frame/terrain_frame.glsl.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool stepped = false;
layout(constant_id = 2) const uint parts = 0xffffffffu;
layout(constant_id = 3) const uint field_flags = 0u;
const bool has_water = (parts & kFrameHasWater) != 0u;
const bool has_shadows = (parts & kFrameHasShadows) != 0u;
const bool has_patches = (parts & kFrameHasPatches) != 0u;
const bool has_drape = (parts & kFrameHasDrape) != 0u;
const bool has_contours = (parts & kFrameHasContours) != 0u;
const bool has_fog = (parts & kFrameHasFog) != 0u;
const bool has_samples = (parts & kFrameHasSamples) != 0u;
const bool has_plinth = (parts & kFrameHasPlinth) != 0u;
const bool has_rims = (parts & kFrameHasRims) != 0u;
const bool has_scattering = (parts & kFrameHasScattering) != 0u;
const bool has_texture = (parts & kFrameHasTexture) != 0u;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Settings { FrameSettings is; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Seens { FrameSeen of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Waters { FrameWater of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Indices { uint of[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Counters { FrameCounters are; };
layout(push_constant, scalar) uniform Push { FramePush push; };

Settings settings() { return Settings(push.settings); }

// The FrameSeen of the ray of a pixel in this part of the picture.
uint seen_index(int ray, uint slot) { return uint(ray) * push.count + slot; }

ScarpTwoFloat two(float high, float low) { return ScarpTwoFloat(high, low); }

// Convert between unit vectors in world space and directions in grid space.
vec3 world_direction(vec3 grid) {
  Settings s = settings();
  return vec3(grid.x * s.is.cell.x, -grid.y * s.is.cell.y, grid.z * s.is.metres_per_sample);
}
vec3 grid_direction(vec3 world) {
  Settings s = settings();
  return vec3(world.x * s.is.per_cell.x, -world.y * s.is.per_cell.y, world.z * s.is.per_metre);
}
vec3 direction_of(ScarpLine line) { return normalize(world_direction(line.direction)); }

// Unit normal of a surface with this slope per column and row.
vec3 normal_of(vec2 slope) {
  Settings s = settings();
  vec2 metres = slope * s.is.metres_per_sample * s.is.per_cell;
  return normalize(vec3(-metres.x, metres.y, 1.0));
}

float height_of(float sample_height) {
  Settings s = settings();
  return (sample_height - s.is.base_of_heights) * s.is.metres_per_sample + s.is.metres_at_base;
}

// The field that the picture shows.
ScarpField shown_field() {
  ScarpField field = open_ground(push.ground);
  field.flags = field_flags;
  return field;
}

// Whether the current light rays go to the sun; rays to the sky follow them.
bool goes_to_sun() { return has_samples ? push.light < settings().is.sun_rays : has_shadows; }

// Ground to light and paint.
void list_ground(uint seen) {
  uint at = atomicAdd(Counters(push.counters).are.grounds, 1u);
  Indices(push.grounds).of[at] = seen;
}
