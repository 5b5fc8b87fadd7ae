// SPDX-License-Identifier: MIT
// Voxels drawn by a Vulkan device as two triangles per face between a solid and an empty voxel: a peer of the marches,
// and a second judge of their pictures.
//
// Rasterisers round corners to a fraction of a pixel, so they show neighbouring faces near edges. A corner is off by at
// most
//
//   2^-(bits + 1)               the device's sub-pixel grid, along either axis
//   2^-22 width                 the same in clip coordinates
//   2^-21 |place| / (W pixel)   the corner itself as floats: the object less the eye, a product, two sums
//
// in pixels, W being its depth.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bench/pixel_match.h"
#include "scarp/march/voxel/voxel_pictures_vk.h"
#include "scarp/vk/device.h"

namespace scarp::bench {

class VoxelTriangles {
 public:
  /// Objects as for rasterise().
  VoxelTriangles(const Device& device, const VoxelGrid& grid, std::span<const VoxelPlace> places);
  VoxelTriangles(VoxelTriangles&&) noexcept;
  VoxelTriangles& operator=(VoxelTriangles&&) noexcept;
  ~VoxelTriangles();

  void draw(const PictureFrame& frame);
  /// Times of the last draw().
  const std::vector<PassTime>& passes() const;
  /// The picture, row by row: hits without t.
  std::vector<Hit> drawn() const;
  /// Bound of the displacement of a drawn edge, in pixels.
  double snap(const PictureFrame& frame) const;
  /// Triangles of one object, and the size of faces and objects on the device.
  std::size_t triangles() const;
  std::uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct TrianglesMatch {
  std::int64_t pixels = 0;
  std::int64_t near_edges = 0;  ///< pixels within the snap of an edge
  std::int64_t other = 0;       ///< pixels among these that do not show the face that the ray hits
  std::int64_t differ = 0;      ///< other pixels that differ
  std::string first;            ///< pixel that differs
};

/// `quads`: rasterise() with the snap as its margin.
TrianglesMatch compare_with_triangles(const RasterPicture& quads, std::span<const Hit> drawn, std::span<const Hit> hits,
                                      const PictureFrame& frame);

/// Converts the picture to the library's type.
VoxelPicture picture_of(const PictureFrame& frame);

}  // namespace scarp::bench
