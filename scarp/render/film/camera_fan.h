// SPDX-License-Identifier: MIT
// Camera rays by a fan: before some tiles of a picture are worked on, the columns of their points are followed over the
// ground together (march/height/max_mip_fan.h). Each tile then computes the hits of its points in double, in the cells
// that the fan has found: pictures are those of single rays, to the byte.
//
//   a column of tiles ──fan──▶ sights, 8 bytes a point ──tile by tile──▶ hits
#pragma once

#include <optional>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// The sights of all points of an area of a picture.
class CameraSights {
 public:
  /// Sets `to` to the sights of a tile within the area, in the order of points_of().
  void of(const PixelTile& tile, std::vector<FanSight>& to) const;

 private:
  friend class CameraFan;
  int x0_ = 0, y0_ = 0, aa_ = 1, rows_ = 0;  // rows of points
  KeptVector<FanSight> sights_;              // in strips of 16 columns
};

class CameraFan {
 public:
  /// For a picture with aa x aa points per pixel and areas of this many rows of pixels. Refers to the scene.
  CameraFan(const Scene& scene, const Camera& camera, int rows, int aa);

  /// Whether a fan is possible and likely to be faster: perspective, one height field on the CPU with the march
  /// `max-mip`, and an eye above the ground.
  bool pays() const { return target_.has_value(); }
  /// Finds the sights of an area, on the calling thread.
  void look(const PixelTile& area, CameraSights& to) const;

 private:
  std::optional<HeightTarget> target_;
  Camera::PixelRays rays_;
  double reach_;
  int aa_;
};

}  // namespace scarp
