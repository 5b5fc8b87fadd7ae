// SPDX-License-Identifier: MIT
// The shader source of voxel marches, run on the CPU one ray at a time, with a record of what each ray does
// (simt_bundle.h). The walk through the hierarchy over the objects, which is not compiled as C++, is reimplemented
// here.
#pragma once

#include <memory>

#include "bench/simt_bundle.h"
#include "scarp/base/ray.h"
#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp::bench {

/// Voxel objects in their device-memory layout.
class SimtVoxels {
 public:
  /// All models have the same march, which must run on devices. Their voxels count as cubes.
  explicit SimtVoxels(const PlacedVoxels& voxels);
  ~SimtVoxels();

  /// Returns the hit that a device would compute. `trace` may be null.
  Hit trace(const Ray& ray, SimtTrace* trace) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp::bench
