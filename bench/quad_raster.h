// SPDX-License-Identifier: MIT
// A rasteriser of voxel faces: the judge of `scarp-bench pixel-match`. It uses no rays: each face between a solid and
// an empty voxel is a quad, projected to the picture; a pixel shows the nearest quad that covers its middle.
//
//   corner  (X, Y, W) = (right, up, forward) . (corner - eye), X and Y in pixels; W = 1 without perspective
//   edge    e(x, y) = (x, y, 1) . (corner_i x corner_i+1): its sign gives the side, e / |(e_x, e_y)| pixels away
//   inside  all four edges have the sign of the quad; also right for quads that reach behind the eye
//   depth   that of the plane at (x, y): t = (k - eye_a) / direction_a
//
// Sources: M. Olano, T. Greer, "Triangle scan conversion using 2D homogeneous coordinates", Graphics Hardware 1997;
// J. Pineda, "A parallel algorithm for polygon rasterization", SIGGRAPH 1988.
//
// Exactness, all in double, for eyes within 2^9 m and pictures up to 2^11 pixels: a corner 2^-2 m or more away is off
// by less than 2^-29 pixel (three products of 2^19 pixels), an edge of length L by that and 2^-29 / L (a product of two
// coordinates, 2^22 pixels, divided by L). That is below 2^-20 pixel for L above 2^-9; faces with a shorter edge are
// narrower than two margins of 1e-3 and cover nothing. A pixel that is farther than the margin from all edges is
// therefore decided. Two faces that cover the pixel can meet only at edges. At the pixel they are therefore a margin's
// width apart, 2^-20 voxel or more, and depths are known to 2^-40.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp::bench {

/// The rays of a picture; right, up and forward are orthogonal unit vectors.
struct PictureFrame {
  dvec3 eye{0.0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  bool perspective = true;
  double pixel = 1e-3;  ///< its side, at the distance 1; without perspective anywhere
  int width = 1, height = 1;

  /// The centre of a pixel, from the picture's centre: pixels to the right and upwards.
  dvec2 place(int col, int row) const { return {col + 0.5 - 0.5 * width, 0.5 * height - row - 0.5}; }
  /// Its direction has the component 1 along `forward`.
  Ray ray(int col, int row) const;
};

/// Looks from `eye` at `target`; `top` is the up direction. The picture is `fov` radians high, or, without perspective,
/// `high` long.
PictureFrame frame_looking(const dvec3& eye, const dvec3& target, const dvec3& top, double fov, int width, int height);
PictureFrame frame_along(const dvec3& eye, const dvec3& forward, const dvec3& top, double high, int width, int height);

/// A face of a voxel of an object.
struct FaceOf {
  std::uint32_t object = 0;
  ivec3 voxel{0};
  VoxelFace face = VoxelFace::inside;
  friend bool operator==(const FaceOf&, const FaceOf&) = default;
};

/// A face between a solid and an empty voxel of a grid.
struct VoxelFaceAt {
  ivec3 voxel;
  VoxelFace face;
};
/// All faces between a solid and an empty voxel.
std::vector<VoxelFaceAt> faces_of(const VoxelGrid& grid);

struct SeenFace {
  double t = std::numeric_limits<double>::infinity();  ///< of PictureFrame::ray(); infinity: nothing is visible
  FaceOf face;
};

/// A face whose edge is closer to a pixel's centre than the margin, whether it covers the pixel or not.
struct NearEdge {
  std::uint32_t pixel = 0;  ///< row * width + column
  FaceOf face;
  double least_t = 0;  ///< smallest t of its corners
};

struct RasterPicture {
  std::vector<SeenFace> seen;        ///< the nearest per pixel that covers it by more than the margin
  std::vector<NearEdge> near_edges;  ///< by pixel; only faces that are partly nearer than `seen`
  double least_depth = std::numeric_limits<double>::infinity();  ///< along `forward`, of visible faces
};

/// Objects are instances of one grid, not rotated: place.world_from_grid is a multiple of the identity. margin: pixels.
RasterPicture rasterise(const VoxelGrid& grid, std::span<const VoxelPlace> places, const PictureFrame& frame,
                        double margin);

}  // namespace scarp::bench
