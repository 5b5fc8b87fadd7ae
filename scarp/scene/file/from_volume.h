// SPDX-License-Identifier: MIT
// Voxels of binvox files and of volumes of numbers as one model, with voxels of 1 m and its corner at (0, 0, 0).
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
  std::optional<double> solid_from;  ///< smallest number that counts as solid; nullopt: all above 0 do
};

/// Smallest and largest number of a set of voxels; low > high if the set is empty.
struct SolidRange {
  double low, high;
};
/// Range of the numbers of the solid voxels.
SolidRange solid_range(const DenseVolume& volume, std::optional<double> solid_from);
/// Range of all numbers that are not NaN.
SolidRange number_range(const DenseVolume& volume);

/// Throws Error, before reading, if volumes of this size are too large for the march that `options` selects.
void require_marchable(const VolumeFormat& format, const VoxelFileOptions& options);

/// All voxels have the same `colour`.
PlacedVoxels placed_voxels_from(const Binvox& binvox, const VoxelColour& colour, const FromVolumeOptions& options = {});

/// Maps the lowest number in `range`, which is solid_range(), to the first colour and the highest to the last. A single
/// colour needs no range. NaN is empty. Throws Error unless there are 1 to 255 colours.
PlacedVoxels placed_voxels_from(const DenseVolume& volume, std::span<const VoxelColour> colours,
                                const SolidRange& range, const FromVolumeOptions& options = {});

}  // namespace scarp
