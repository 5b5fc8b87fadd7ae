// SPDX-License-Identifier: MIT
// Pictures of height fields with water, air and light: the looks `comanche` and `shaded`, one invocation per pixel. See
// terrain_frame.glsl.h; what is done for a point is LakeTile's (lake_tile.h), in single precision.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/march/function/noise.glsl.h"

// Defined below: the marches ask for their ground.
float scarp_sample(int col, int row);
bool scarp_is_nodata(float value);
float scarp_maximum(int level, int col, int row);
float scarp_minimum(int level, int col, int row);

#include "scarp/march/height/height_marches.glsl.h"
#include "scarp/march/height/surface_normal.glsl.h"
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

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Pixels { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer States { FrameState states[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Sights { FrameSight sights[]; };
layout(push_constant, scalar) uniform Push { FramePush push; };

#include "scarp/march/height/ground_host.glsl.h"
#include "scarp/render/frame/terrain_frame_ground.glsl.h"
// These ask it for places and directions.
#include "scarp/render/frame/terrain_frame_light.glsl.h"
#include "scarp/render/frame/terrain_frame_plinth.glsl.h"
#include "scarp/render/frame/terrain_frame_water.glsl.h"

float eye_height(FrameSeen seen) { return height_of(seen.line.origin.z); }
vec3 direction_of(FrameSeen seen) { return normalize(world_direction(seen.line.direction)); }

ScarpSky the_sky() {
  ScarpSky sky = settings().is.sky;
  if (!has_scattering) sky.scattering = 0;  // a constant to the compiler
  return sky;
}

vec3 in_air(vec3 colour, FrameSeen seen, vec3 direction, float metres) {
  Settings s = settings();
  if (!has_fog || s.is.fog == kScarpNoFog)
    return scarp_in_haze(colour, the_sky(), direction, s.is.haze_per_metre, metres - s.is.clear_distance);
  if (s.is.fog == kScarpFogByIterations) return colour;
  float left = scarp_fog_transmittance(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff, eye_height(seen),
                                       direction.z, metres);
  return scarp_between(scarp_fog_colour(the_sky(), direction, s.is.sun_tint), colour, left);
}

// Transmittance of the fog for light from beyond the scene.
float left_from_beyond(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  if (!has_fog) return 1.0;
  return scarp_fog_transmittance_of_sky(s.is.fog, s.is.fog_per_metre, s.is.fog_base, s.is.fog_falloff, eye_height(seen),
                                        direction.z);
}

// Of what is not ground.
vec3 beside_ground(FrameSeen seen, vec3 direction) {
  Settings s = settings();
  if (seen.kind == kFrameWall) {
    // It stands on the side of its cell through which the ray came in.
    float from_x = direction.x > 0.0 ? seen.place.x : 1.0 - seen.place.x;
    float from_y = direction.y > 0.0 ? 1.0 - seen.place.y : seen.place.y;
    bool on_x = direction.y == 0.0 || (direction.x != 0.0 && from_x <= from_y);
    vec3 normal =
        on_x ? vec3(direction.x > 0.0 ? -1.0 : 1.0, 0.0, 0.0) : vec3(0.0, direction.y > 0.0 ? -1.0 : 1.0, 0.0);
    float lit = max(0.0, dot(normal, s.is.to_sun));
    return in_air(s.is.earth * (s.is.unlit_wall + (1.0 - s.is.unlit_wall) * lit), seen, direction,
                  seen.t.high * seen.metres);
  }
  ScarpSky air = the_sky();
  vec3 sky = s.is.no_descent != 0 ? scarp_sky_beyond(air, direction) : scarp_sky_colour(air, direction);
  if (!has_fog || s.is.fog == kScarpNoFog || s.is.fog == kScarpFogByIterations) return sky;
  float left = left_from_beyond(seen, direction);
  return scarp_between(scarp_fog_colour(the_sky(), direction, s.is.sun_tint), sky, left);
}

vec3 shading_normal(ScarpField field, FrameSeen seen) {
  return normal_of(scarp_shading_slope(field, seen.cell, seen.place));
}

// Ground in its light, without air.
vec3 lit_ground(ScarpField field, FrameSeen seen) {
  Settings s = settings();
  vec3 colour = ground_colour(field, seen, direction_of(seen), seen.normal);
  if (s.is.unlit != 0) return colour;
  return colour * scarp_light(seen.normal, s.is.sky_side, s.is.skylight, s.is.sun, seen.sun_cosine, seen.sky);
}

vec3 seen_colour(FrameSeen seen) {
  vec3 direction = direction_of(seen);
  if (seen.kind != kFrameGround) return beside_ground(seen, direction);
  return in_air(seen.light, seen, direction, seen.t.high * seen.metres);
}

ScarpTwoFloat camera_number(float base, float base_low, float right, float right_low, float down, float down_low,
                            vec2 at) {
  return scarp_two_combine(two(right, right_low), scarp_two(at.x), two(down, down_low), scarp_two(at.y),
                           two(base, base_low));
}

// The camera's ray through a place in the picture, in pixels.
FrameSeen camera_ray(vec2 at) {
  Settings s = settings();
  ScarpLine base = s.is.line;
  ScarpLine right = s.is.line_right;
  ScarpLine down = s.is.line_down;
  FrameSeen seen;
  for (int i = 0; i < 3; ++i) {
    ScarpTwoFloat d = camera_number(base.direction[i], base.direction_low[i], right.direction[i],
                                    right.direction_low[i], down.direction[i], down.direction_low[i], at);
    seen.line.direction[i] = d.high;
    seen.line.direction_low[i] = d.low;
    ScarpTwoFloat o = two(base.origin[i], base.origin_low[i]);
    if (s.is.orthographic != 0)
      o = camera_number(base.origin[i], base.origin_low[i], right.origin[i], right.origin_low[i], down.origin[i],
                        down.origin_low[i], at);
    seen.line.origin[i] = o.high;
    seen.line.origin_low[i] = o.low;
  }
  seen.metres = length(world_direction(seen.line.direction));
  seen.end = scarp_two(s.is.reach / seen.metres);
  return seen;
}

// What an invocation keeps from ray to ray: that of the camera's here, that of the water's in memory.
uint slot;
FrameSeen camera_seen;
FrameWater water_met;
FrameSeen seen_of(int ray) {
  if (!has_water || ray == kFrameCamera) return camera_seen;
  return States(push.states).states[slot].seen[ray];
}
void keep(int ray, FrameSeen seen) {
  if (!has_water || ray == kFrameCamera)
    camera_seen = seen;
  else
    States(push.states).states[slot].seen[ray] = seen;
}

// The ray that is under way.
struct Sent {
  int light;  // of a task of light: which of its rays
  float weight;
  bool walls;  // it sees those at rims
  ScarpSent ray;
  ScarpHit hit;
  ScarpWalk walk;
  ScarpMarchState looks;
  ScarpSampling step;
};

FrameSeen no_sight() {
  FrameSeen seen;
  seen.line = ScarpLine(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  seen.metres = 1.0;
  seen.asked = 0;
  seen.kind = kFrameNothing;
  seen.t = scarp_two(kScarpNever);
  seen.end = scarp_two(0.0);
  seen.cell = ivec2(0);
  seen.place = vec2(0.0);
  seen.sun_cosine = 0.0;
  seen.sky = 0.0;
  seen.normal = vec3(0.0);
  seen.light = vec3(0.0);
  seen.steps = 0u;
  return seen;
}

// Time between two samples of a stepped ray.
float step_of(FrameSeen seen, bool of_camera) {
  Settings s = settings();
  float step = s.is.step / (of_camera && s.is.shells == 0 ? 1.0 : seen.metres);
  if (s.is.step_by_view == 0) return step;
  vec3 direction = direction_of(seen);
  return step / max(length(direction.xy), 0.125);
}

// How far a stepped ray goes, in its time. Less than 0: nowhere.
float stepped_end(ScarpField field, FrameSeen seen, float step) {
  float end = min(seen.end.high, step * float(settings().is.steps));
  if (!(seen.line.direction.z > 0.0)) return end;
  float leaves = ((field.highest - seen.line.origin.z) - seen.line.origin_low.z) / seen.line.direction.z;
  return leaves < 0.0 ? -1.0 : min(end, leaves + step);
}

// The step at which a stepped ray of the camera finds out that it has met the water at time `plane`.
float stop_of(ScarpField field, FrameSeen seen, float step, float plane) {
  float first = 0.0;
  if ((field.flags & kScarpWraps) == 0u) {
    // Of a ray along an axis the span is endless.
    first = max(0.0, max(scarp_span_x(field, seen.line).begin.high, scarp_span_y(field, seen.line).begin.high));
  }
  return first + ceil((plane - first) / step) * step;
}

// The field as a ray has it.
ScarpField seen_by(ScarpField field, bool walls) {
  if (has_rims && walls) field.flags |= kScarpSolid;
  return field;
}

ScarpSampling fixed_step(float step, int interpolate, int max_steps) {
  return scarp_fixed_step(step, interpolate != 0 ? kScarpRefineSecant : kScarpRefineNone, max_steps);
}

// Sends the ray of a task; false: there is none, or nothing is on its way.
bool send(ScarpField field, int task, inout Sent sent) {
  Settings s = settings();
  bool light = task >= kFrameSeens;
  FrameSeen seen = seen_of(light ? task - kFrameSeens : task);
  sent.hit = scarp_no_hit();
  if (light ? seen.kind != kFrameGround : seen.asked == 0) return false;
  ScarpLine line = seen.line;
  ScarpTwoFloat begin = scarp_two(0.0);
  ScarpTwoFloat end = seen.end;
  uint how = stepped ? kScarpSendSampled : 0u;
  ivec2 cell = seen.cell;
  vec2 place = seen.place;
  if (light) {
    if (sent.light == 0) {
      seen.normal = shading_normal(field, seen);
      seen.sun_cosine = has_shadows ? 0.0 : max(0.0, dot(seen.normal, s.is.to_sun));
      keep(task - kFrameSeens, seen);
    }
    if (light_rays() == 0) return false;
    LightRay ray = light_ray(field, seen, sent.light);
    sent.weight = ray.weight;
    if (!(ray.weight > 0.0)) return false;
    line = ray.line;
    end = scarp_two(ray.end);
    how |= kScarpSendFromSurface;
    sent.step = fixed_step(s.is.sun_step, s.is.sun_interpolate, s.is.sun_steps);
  } else {
    FrameWater water = water_met;
    if (task == kFrameCamera) water = water_on(field, line, end);
    if (stepped) {
      float step = step_of(seen, task == kFrameCamera);
      sent.step = fixed_step(step, s.is.interpolate, s.is.steps + 1);
      float last = stepped_end(field, seen, step);
      if (last < 0.0) {
        sent.hit.steps = 1u;
        water.kind = 0;
      } else if (water.kind != 0 && task == kFrameCamera) {
        // Known at the first step that is past it, if the ray goes so far.
        float stop = stop_of(field, seen, step, water.t.high);
        if (stop > last) water.kind = 0;
        last = min(last, stop);
        if (s.is.interpolate == 0) water.t = scarp_two(stop);
        // Its side and its bottom are not asked for.
        water.sea = 0;
        water.normal = vec3(0.0, 0.0, 1.0);
      }
      if (task == kFrameCamera) water_met = water;
      if (last < 0.0) return false;
      end = scarp_two(last);
    } else if (task == kFrameCamera) {
      // Above the highest ground there is nothing more to meet.
      if (line.direction.z > 0.0) {
        float leaves = (field.highest - line.origin.z) / line.direction.z;
        end = scarp_two_earlier(end, scarp_two(max(0.0, leaves)));
        if (scarp_two_less(end, water.t)) water.kind = 0;
      }
      if (water.kind != 0) end = water.t;
      bool hidden = has_plinth && hidden_by_plinth(field, begin, end, seen);
      if (seen.kind == kFrameWall) water.kind = 0;
      water_met = water;
      if (hidden) {
        keep(task, seen);
        return false;
      }
    }
    if (task != kFrameCamera && has_rims) end_at_base(line, end);
    if (task != kFrameCamera && water.sea != 0) {
      how |= kScarpSendFromSurface;
      cell = water.cell;
      place = water.place;
    }
  }
  sent.walls = has_rims && !light;
  sent.ray = scarp_send(seen_by(field, sent.walls), line, begin, end, how, cell, place);
  if (sent.ray.marches == 0) return false;
  if (sent.walls) sent.walls = meets_rims(field, sent.ray.ray);
  if (stepped) {
    sent.looks = scarp_sampled_begin(field, sent.ray.ray, sent.step);
    return true;
  }
  return scarp_begin_walk(field, sent.ray.ray, sent.walk, sent.hit);
}

// Rays that the water sends on.
void send_from_water(ScarpField field, FrameSeen camera, inout FrameWater water) {
  Settings s = settings();
  vec3 direction = direction_of(camera);
  float metres = water.t.high * camera.metres;
  ScarpTwoFloat x = scarp_line_col(camera.line, water.t);
  ScarpTwoFloat y = scarp_line_row(camera.line, water.t);
  ScarpTwoFloat z = scarp_line_height(camera.line, water.t);
  vec3 normal = water.normal;
  float roughness = 0.0;
  if (normal.z > 0.0) {
    // A pixel is longer on the water than it is wide, seen at a grazing angle.
    float wide = s.is.pixel_width * (s.is.orthographic != 0 ? 1.0 : metres);
    float footprint = wide / sqrt(max(-direction.z, 0.01));
    normal = water_normal(paint_place(camera.line, water.t), footprint);
    if (has_scattering) roughness = water_roughness(footprint);
    if (dot(normal, direction) >= 0.0) normal = vec3(0.0, 0.0, 1.0);
  }
  water.reflectance = scarp_schlick(-dot(normal, direction), 1.333);
  if (has_scattering && water.normal.z > 0.0)
    water.glitter = scarp_glitter(the_sky(), s.is.sun, direction, normal, roughness, water.reflectance);
  vec3 mirrored = scarp_reflected(direction, normal);
  if (water.normal.z > 0.0) mirrored = scarp_kept_above(mirrored);
  FrameSeen sent = no_sight();
  sent.line = ScarpLine(vec3(x.high, y.high, z.high), vec3(x.low, y.low, z.low), grid_direction(mirrored), vec3(0.0));
  sent.end = scarp_two(s.is.reach);
  sent.asked = s.is.reflection;
  keep(kFrameMirror, sent);
  if (s.is.refraction == 0 || water.sea != 0) return;
  sent.line.direction = grid_direction(scarp_refracted(direction, normal, 1.333));
  sent.end = scarp_two(min(s.is.reach, leaves_water(field, sent.line)));
  sent.asked = 1;
  keep(kFrameBottom, sent);
}

// What the ray of a task has found.
void take(ScarpField field, int task, Sent sent) {
  Settings s = settings();
  bool met = sent.hit.status == kScarpHit || sent.hit.status == kScarpWall;
  if (task >= kFrameSeens) {
    FrameSeen lit = seen_of(task - kFrameSeens);
    if (lit.kind != kFrameGround) return;
    int rays = light_rays();
    if (!met && rays > 0) {
      if (goes_to_sun(sent.light))
        lit.sun_cosine += sent.weight;
      else
        lit.sky += 1.0;
    }
    if (sent.light + 1 >= rays) {
      if (has_samples && has_shadows) lit.sun_cosine /= float(s.is.sun_rays);
      lit.sky = has_samples && s.is.sky_rays > 0 ? lit.sky / float(s.is.sky_rays) : 1.0;
      lit.light = lit_ground(field, lit);
    }
    keep(task - kFrameSeens, lit);
    return;
  }
  FrameSeen seen = seen_of(task);
  seen.steps = stepped ? min(sent.hit.steps, uint(s.is.steps)) : sent.hit.steps;
  if (met) {
    seen.kind = sent.hit.status == kScarpWall ? kFrameWall : kFrameGround;
    seen.t = scarp_sent_time(sent.ray, sent.hit);
    seen.cell = sent.hit.cell;
    seen.place = sent.hit.place;
  }
  if (task == kFrameCamera) {
    FrameWater water = water_met;
    // Exact rays end at the water. Of samples ground is asked for first and water then; in between, what comes first
    // counts.
    if (met && water.kind != 0) {
      if (stepped && s.is.interpolate != 0 && water.t.high < seen.t.high)
        seen.kind = kFrameNothing;
      else
        water.kind = 0;
    }
    if (has_water && seen.kind == kFrameGround && is_sea(field, seen.cell)) {
      water.kind = 1;
      water.t = seen.t;
      water.sea = 1;
      water.cell = seen.cell;
      water.place = seen.place;
      water.normal = vec3(0.0, 0.0, 1.0);
    }
    if (has_water && water.kind != 0) send_from_water(field, seen, water);
    water_met = water;
  }
  keep(task, seen);
}

vec3 water_colour(FrameWater water) {
  Settings s = settings();
  vec3 body = s.is.deep;
  FrameSeen bottom = seen_of(kFrameBottom);
  if (bottom.asked != 0) {
    if (bottom.kind != kFrameNothing) {
      float depth = s.is.level - height_of(scarp_line_height(bottom.line, bottom.t).high);
      vec3 sunlight = scarp_left_after(s.is.water_per_metre, scarp_sun_way(depth, s.is.to_sun.z, 1.333));
      body =
          scarp_through_water(bottom.light * sunlight, s.is.deep, s.is.water_per_metre, bottom.t.high * bottom.metres);
    } else if (bottom.end.high < 0.5 * kScarpNever) {
      body = scarp_through_water(beside_ground(bottom, direction_of(bottom)), s.is.deep, s.is.water_per_metre,
                                 bottom.end.high);
    }
  }
  FrameSeen mirror = seen_of(kFrameMirror);
  vec3 colour = seen_colour(mirror) * water.reflectance + body * (1.0 - water.reflectance);
  if (has_scattering && mirror.kind == kFrameNothing)
    colour += water.glitter * left_from_beyond(mirror, direction_of(mirror));
  return colour;
}

bool shows_something() { return seen_of(kFrameCamera).kind == kFrameGround || (has_water && water_met.kind != 0); }

vec3 colour_of_point() {
  Settings s = settings();
  FrameSeen camera = seen_of(kFrameCamera);
  FrameWater water = water_met;
  float share = min(1.0, float(camera.steps) / float(s.is.most_steps));
  if (s.is.iterations != 0) {
    // A stepped ray that hits nothing takes all its steps, sampled or not.
    bool meets = camera.kind != kFrameNothing || (has_water && water.kind != 0);
    return vec3(stepped && !meets ? 1.0 : share);
  }
  vec3 direction = direction_of(camera);
  vec3 colour;
  if (has_water && water.kind != 0)
    colour = in_air(water_colour(water), camera, direction, water.t.high * camera.metres);
  else
    colour = seen_colour(camera);
  if (has_scattering && !(has_water && water.kind != 0) && camera.kind == kFrameNothing)
    colour += scarp_sun_disc(the_sky(), direction) * left_from_beyond(camera, direction);
  if (has_fog && s.is.fog == kScarpFogByIterations)
    colour = scarp_between(colour, scarp_fog_colour(the_sky(), direction, s.is.sun_tint), share);
  return colour;
}

void begin_point() {
  Settings s = settings();
  int aa = s.is.aa;
  vec2 at = vec2(float(pixel % uint(s.is.width)), float(pixel / uint(s.is.width))) +
            (vec2(float(point % aa), float(point / aa)) + 0.5) / float(aa);
  FrameSeen none = no_sight();
  FrameSeen camera = camera_ray(at);
  none.line = camera.line;
  none.metres = camera.metres;
  none.end = camera.end;
  none.asked = 1;
  keep(kFrameCamera, none);
  if (!has_water) return;
  for (int ray = kFrameMirror; ray <= kFrameBottom; ++ray) {
    States(push.states).states[slot].seen[ray].asked = 0;
    States(push.states).states[slot].seen[ray].kind = kFrameNothing;
  }
}

void tell_sight() {
  FrameSeen camera = seen_of(kFrameCamera);
  FrameWater water = water_met;
  FrameSight sight;
  sight.kind = water.kind != 0 ? kFrameWater : camera.kind;
  sight.t = (water.kind != 0 ? water.t.high : camera.t.high) * camera.metres;
  sight.cell = camera.cell;
  sight.steps = camera.steps;
  Sights(push.sights).sights[pixel] = sight;
}

void main() {
  slot = gl_GlobalInvocationID.x;
  if (slot >= push.count) return;
  pixel = push.first + slot;
  int points = settings().is.aa * settings().is.aa;
  int tasks = settings().is.iterations != 0 ? 1 : kFrameTasks;
  ScarpField field = open_ground(push.ground);
  field.flags = field_flags;
  Sent sent;
  sent.light = 0;
  sent.weight = 0.0;
  sent.walls = false;
  point = 0;
  int task = -1;
  bool under_way = false;
  vec3 sum = vec3(0.0);
  int shown = 0;
  if (push.resume != 0u) {
    if (Pixels(push.pixels).words[slot] != 0u) return;
    States all = States(push.states);
    point = all.states[slot].point;
    task = all.states[slot].task;
    under_way = all.states[slot].under_way != 0;
    sum = all.states[slot].sum;
    shown = all.states[slot].shown;
    camera_seen = all.states[slot].seen[kFrameCamera];
    water_met = all.states[slot].water;
    sent.light = all.states[slot].light;
    sent.weight = all.states[slot].weight;
    sent.walls = all.states[slot].walls != 0;
    sent.ray = all.states[slot].sent;
    sent.hit = all.states[slot].hit;
    sent.step = all.states[slot].step;
    if (stepped)
      sent.looks = all.states[slot].looks;
    else
      sent.walk = all.states[slot].walk;
  }
  for (int round = 0; round < kFrameRounds && point < points; ++round) {
    if (task < 0) {
      begin_point();
      task = 0;
    }
    if (!under_way) under_way = send(field, task, sent);
    if (under_way) {
      sent.step.march = kScarpFixedStep;  // a constant to the compiler
      bool done = stepped ? scarp_sampled_on(field, sent.ray.ray, sent.step, kFrameTurns, sent.looks, sent.hit)
                          : scarp_go_on(seen_by(field, sent.walls), sent.ray.ray, task >= kFrameSeens, kFrameTurns,
                                        sent.walk, sent.hit);
      if (!done) break;
      under_way = false;
    }
    take(field, task, sent);
    if (has_samples && task >= kFrameSeens && sent.light + 1 < light_rays() &&
        seen_of(task - kFrameSeens).kind == kFrameGround) {
      sent.light += 1;
      continue;
    }
    sent.light = 0;
    // Where there is no water there is but the camera's ray to be lit.
    task = has_water && water_met.kind != 0 ? task + 1 : task == kFrameCamera ? kFrameSeens : kFrameTasks;
    if (task < tasks) continue;
    if (point == 0 && push.tell_sights != 0u) tell_sight();
    if (settings().is.alpha == 0 || shows_something()) {
      sum += colour_of_point();
      shown += 1;
    }
    point += 1;
    task = -1;
  }
  if (point < points) {
    States all = States(push.states);
    all.states[slot].point = point;
    all.states[slot].task = task;
    all.states[slot].under_way = under_way ? 1 : 0;
    all.states[slot].sum = sum;
    all.states[slot].shown = shown;
    all.states[slot].seen[kFrameCamera] = camera_seen;
    all.states[slot].water = water_met;
    all.states[slot].light = sent.light;
    all.states[slot].weight = sent.weight;
    all.states[slot].walls = sent.walls ? 1 : 0;
    all.states[slot].sent = sent.ray;
    all.states[slot].hit = sent.hit;
    all.states[slot].step = sent.step;
    if (stepped)
      all.states[slot].looks = sent.looks;
    else
      all.states[slot].walk = sent.walk;
    Pixels(push.pixels).words[slot] = 0u;
    return;
  }
  vec3 colour = sum / float(max(shown, 1));
  if (settings().is.tone_curve != 0) colour = scarp_toned(colour);
  Pixels(push.pixels).words[slot] = uint(scarp_srgb_byte(colour.x)) | (uint(scarp_srgb_byte(colour.y)) << 8) |
                                    (uint(scarp_srgb_byte(colour.z)) << 16) |
                                    (scarp_frame_opacity(float(shown) / float(points)) << 24);
}
