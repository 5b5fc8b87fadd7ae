// SPDX-License-Identifier: MIT
// Colours of the ground, for the stage that paints it and includes this. GLSL.

#include "scarp/render/frame/terrain_frame_place.glsl.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RampPieces { FrameRampPiece pieces[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RampColours { vec3 colours[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Drape { uint texels[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Texture { float texels[]; };

float scarp_paint_noise(ScarpPaintPlace place, int set, int octave, float size) {
  FramePatch of = settings().is.patches[set * kFrameOctaves + octave];
  return scarp_noise(kScarpPerlinNoise, uint(octave + 1), weighed(place, of.along, of.along_low),
                     weighed(place, of.across, of.across_low))
      .n;
}

struct ScarpTexels {
  Address at;
};
float scarp_texel(ScarpTexels texels, int index) { return Texture(texels.at).texels[index]; }

#include "scarp/render/surface/detail_texture.glsl.h"
#include "scarp/render/surface/ground_paint.glsl.h"

vec3 ramp_colour(float height) {
  Settings s = settings();
  int first = 0;
  int last = s.is.ramp_count - 1;
  // The first piece that ends at or above the value.
  while (first < last) {
    int middle = (first + last) / 2;
    if (RampPieces(s.is.ramp_pieces).pieces[middle].high < height)
      first = middle + 1;
    else
      last = middle;
  }
  FrameRampPiece piece = RampPieces(s.is.ramp_pieces).pieces[first];
  ScarpTablePlace at = scarp_table_place(height, piece.low, piece.high, int(piece.count));
  RampColours table = RampColours(s.is.ramp_colours);
  uint entry = piece.begin + uint(at.entry);
  return table.colours[entry] * (1.0 - at.place) + table.colours[entry + 1u] * at.place;
}

vec3 draped(ScarpField field, ivec2 cell, vec2 place, vec3 below) {
  Settings s = settings();
  vec2 at = vec2((float(cell.x) + place.x) / float(field.cells.x),
                 (float(cell.y) + place.y + (float(field.cells.y) - s.is.last_row)) / float(field.cells.y));
  if ((field.flags & kScarpWraps) != 0u) at = fract(at);
  at = scarp_drape_place(at, s.is.drape_first, s.is.drape_last, s.is.drape_mirrored != 0);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return below;
  ivec2 size = ivec2(s.is.drape_width, s.is.drape_height);
  vec2 texel = clamp(at * vec2(size) - 0.5, vec2(0.0), vec2(size - 1));
  ivec2 corner = ivec2(texel);
  vec2 f = texel - vec2(corner);
  vec3 sum = vec3(0.0);
  float opacity = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 c = min(corner + ivec2(i % 2, i / 2), size - 1);
    uint word = Drape(s.is.drape).texels[c.y * size.x + c.x];
    vec4 rgba = vec4(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u), float(word >> 24));
    float weight = (i % 2 != 0 ? f.x : 1.0 - f.x) * (i / 2 != 0 ? f.y : 1.0 - f.y) * rgba.w / 255.0;
    sum += weight * scarp_linear_from_srgb(rgba.xyz / 255.0);
    opacity += weight;
  }
  return sum + (1.0 - opacity) * below;
}

float fraction(ScarpTwoFloat x) {
  float low = x.high - floor(x.high) + x.low;
  return low - floor(low);
}

float texture_detail(ScarpPaintPlace place, float footprint) {
  Settings s = settings();
  FramePatch of = s.is.texture_place;
  vec2 at =
      vec2(fraction(weighed(place, of.along, of.along_low)), 1.0 - fraction(weighed(place, of.across, of.across_low)));
  return scarp_texture_detail(ScarpTexels(s.is.texture), s.is.texture_size, at, footprint * s.is.texels_per_metre);
}

vec3 ground_colour(ScarpField field, FrameSeen seen, vec3 direction) {
  Settings s = settings();
  float metres = seen.t.high * seen.metres;
  vec3 normal = normal_of(scarp_slope(field, seen.cell, seen.place));
  // A pixel's footprint is longer than wide on ground seen from the side. Uses the mean of length and width.
  float footprint =
      s.is.pixel_width * (s.is.orthographic != 0 ? 1.0 : metres) / sqrt(max(0.05, -dot(direction, normal)));
  ScarpCell cell = scarp_cell(field, seen.cell.x, seen.cell.y, s.is.base_of_heights);
  float height = scarp_bilinear(cell, seen.place.x, seen.place.y) * s.is.metres_per_sample + s.is.metres_at_base;
  ScarpPaintPlace place = paint_place(seen.line, seen.t);
  // A single call of noise keeps the shader small.
  vec3 patches = vec3(0.0);
  for (int set = 0; set < (has_patches ? kScarpPatchSets : 0); ++set) {
    if (set == kScarpDetail ? s.is.detail == 0.0 || has_texture : s.is.natural == 0) continue;
    float patch_sum = scarp_patches(place, set, s.is.detail_size, footprint);
    if (set == kScarpDetail) patches.x = patch_sum;
    if (set == kScarpBlur) patches.y = patch_sum;
    if (set == kScarpRough) patches.z = patch_sum;
  }
  vec3 colour;
  if (has_patches && s.is.natural != 0)
    colour = scarp_natural((height - s.is.low) * s.is.per_relief, seen.normal, s.is.from_sun, s.is.snow_share,
                           patches.y, patches.z);
  else
    colour = ramp_colour(height);
  if (has_drape) colour = draped(field, seen.cell, seen.place, colour);
  if (has_texture) patches.x = texture_detail(place, footprint);
  if (has_texture || (has_patches && s.is.detail > 0.0)) colour *= max(0.0, 1.0 + s.is.detail * patches.x);
  if (has_contours) colour = scarp_with_contours(colour, height, normal, footprint, s.is.contours);
  return colour;
}
