// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/common.hpp>
#include <limits>
#include <mutex>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/rotate_voxels.h"
#include "scarp/scene/voxel/lattice_place.h"

namespace scarp {
namespace {

constexpr std::size_t kMostColours = 255;
constexpr int kEntryBits = 8;

bool is_solid(double value, std::optional<double> from) { return from ? value >= *from : value > 0; }  // NaN: no

// Source of the voxels of a grid: from(v) in the file, with the axes rotated.
struct FromFile {
  ivec3 size;  // size of the grid
  LatticeRotation turn, back;

  // A quarter turn about x: the file's y becomes z.
  FromFile(const ivec3& file_size, UpAxis up)
      : turn(up == UpAxis::y ? LatticeRotation{{0, 2, 1}, {1, -1, 1}} : LatticeRotation{}), back(turn.inverse()) {
    size = abs(turn(file_size));
  }
  ivec3 from(const ivec3& v) const { return rotated_voxel(v, size, back); }
  std::array<ivec3, 3> steps() const { return {back(ivec3(1, 0, 0)), back(ivec3(0, 1, 0)), back(ivec3(0, 0, 1))}; }
};

PlacedVoxels model_of(const FromFile& file, VoxelGrid grid, const FromVolumeOptions& options,
                      std::vector<VoxelColour> palette) {
  if (options.voxels.surface_colours) grid.drop_hidden_entries();
  const VoxelMarchEntry& march = file_voxel_march(options.voxels.march, {&grid.size(), 1});
  const auto model = std::make_shared<VoxelModel>(std::move(grid), march, std::move(palette));
  model->set_file_place({file.back, -min(file.back(file.size), 0)});
  return {{model}, {VoxelPlace{}}, options.voxels.rounding};
}

// The numbers of a brick that are inside the volume, by VoxelGrid::bit_of(); NaN outside.
using Numbers = std::array<double, 64>;
void read_brick(const DenseVolume& volume, const FromFile& file, const ivec3& brick, Numbers& numbers) {
  const ivec3 count = min(file.size - 4 * brick, 4);
  if (count != ivec3(4)) numbers.fill(std::numeric_limits<double>::quiet_NaN());
  volume.brick(file.from(4 * brick), file.steps(), count, numbers);
}

// Range of the numbers for which counts(number) is true.
template <class Counts>
SolidRange range_of(const DenseVolume& volume, const Counts& counts) {
  const FromFile file(volume.size(), UpAxis::z);
  const ivec3 bricks = (file.size + 3) / 4;
  constexpr SolidRange kNone{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  SolidRange range = kNone;
  std::mutex mutex;
  parallel_for(bricks.z, 1, [&](std::int64_t begin, std::int64_t end) {
    SolidRange own = kNone;
    Numbers numbers;
    for_each_voxel({{0, 0, static_cast<int>(begin)}, {bricks.x, bricks.y, static_cast<int>(end)}},
                   [&](const ivec3& brick) {
                     read_brick(volume, file, brick, numbers);
                     for (const double value : numbers) {
                       // NaN does not compare.
                       if (!counts(value)) continue;
                       own.low = value < own.low ? value : own.low;
                       own.high = value > own.high ? value : own.high;
                     }
                   });
    const std::lock_guard lock(mutex);
    range = {std::min(range.low, own.low), std::max(range.high, own.high)};
  });
  return range;
}

}  // namespace

SolidRange solid_range(const DenseVolume& volume, std::optional<double> solid_from) {
  return range_of(volume, [&](double value) { return is_solid(value, solid_from); });
}

SolidRange number_range(const DenseVolume& volume) {
  return range_of(volume, [](double) { return true; });
}

void require_marchable(const VolumeFormat& format, const VoxelFileOptions& options) {
  require_marchable(file_voxel_march(options.march, {&format.size, 1}), format.size);
}

PlacedVoxels placed_voxels_from(const Binvox& binvox, const VoxelColour& colour, const FromVolumeOptions& options) {
  const FromFile file(binvox.size, options.up);
  const auto fill = [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) {
    std::uint64_t mask = 0;
    for_each_voxel(intersection({4 * brick, 4 * brick + 4}, {ivec3(0), file.size}), [&](const ivec3& v) {
      if (binvox.solid(file.from(v))) mask |= std::uint64_t{1} << VoxelGrid::bit_of(v);
    });
    std::fill(entries.begin(), entries.end(), 1);
    return mask;
  };
  return model_of(file, VoxelGrid::built(file.size, kEntryBits, fill), options, {colour, colour});
}

PlacedVoxels placed_voxels_from(const DenseVolume& volume, std::span<const VoxelColour> colours,
                                const SolidRange& shown, const FromVolumeOptions& options) {
  if (colours.empty() || colours.size() > kMostColours) throw Error("volume: 1 to 255 colours are needed");
  // Infinite numbers have the last colour.
  const double low = shown.low, range = std::min(shown.high, std::numeric_limits<double>::max()) - low;
  std::vector<VoxelColour> palette{VoxelColour{}};
  palette.insert(palette.end(), colours.begin(), colours.end());
  const auto last = static_cast<double>(colours.size() - 1);
  const auto entry_of = [&](double value) {
    const double share = range > 0 ? std::min(1.0, (value - low) / range) : 1;
    return 1 + static_cast<std::uint32_t>(share * last + 0.5);
  };
  const FromFile file(volume.size(), options.up);
  const auto fill = [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) {
    Numbers numbers;
    read_brick(volume, file, brick, numbers);
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      mask |= std::uint64_t{is_solid(numbers[i], options.solid_from)} << i;
    if (colours.size() == 1) {
      std::fill(entries.begin(), entries.end(), 1);
    } else {
      for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        entries[i] = entry_of(numbers[i]);
      }
    }
    return mask;
  };
  return model_of(file, VoxelGrid::built(file.size, kEntryBits, fill), options, std::move(palette));
}

}  // namespace scarp
