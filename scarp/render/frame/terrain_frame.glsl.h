// SPDX-License-Identifier: MIT
// A picture of a height field made on a device: what the compute shader terrain_frame.comp and the C++ that calls it
// (terrain_frame_vk.h) agree upon.
//
//   FramePush ──settings──▶ FrameSettings ──ramp──▶ pieces and colours of a ramp;  ──drape──▶ a picture on the ground
//       │  ├──ground────▶ GroundBuffers
//       │  ├──pixels────▶ a word per pixel: red | green << 8 | blue << 16 | opacity << 24; 0: not done
//       │  ├──states────▶ FrameState, of each invocation
//       │  └──sights────▶ FrameSight per pixel, for those who ask what rays have found
//       └─ which pixels; whether they go on from their states
//
// One invocation makes one pixel, its rays one after another: the camera's, the mirrored one, the one to the water's
// bottom, those to sun and sky from where these end. It is interrupted after kFrameRounds rays, or kFrameTurns turns of
// a march: that keeps a run short (vk/loop_turns.glsl.h says why). Its neighbours in a vector wait for the slowest, so
// what counts is the sum over rays of the most turns of any.
#ifndef SCARP_RENDER_TERRAIN_FRAME_GLSL_H
#define SCARP_RENDER_TERRAIN_FRAME_GLSL_H

#ifdef __cplusplus
#include "scarp/march/height/march_host.h"
#endif
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/height/two_float_ray.glsl.h"
#include "scarp/march/sampling.glsl.h"
#include "scarp/render/light/air.glsl.h"
#include "scarp/render/surface/water.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Specialisation constants: threads of a workgroup; whether rays are stepped (fixed-step) or exact (max-mip); what the
// picture has (kFrameHas...) and what the field is (ScarpField::flags), so that a shader is made of what it needs:
// drivers take seconds for all of it.
const uint kFrameHasWater = 1u;
const uint kFrameHasShadows = 2u;
const uint kFrameHasPatches = 4u;  ///< detail by noise, or natural ground
const uint kFrameHasDrape = 8u;
const uint kFrameHasContours = 16u;
const uint kFrameHasFog = 32u;
const uint kFrameHasSamples = 64u;  ///< of sun and sky
const uint kFrameHasPlinth = 128u;  ///< below the terrain
/// Walls at the rims of holes of the plinth: the march knows those of solid ground.
const uint kFrameHasRims = 256u;
const uint kFrameHasScattering = 512u;  ///< sky
const uint kFrameHasTexture = 1024u;    ///< detail by an image

const int kFrameRounds = 16;
const int kFrameTurns = 3000;

// Rays of a point of the picture, and what they have seen.
const int kFrameCamera = 0;
const int kFrameMirror = 1;
const int kFrameBottom = 2;
const int kFrameSeens = 3;
const int kFrameTasks = 6;  ///< and one each for its light

/// A wave of the water.
struct FrameWave {
  vec2 along;
  vec2 turns;  ///< per metre of x and y
  vec2 turns_low;
  float metres;  ///< its length
};
/// An octave of patches: lattice units per metre of x and y, along its grain and across.
struct FramePatch {
  vec2 along;
  vec2 along_low;
  vec2 across;
  vec2 across_low;
};
const int kFrameOctaves = 4;   ///< of a set, at most: kScarpMostOctaves of ground_paint.glsl.h
const int kFramePatches = 12;  ///< kScarpPatchSets * kFrameOctaves

struct FrameRampPiece {
  float low;
  float high;
  uint begin;  ///< of its colours
  uint count;
};

/// All but `aa` and what is said to be in pixels is in metres of the world or grid units. Heights in metres count from
/// near the lowest ground: of a height above the sea floats hold less, the higher the ground lies.
struct FrameSettings {
  // Of the camera, in grid units: the ray through a place in the picture is the sum of these, x pixels to the right and
  // y down. Along its axis it goes a metre per time.
  ScarpLine line;
  ScarpLine line_right;
  ScarpLine line_down;
  vec3 forward;
  float reach;        ///< kScarpNever: no end
  float pixel_width;  ///< at one metre, or of an orthographic camera
  int orthographic;
  int width;  ///< pixels
  int height;
  int aa;
  // The field.
  vec2 cell;  ///< metres
  vec2 cell_low;
  vec2 per_cell;
  float metres_per_sample;
  float per_metre;        ///< sample units
  float base_of_heights;  ///< sample units: where metres of heights count from, with what it lies above their zero
  float metres_at_base;
  float last_row;  ///< rows of samples - 1
  int plinth;      ///< 1: there is one below the terrain, down to
  float base_sample;
  float base_sample_low;
  // The steps of the look comanche; of rays to the sun those of the march.
  float step;
  int steps;
  int interpolate;
  int shells;
  int step_by_view;
  float sun_step;
  int sun_steps;
  int sun_interpolate;
  int iterations;  ///< 1: a picture of the steps
  int most_steps;
  int no_descent;  ///< 1: what lies below the horizon has its colour
  // Water.
  int water;
  float level;
  float level_sample;  ///< in sample units
  float level_sample_low;
  int has_sea;       ///< 1: some sample may be exactly at the level:
  float sea_sample;  ///< this
  int reflection;
  int refraction;
  float waves;
  vec3 deep;
  vec3 water_per_metre;
  FrameWave wave[kScarpWaves];
  // Air and light.
  int fog;
  float fog_per_metre;
  float fog_base;
  float fog_falloff;
  float sun_tint;
  float haze_per_metre;
  float clear_distance;
  ScarpSky sky;
  int shadows;
  vec3 to_sun;
  vec3 sun_line;  ///< in grid units
  vec3 sun_line_low;
  int sun_rays;     ///< of a point: 0 without shadows, 1 where the sun is a point
  int sky_rays;     ///< of a point
  float sun_depth;  ///< of its disc as a cap, 1 - cos(radius); 0: a point
  float ao_distance;
  int samples;  ///< of a point, for each purpose: 0 without soft light
  uint seed;    ///< of SamplePattern
  int index_bits;
  vec3 sky_side;
  vec3 sun;
  vec3 skylight;
  vec3 earth;
  float unlit_wall;
  int tone_curve;  ///< 1: bright colours are compressed
  int alpha;       ///< 1: pixels are means of the points that show something, and carry the share of these
  int unlit;       ///< 1: no light
  // Ground.
  int natural;
  float snow_share;
  float low;
  float per_relief;
  vec2 from_sun;
  float detail;
  float detail_size;
  float contours;
  FramePatch patches[kFramePatches];
  Address ramp_pieces;
  Address ramp_colours;
  int ramp_count;
  Address drape;
  int drape_width;  ///< 0: none
  int drape_height;
  vec2 drape_first;  ///< as in Drape
  vec2 drape_last;
  int drape_mirrored;
  FramePatch texture_place;  ///< fractions of the image per metre, to the east and north
  Address texture;
  ivec2 texture_size;  ///< texels; 0: none
  float texels_per_metre;
};

struct FramePush {
  Address settings;
  Address ground;
  Address pixels;
  Address states;
  Address sights;
  uint first;  ///< pixel
  uint count;
  uint resume;       ///< 1: go on from the states
  uint tell_sights;  ///< 1
};

const int kFrameNothing = 0;
const int kFrameGround = 1;
const int kFrameWall = 2;
const int kFrameWater = 3;

/// What the first ray of a pixel met.
struct FrameSight {
  int kind;  ///< kFrameGround and so on
  float t;   ///< metres
  ivec2 cell;
  uint steps;
};

/// A ray and what it has met.
struct FrameSeen {
  ScarpLine line;
  float metres;  ///< per time
  int asked;
  int kind;         ///< kFrameNothing, kFrameGround, kFrameWall
  ScarpTwoFloat t;  ///< time
  ScarpTwoFloat end;
  ivec2 cell;
  vec2 place;
  float sun_cosine;  ///< what is seen of the sun: the sum over its rays, then their mean
  float sky;         ///< what is seen of the sky: its rays that nothing is in the way of, then their share
  vec3 normal;       ///< of ground, for shading
  vec3 light;        ///< of ground, before the air between
  uint steps;
};

/// Where the camera's ray comes to the water.
struct FrameWater {
  int kind;         ///< 0: it does not; 1: from above; 2, 3: through a side of constant x, y
  ScarpTwoFloat t;  ///< time
  int sea;          ///< 1: a cell that is flat ground at the level
  ivec2 cell;
  vec2 place;
  vec3 normal;
  float reflectance;
  vec3 glitter;
};

/// The fourth byte of a finished pixel: 255 times the share of its points in the mean. 0 marks a pixel that is not
/// done, so 1 stands for 0.
SCARP_FN uint scarp_frame_opacity(float share) { return max(uint(floor(255.0f * share + 0.5f)), 1u); }

struct FrameState {
  int point;      ///< of the pixel
  int task;       ///< -1: the point has not been begun
  int under_way;  ///< 1: the ray of the task is
  int light;      ///< of a point's rays to sun and sky, which
  float weight;
  int walls;  ///< 1: the ray sees those at rims
  vec3 sum;
  int shown;  ///< points in the sum
  FrameSeen seen[kFrameSeens];
  FrameWater water;
  ScarpSent sent;
  ScarpHit hit;
  ScarpWalk walk;
  ScarpMarchState looks;
  ScarpSampling step;
};

SCARP_GLSL_END

#endif
