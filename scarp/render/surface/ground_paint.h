// SPDX-License-Identifier: MIT
// Colours of surfaces before any light, in two layers. The ground's own colour is a ramp by height, or `natural`. An
// overlay, noise and contour lines are painted over any colour, the ground's or a material's.
//
//   natural   rock on steep slopes; snow above a line that is lower on the shadowed side, where slopes hold it; else
//             grass, darker below and drier above; noise blurs the borders
//   detail    noise of several sizes, twice as long along the slope's horizontal as across, or a repeated image
//             (detail_texture.h); patterns smaller than a pixel are omitted
//   contours  lines of constant width in pixels: the distance to a line is the difference in height divided by the
//             slope of the surface itself; every fifth is heavier; lines fade where they would touch. Level surfaces
//             have none
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/base/vec.h"
#include "scarp/render/surface/detail_texture.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {

/// A picture over the extent or part of it, transparent elsewhere. Corners are fractions of the extent, east and south
/// from its north-west corner.
struct Drape {
  int width = 0;                   ///< pixels, >= 1
  int height = 0;                  ///< pixels, >= 1
  std::vector<std::uint8_t> rgba;  ///< 4 bytes per pixel, sRGB, from the north-west; opacity 0 shows the ground below
  dvec2 first{0.0}, last{1.0};     ///< corners of the first and the last pixel, last > first
  bool mirrored =
      false;  ///< whether the extent is mirrored as by source/mirrored.h; fractions then refer to its quarter
};

struct GroundPaintSettings {
  bool natural = false;     ///< rock, grass and snow instead of the ramp
  double snow_share = 0.7;  ///< fraction of the relief at which snow starts, for `natural`; finite
  double detail = 0;        ///< strength of the patches, 0..1
  double detail_size = 0;   ///< metres of the largest patches, or the width of the texture, >= 0;
                            ///< 0: sixteen cells
  std::shared_ptr<const DetailTexture> detail_texture{};  ///< instead of noise; null: noise
  double contours = 0;                                    ///< interval in metres, not exaggerated, >= 0; 0: none
  std::shared_ptr<const Drape> drape{};                   ///< null: none
};

/// Throws Error naming the first setting out of range.
void validate(const GroundPaintSettings& settings);

/// Number of contour lines per heavy one.
int lines_per_heavy_contour();

/// Reference measures of the paint, in world space.
struct PaintExtent {
  double low = 0, high = 1;      ///< heights in metres
  double exaggeration = 1;       ///< factor contained in heights
  double cell = 1;               ///< metres of a cell or voxel
  dvec2 origin{0.0}, size{1.0};  ///< of the overlay, in metres: south-west corner, and extent to the east and north
  bool repeats = false;          ///< whether the overlay repeats
};

class GroundPaint {
 public:
  /// `to_sun` is a unit vector: the shadowed side faces away from it. `ramp` maps heights of the extent.
  GroundPaint(const GroundPaintSettings& settings, const PaintExtent& extent, Ramp ramp, const dvec3& to_sun);

  /// The ground's own colour, and the layers over any colour, in linear light. `height` is the height of the surface at
  /// `position` in metres. `normal` is a unit vector: the smooth normal for the ground's own colour, that of the
  /// surface itself for contour lines. `footprint` is the width of a pixel there in metres.
  vec3 ground(const dvec3& position, double height, const dvec3& normal, double footprint) const;
  vec3 over(vec3 colour, const dvec3& position, double height, const dvec3& normal, double footprint) const;

  const GroundPaintSettings& settings() const { return settings_; }
  const Ramp& ramp() const { return ramp_; }
  /// Horizontal vector away from the sun; its length is the cosine of the sun's altitude.
  const dvec2& away_from_sun() const { return away_from_sun_; }
  /// Metres of the largest patches, or the width of the texture.
  double detail_size() const { return detail_size_; }
  /// Lattice units of a set's octave (ground_paint.glsl.h) per metre of x and y, along its grain and across.
  struct Patch {
    dvec2 along, across;
  };
  Patch patch(int set, int octave) const;
  /// Interval between lines in exaggerated metres.
  double contour_interval() const;
  double heavy_contour_interval() const;  ///< between heavy lines

 private:
  vec3 draped(const dvec3& position, vec3 below) const;
  double patches(const dvec3& position, int set, double footprint) const;
  double detail(const dvec3& position, double footprint) const;

  GroundPaintSettings settings_;
  PaintExtent extent_;
  Ramp ramp_;
  dvec2 away_from_sun_;
  double relief_, detail_size_;
};

}  // namespace scarp
