// SPDX-License-Identifier: MIT
// Voxels of binvox files and of volumes of numbers as one model, a voxel 1 m, its corner at (0, 0, 0).
#pragma once

#include <optional>
#include <span>

#include "scarp/scene/voxel/placed_voxels.h"
#include "scarp/source/voxel/binvox.h"
#include "scarp/source/voxel/dense_volume.h"

namespace scarp {

/// The axis of the file that points up; the others follow without mirroring.
enum class UpAxis : std::uint8_t { y, z };

struct FromVolumeOptions {
  VoxelFileOptions voxels{};
  UpAxis up = UpAxis::z;
  std::optional<double> solid_from;  ///< minimum number of a solid voxel; nullopt: all above 0 are solid
};

/// Smallest and largest number of some voxels; low > high if there are none.
struct SolidRange {
  double low, high;
};
/// Range of the solid voxels.
SolidRange solid_range(const DenseVolume& volume, std::optional<double> solid_from);
/// Range of all numbers that are not NaN.
SolidRange number_range(const DenseVolume& volume);

/// Throws Error, before reading, if volumes of this size are too large for the march that `options` selects.
void require_marchable(const VolumeFormat& format, const VoxelFileOptions& options);

/// `colour`: of all voxels.
PlacedVoxels placed_voxels_from(const Binvox& binvox, const VoxelColour& colour, const FromVolumeOptions& options = {});

/// The lowest number of `range`, solid_range(), has the first of the colours, the highest the last; at most 255
/// colours, at least one. A single colour needs no range. NaN is empty. Throws Error if there are more or none.
PlacedVoxels placed_voxels_from(const DenseVolume& volume, std::span<const VoxelColour> colours,
                                const SolidRange& range, const FromVolumeOptions& options = {});

}  // namespace scarp
