// SPDX-License-Identifier: MIT
// The subject of `scarp-bench voxels`: an engine that traces batches of rays against voxels.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scarp/base/ray.h"

namespace scarp::bench {

struct VoxelEngine {
  std::string name;  ///< a march, or a peer
  std::string mode;  ///< x1: one ray at a time; x64, x8: this many neighbours at once
  std::string box;   ///< part of objects that rays traverse: grid or bounds
  double mib = 0;    ///< with one model for all objects
  /// Sets hits[i] for rays[i]: status, t, voxel and part. Uses one thread.
  std::function<void(std::span<const Ray> rays, std::span<Hit> hits)> trace;
};

}  // namespace scarp::bench
