// SPDX-License-Identifier: MIT
// A picture of voxels, ray by ray, compared with the same picture drawn as quads.
//
// The error of a ray, which is also the width of the margin around edges: a ray that is quantised where it enters an
// object of L voxels a side stays within e = 2^-21 + 2^-29 L voxel of the exact ray along each axis
// (scarp/march/voxel/voxel_ray.h), sqrt(3) e in space. In the picture, at the depth W, that is at most
//
//   sqrt(3) e side sqrt(1 + x^2 + y^2) / (W pixel)     x, y: tangents of the angles at the picture's corner
//
// for L = 32: 1e-3 pixel at a depth of 1.6 voxels in the post's picture, 2e-5 from the position of its camera. A
// difference beyond the margin of 1e-3 pixel is not due to rounding. Along the axis of the face that was hit, t is off
// by e.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/quad_raster.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {

constexpr double kPixelMargin = 1e-3;

struct PixelMatch {
  std::int64_t pixels = 0, hits = 0;
  std::int64_t near_edges = 0;  ///< pixels closer to an edge than the margin
  std::int64_t differ =
      0;  ///< other pixels that show another object, voxel or face than the quads, or with t off by more than e
  std::int64_t near_edge_wrong = 0;  ///< near an edge, but the hit is on none of the faces that meet there
  double ray_pixels = 0;             ///< derived bound on the error of a ray at the smallest depth in the picture
  double t_error = 0;                ///< the largest error of t, in multiples of e
  std::string first;                 ///< first pixel that differs
};

/// The rays of all pixels, row by row, and their hits.
std::vector<Ray> rays_of(const PictureFrame& frame);
std::vector<Hit> hits_of(const Scene& scene, const PictureFrame& frame);

/// `hits`: of rays_of(frame) in the same objects. Throws Error if rays may be off by more than the margin.
PixelMatch compare_with_quads(const RasterPicture& quads, std::span<const Hit> hits, const VoxelGrid& grid, double side,
                              const PictureFrame& frame);

struct NamedFrame {
  std::string name;
  PictureFrame frame;
};

/// The frame of the post; from eight octants; along the axes, with and without perspective; from inside an object. All
/// except the first show 32 x 4 x 32 objects.
std::vector<NamedFrame> pixel_match_frames(int width, int height);

}  // namespace scarp::bench
