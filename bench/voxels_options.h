// SPDX-License-Identifier: MIT
// Options of `scarp-bench voxels`, with and without --device.
#pragma once

#include <string>
#include <vector>

#include "bench/report.h"

namespace scarp::bench {

/// `voxels`: the tables of the founding post for the marches of voxel grids.
struct VoxelsOptions {
  std::vector<std::string> sets{"standard", "degenerate", "empty", "far-wall"};
  std::vector<int> thousands{1, 2, 4, 8, 16};  ///< thousands of objects, 1..16
  int stride = 4;                              ///< one tile of 8 x 8 pixels in stride x stride of 1920 x 1080
  int width = 128;                             ///< pixels per side of the pictures of one grid, from eight sides
  int block = 8;                               ///< objects per side of the larger of these grids
  int repeats = 3;
  double pass_limit_s = 10;  ///< a slower technique traces part of the rays
  std::string device;        ///< instead: both drawing methods of a Vulkan device
  int height = 1080;         ///< height of the device's pictures, 16 : 9
};
void run_device_voxels(const VoxelsOptions& options, const ReportOptions& report);  // with SCARP_VULKAN

}  // namespace scarp::bench
