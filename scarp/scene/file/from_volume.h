// SPDX-License-Identifier: MIT
// Voxels of binvox files and of volumes of numbers as one model, a voxel 1 m, its corner at (0, 0, 0).
#pragma once

#include <optional>
#include <span>

#include "scarp/scene/placed_voxels.h"
#include "scarp/source/binvox.h"
#include "scarp/source/dense_volume.h"

namespace scarp {

/// Which axis of the file points up; the others follow so that nothing is mirrored.
enum class UpAxis : std::uint8_t { y, z };

struct FromVolumeOptions {
  VoxelFileOptions voxels{};
  UpAxis up = UpAxis::z;
  std::optional<double> solid_from;  ///< the least number of a solid voxel; nothing: all above 0 are solid
};

/// Smallest and largest number of the solid voxels; low > high if there are none.
struct SolidRange {
  double low, high;
};
SolidRange solid_range(const DenseVolume& volume, std::optional<double> solid_from);

/// `colour`: of all voxels.
PlacedVoxels placed_voxels_from(const Binvox& binvox, const VoxelColour& colour, const FromVolumeOptions& options = {});

/// The lowest number of solid_range() has the first of the colours, the highest the last; at most 255 colours, at
/// least one. NaN is empty. Throws Error when there are more or none.
PlacedVoxels placed_voxels_from(const DenseVolume& volume, std::span<const VoxelColour> colours,
                                const FromVolumeOptions& options = {});

}  // namespace scarp
