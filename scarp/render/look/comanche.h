// SPDX-License-Identifier: MIT
// The look `comanche`: endless terrain in a few large pixels, as in flight simulators of the nineties and the founding
// text on a ray caster for semi-voxel terrain. With the march `fixed-step` it reproduces the picture of that text,
// including its artefacts; with an exact march it shows the same picture without them.
//
//                     fixed-step                                     exact marches
//   steps             reach / steps apart, on planes parallel to     none
//                     the picture, or on spheres (`shells`)
//   coast             the first sample below the level (plain), or   the plane itself
//                     between the last two samples
//   crests            parts thinner than a step are missed         all
//   looking up        ends where nothing is higher                 the same
//
// `step_by_view` implements the text's proposal, long steps looking down and short ones at grazing angles: samples are
// equally spaced on the map, not along the ray, so steep rays take steps up to kLongestStep times as long.
#pragma once

#include <cstdint>

#include "scarp/field/height_field.h"
#include "scarp/render/surface/water.h"

namespace scarp {

class Camera;
struct Image;

struct ComancheSettings {
  int scale = 3;              ///< sides of the picture's large pixels in pixels of the image, 1..64
  int steps = 256;            ///< number of steps of `fixed-step` over the reach, 1..65536
  bool shells = false;        ///< samples on spheres around the eye, as with normalised rays; otherwise on planes
  bool step_by_view = false;  ///< longer steps looking down
  bool interpolate = true;    ///< whether a hit is interpolated between the last two samples
  bool iterations = false;    ///< shows the steps instead, from black (0) to white (the maximum)
  bool heights = false;       ///< shows the heights that the same rays hit, in grey levels of the look `height`
};

/// Throws Error naming the first setting out of range.
void validate(const ComancheSettings& settings);

/// Longest step at a grazing angle, with `step_by_view`.
constexpr double kLongestStep = 8;

/// A camera low over the southern part of the field, looking north: the usual view of endless ground.
Camera flight_camera(const HeightField& field, double grid_north_azimuth, double fov_deg, int width, int height);

/// Reach of a picture of an unbounded field: once across the field.
double default_reach(const HeightField& field);

/// Marches rays as the founding text does, on the calling thread. Refers to the field.
class StepMarch {
 public:
  /// `reach` in metres; `forward` is the camera's unit axis.
  StepMarch(const HeightField& field, const ComancheSettings& settings, double reach, const dvec3& forward);

  struct Answer {
    Hit hit;
    bool water = false;  ///< the ray reached the water first, at t
    double t = 0;
    std::uint32_t steps = 0;
  };
  /// Marches a camera ray, whose direction has length 1. `water` may be null.
  Answer march(const Ray& ray, const Water* water) const;
  /// Marches a ray that does not start at the camera, without planes.
  Hit march(const Ray& ray) const;
  int most_steps() const { return settings_.steps; }

 private:
  Answer march(const Ray& ray, const Water* water, double step) const;
  double by_view(double step, const dvec3& direction) const;

  const HeightField& field_;
  ComancheSettings settings_;
  double step_;
  dvec3 forward_;
};

/// Each pixel as `factor` x `factor` pixels.
Image scaled_up(const Image& image, int factor);

}  // namespace scarp
