// SPDX-License-Identifier: MIT
// A picture of a height field rendered on a device: the interface between the compute shaders of its stages and the C++
// that runs them (terrain_frame_vk.h).
//
//   rays ──▶ march ──▶ take ──▶ water ──▶ march ──▶ take ──▶ light ──▶ march ──▶ take ──▶ ... ──▶ paint ──▶ resolve
//   of the             what is  only if there is:            a ray to sun or sky for each       ground     pixels
//   camera             hit      mirrored, to the bottom      visible ground point
//
//   FramePush ──settings──▶ FrameSettings ──ramp──▶ pieces and colours of a ramp;  ──drape──▶ a picture on the ground
//       │  ├──ground────▶ GroundBuffers
//       │  ├──seens─────▶ FrameSeen, the camera's of all pixels; then mirrored ones, then those to the water's bottom
//       │  ├──waters────▶ FrameWater of each pixel, if there is water
//       │  ├──rays──────▶ RayBlock for the march, ray after ray, for all purposes;  ──hits──▶ its answers
//       │  ├──owners────▶ index of the FrameSeen of each ray
//       │  ├──grounds───▶ indices of those that see ground, to be lit and painted
//       │  ├──counters──▶ FrameCounters: how many rays and grounds there are
//       │  ├──sums──────▶ FrameSum of each pixel, over its points
//       │  ├──pixels────▶ a word per pixel: red | green << 8 | blue << 16 | opacity << 24
//       │  └──sights────▶ FrameSight per pixel, for callers that need the hits of rays
//       └─ which pixels, and which of their points
//
// All pixels of a part of the picture go from stage to stage together, point by point. Rays that have nothing to march
// are not in the list, so a march has as many invocations as rays.
#ifndef SCARP_RENDER_TERRAIN_FRAME_GLSL_H
#define SCARP_RENDER_TERRAIN_FRAME_GLSL_H

#include "scarp/march/height/two_float_ray.glsl.h"
#include "scarp/render/light/air.glsl.h"
#include "scarp/render/surface/water.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Specialisation constants of all stages: threads of a workgroup; whether rays are stepped (fixed-step) or exact
// (max-mip); the features of the picture (kFrameHas...) and of the field (ScarpField::flags), so that a shader contains
// only what it needs: drivers take seconds to compile everything. For `take` also whether rays are those of light.
const uint kFrameHasWater = 1u;
const uint kFrameHasShadows = 2u;
const uint kFrameHasPatches = 4u;  ///< detail by noise, or natural ground
const uint kFrameHasDrape = 8u;
const uint kFrameHasContours = 16u;
const uint kFrameHasFog = 32u;
const uint kFrameHasSamples = 64u;  ///< rays to sun and sky
const uint kFrameHasPlinth = 128u;  ///< below the terrain
/// Walls of the plinth at the rims of holes; the march handles those of solid ground.
const uint kFrameHasRims = 256u;
const uint kFrameHasScattering = 512u;  ///< sky
const uint kFrameHasTexture = 1024u;    ///< detail by an image

// Rays of a point of the picture, and their hits.
const int kFrameCamera = 0;
const int kFrameMirror = 1;
const int kFrameBottom = 2;
const int kFrameSeens = 3;

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
const int kFrameOctaves = 4;   ///< maximum per set: kScarpMostOctaves of ground_paint.glsl.h
const int kFramePatches = 12;  ///< kScarpPatchSets * kFrameOctaves

struct FrameRampPiece {
  float low;
  float high;
  uint begin;  ///< index of its first colour
  uint count;
};

/// Everything except `aa` and members documented in pixels is in metres of the world or grid units. Heights in metres
/// are relative to the lowest ground, because floats lose precision at large heights above the sea.
struct FrameSettings {
  // The camera in grid units: the ray through a position in the picture is the sum of these, x pixels to the right and
  // y down. Along the view axis it travels a metre per time.
  ScarpLine line;
  ScarpLine line_right;
  ScarpLine line_down;
  vec3 forward;
  float reach;        ///< kScarpNever: no end
  float pixel_width;  ///< at a depth of one metre, or for an orthographic camera
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
  float base_of_heights;  ///< sample units: origin of heights in metres, with its height above their zero
  float metres_at_base;
  float last_row;  ///< rows of samples - 1
  int plinth;      ///< 1: there is a plinth below the terrain, down to
  float base_sample;
  float base_sample_low;
  // The steps of the look comanche; rays to the sun use those of the march.
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
  int no_descent;  ///< 1: everything below the horizon has its colour
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
  int sun_rays;     ///< per point: 0 without shadows, 1 if the sun is a point
  int sky_rays;     ///< per point
  float sun_depth;  ///< of the sun's disc as a cap, 1 - cos(radius); 0: a point
  float ao_distance;
  int samples;  ///< per point and purpose: 0 without soft light
  uint seed;    ///< of SamplePattern
  int index_bits;
  vec3 sky_side;
  vec3 sun;
  vec3 skylight;
  vec3 earth;
  float unlit_wall;
  int tone_curve;  ///< 1: bright colours are compressed
  int alpha;       ///< 1: pixels are means of the points that show something, and store their fraction
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
  Address seens;
  Address waters;
  Address rays;
  Address hits;
  Address owners;
  Address grounds;
  Address counters;
  Address sums;
  Address pixels;
  Address sights;
  uint first;        ///< pixel
  uint count;        ///< pixels
  uint threads;      ///< pixels, rays or grounds that the stage is for
  int point;         ///< index of the point in its pixel
  int light;         ///< index of the current ray among those to sun and sky
  uint tell_sights;  ///< 1
};

struct FrameCounters {
  uint rays;
  uint grounds;
};

/// Over the points of a pixel that show something.
struct FrameSum {
  vec3 colour;
  int shown;
};

const int kFrameNothing = 0;
const int kFrameGround = 1;
const int kFrameWall = 2;
const int kFrameWater = 3;

/// Hit of the first ray of a pixel.
struct FrameSight {
  int kind;  ///< kFrameGround and so on
  float t;   ///< metres
  ivec2 cell;
  uint steps;
};

/// A ray and its hit.
struct FrameSeen {
  ScarpLine line;
  float metres;       ///< per time
  int asked;          ///< 0: no ray
  int kind;           ///< kFrameNothing, kFrameGround, kFrameWall
  ScarpTwoFloat t;    ///< time; for a ray that marches, its start
  float per_time;     ///< as in ScarpSent
  ScarpTwoFloat end;  ///< time; kept for rays from the water
  ivec2 cell;         ///< of ground and walls
  vec2 place;
  float sun_cosine;  ///< visible sun: the sum over its rays
  float sky;         ///< visible sky: its unblocked rays
  float weight;      ///< weight of the light ray that is being traced
  vec3 normal;       ///< shading normal of ground
  vec3 light;        ///< light of ground, without the air in front
  uint steps;
};

/// Where the camera ray reaches the water.
struct FrameWater {
  int kind;         ///< 0: nowhere; 1: from above; 2, 3: through a side of constant x, y
  ScarpTwoFloat t;  ///< time
  int sea;          ///< 1: a cell that is flat ground at the level
  ivec2 cell;
  vec2 place;
  vec3 normal;
  float reflectance;
  vec3 glitter;
};

/// The fourth byte of a pixel: 255 times the fraction of its points in the mean.
SCARP_FN uint scarp_frame_opacity(float share) { return uint(floor(255.0f * share + 0.5f)); }

SCARP_GLSL_END

#endif
