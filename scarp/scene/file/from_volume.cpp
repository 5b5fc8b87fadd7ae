// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_volume.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/field/rotate_voxels.h"

namespace scarp {
namespace {

constexpr std::size_t kMostColours = 255;

bool is_solid(double value, std::optional<double> from) { return from ? value >= *from : value > 0; }

// `entry(v)` of a voxel of the file.
template <class Entry>
PlacedVoxels model_of(const ivec3& size, const FromVolumeOptions& options, std::vector<VoxelColour> palette,
                      const Entry& entry) {
  // A quarter turn about x: the file's y becomes z.
  const LatticeRotation turn = options.up == UpAxis::y ? LatticeRotation{{0, 2, 1}, {1, -1, 1}} : LatticeRotation{};
  const ivec3 turned_size = abs(turn(size));
  VoxelGrid grid(turned_size, 8);
  const LatticeRotation back = turn.inverse();
  grid.edit(grid.box(),
            [&](const ivec3& v, const VoxelGrid::Voxel&) { return entry(rotated_voxel(v, turned_size, back)); });
  if (options.voxels.surface_colours) grid.drop_hidden_entries();
  const VoxelMarchEntry& march = file_voxel_march(options.voxels.march, {&turned_size, 1});
  const auto model = std::make_shared<const VoxelModel>(std::move(grid), march, std::move(palette));
  return {{model}, {VoxelPlace{}}, options.voxels.rounding};
}

}  // namespace

SolidRange solid_range(const DenseVolume& volume, std::optional<double> solid_from) {
  SolidRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for_each_voxel({ivec3(0), volume.size()}, [&](const ivec3& v) {
    const double value = volume[v];
    if (is_solid(value, solid_from)) range = {std::min(range.low, value), std::max(range.high, value)};
  });
  return range;
}

PlacedVoxels placed_voxels_from(const Binvox& binvox, const VoxelColour& colour, const FromVolumeOptions& options) {
  return model_of(binvox.size, options, {colour, colour},
                  [&](const ivec3& v) { return binvox.solid(v) ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel(); });
}

PlacedVoxels placed_voxels_from(const DenseVolume& volume, std::span<const VoxelColour> colours,
                                const FromVolumeOptions& options) {
  if (colours.empty() || colours.size() > kMostColours) throw Error("volume: 1 to 255 colours are needed");
  const auto [low, high] = solid_range(volume, options.solid_from);
  // Infinite numbers have the last colour.
  const double range = std::min(high, std::numeric_limits<double>::max()) - low;
  std::vector<VoxelColour> palette{VoxelColour{}};
  palette.insert(palette.end(), colours.begin(), colours.end());
  const auto last = static_cast<double>(colours.size() - 1);
  return model_of(volume.size(), options, std::move(palette), [&, least = low](const ivec3& v) {
    const double value = volume[v];
    if (!is_solid(value, options.solid_from)) return VoxelGrid::Voxel();
    const double share = range > 0 ? std::min(1.0, (value - least) / range) : 1;
    return VoxelGrid::Voxel(1 + static_cast<std::uint32_t>(share * last + 0.5));
  });
}

}  // namespace scarp
