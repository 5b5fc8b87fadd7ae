// SPDX-License-Identifier: MIT
// The colour of ground before any light: a ramp by height, rock and grass and snow by slope and aspect, a picture
// draped over it; then patches of noise and contour lines on top.
//
//   natural   rock where it is steep, snow above a line that is lower on the shadowed side and where slopes do not hold
//             it, else grass, darker below and drier above; the borders are blurred by noise
//   detail    noise of several sizes, each twice as long along the slope's horizontal as across: patterns smaller than
//   a
//             pixel are left out
//   contours  lines of a width in pixels: the distance to a line is the difference in height by the slope; every fifth
//   is
//             heavier; where lines would touch one another they fade
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/field/height_field.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {

/// A picture over the whole of a field: its first pixel is the north-west corner.
struct Drape {
  int width = 0;                   ///< pixels, >= 1
  int height = 0;                  ///< pixels, >= 1
  std::vector<std::uint8_t> rgba;  ///< 4 bytes a pixel, sRGB; opacity 0: what is below
};

struct GroundPaintSettings {
  bool natural = false;                  ///< rock, grass and snow instead of the ramp
  double snow_share = 0.7;               ///< of the field's relief at which snow begins, `natural`; finite
  double detail = 0;                     ///< strength of the patches, 0..1
  double detail_size = 0;                ///< metres of the largest, >= 0; 0: sixteen cells
  double contours = 0;                   ///< metres from line to line, not exaggerated, >= 0; 0: none
  std::shared_ptr<const Drape> drape{};  ///< null: none
};

/// Throws Error naming the first setting out of its range.
void validate(const GroundPaintSettings& settings);

class GroundPaint {
 public:
  /// Refers to the field. `to_sun` is a unit vector: the shadowed side is away from it.
  GroundPaint(const GroundPaintSettings& settings, const HeightField& field, Ramp ramp, const dvec3& to_sun);

  /// In linear light; `height` of the surface at `position` in metres, `normal` unit, `footprint` the metres that a
  /// pixel is wide there.
  vec3 operator()(const dvec3& position, double height, const dvec3& normal, double footprint) const;

  const GroundPaintSettings& settings() const { return settings_; }
  const Ramp& ramp() const { return ramp_; }
  /// Horizontally, with the sun's cosine.
  const dvec2& away_from_sun() const { return away_from_sun_; }
  /// Metres of the largest patches.
  double detail_size() const { return detail_size_; }
  /// Lattice units of a set's octave (ground_paint.glsl.h) per metre of x and y, along its grain and across.
  struct Patch {
    dvec2 along, across;
  };
  Patch patch(int set, int octave) const;
  /// Exaggerated metres from line to line.
  double contour_interval() const;
  double heavy_contour_interval() const;  ///< from one of those to the next

 private:
  vec3 draped(const dvec3& position, vec3 below) const;

  GroundPaintSettings settings_;
  const HeightField& field_;
  Ramp ramp_;
  dvec2 away_from_sun_;
  double low_, relief_, detail_size_;
};

}  // namespace scarp
