// SPDX-License-Identifier: MIT
// All rays of a camera or a scanner over a terrain, in one call on all threads.
//
//   scarp::PinholeCamera camera{.eye = eye, .forward = target - eye, .columns = 1920, .rows = 1080};
//   scarp::FanAnswers answers(camera.columns, camera.rows);
//   scarp::cast_from(terrain, camera, answers);       // answers.t[row * columns + column]
//
// Faster than cast() for each ray, because rays of one eye share their way (march/height/max_mip_fan.h; results:
// `heights-fans` in bench/README.md). The gain is smaller over scattered holes, over ground that wraps, from rolled or
// steep cameras, and with fewer than 5 columns. A ray hits here if it hits there. t, u and v are floats, with the
// tolerance of fans in doc/dev/numerics.md. Cameras and scanners generate directions on demand, without an array of
// rays. Rays from eyes below the ground, where there is nothing to share, are traced in batches; answers are the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/march/height/max_mip_fan.h"
#include "scarp/scene/terrain.h"

namespace scarp {

/// Answers in rows: that of a column and row is at row * columns + column.
struct FanAnswers {
  FanAnswers() = default;
  /// With `normals`, they are computed as well.
  FanAnswers(int columns, int rows, bool normals = false);

  int columns = 0, rows = 0;
  std::vector<float> t{};  ///< in units of the direction's length, at most FLT_MAX; infinity if the ray hits nothing
  std::vector<std::int32_t> col{}, row{};  ///< cell of the hit; -1 if there is none
  std::vector<float> u{}, v{};             ///< position in the cell, 0..1
  std::vector<HitStatus> status{};
  std::vector<float> nx{}, ny{}, nz{};  ///< unit normal at the hit in world space, 0 if there is none; or empty

  FanHits hits();
};

/// A perspective camera. The direction of a pixel has length 1 along `forward`, so t is the depth in metres.
struct PinholeCamera {
  dvec3 eye{0.0};
  dvec3 forward{0.0, 1.0, 0.0};  ///< of any length
  dvec3 up{0.0, 0.0, 1.0};       ///< not along `forward`; the camera is turned about `forward` until it points upwards
  int columns = 0, rows = 0;     ///< pixels
  double tan_half_width = 1;     ///< tangent of half the horizontal angle of view; pixels are square
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
};

/// A scanner that turns about the vertical. Directions have length 1, so t is the range in metres.
struct Scanner {
  dvec3 eye{0.0};
  std::vector<double> elevations{};  ///< of the rows, in radians above the horizon; faster if they rise or fall
  int columns = 0;                   ///< azimuths
  double first_azimuth = 0;          ///< radians from north, clockwise
  double azimuth_step = 0;           ///< radians
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
};

/// Answers all rays, on all threads. Throws Error if `answers` is of another size, for an eye, a camera or a scanner
/// that is not finite, a `forward` of zero or along `up`, a `tan_half_width` of 0 or less or above 10^6, an empty
/// range, a range without an end over terrain that wraps, and if the field or its memory has changed without the
/// terrain's knowledge.
void cast_from(const Terrain& terrain, const PinholeCamera& camera, FanAnswers& answers);
void cast_from(const Terrain& terrain, const Scanner& scanner, FanAnswers& answers);
/// As above, for directions of the caller: hits are laid out as the rays. Rays without a direction (zero, NaN or
/// infinite) miss.
void cast_from(const Terrain& terrain, const Fan& fan, const FanHits& hits);
/// As above, for the terrain of a scene (Scene::fan_target()).
void cast_from(const HeightTarget& terrain, const Fan& fan, const FanHits& hits);

}  // namespace scarp
