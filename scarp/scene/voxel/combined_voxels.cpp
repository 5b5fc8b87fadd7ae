// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/combined_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/scene/voxel/lattice_place.h"

namespace scarp {
namespace {

constexpr double kTolerance = 1e-6;    // of a voxel
constexpr double kFarthest = 1 << 28;  // voxels from the first place
constexpr int kRgbBits = 24;

// A model on the lattice that all parts share.
struct OnLattice {
  const VoxelModel* model;
  LatticePlace place;
  VoxelBox bounds;  // around its solid voxels
};

std::optional<LatticeRotation> lattice_rotation(const glm::dmat3& matrix) {
  LatticeRotation turn{{-1, -1, -1}, {1, 1, 1}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double entry = matrix[column][row];
      if (std::abs(entry) <= kTolerance) continue;
      if (std::abs(std::abs(entry) - 1) > kTolerance || turn.axis[row] >= 0) return {};
      turn.axis[row] = column;
      turn.sign[row] = entry > 0 ? 1 : -1;
    }
    if (turn.axis[row] < 0) return {};
  }
  return turn;
}

// Converts a place to the lattice of another one.
OnLattice on_lattice(const VoxelPlace& place, const VoxelPlace& lattice, const VoxelModel& model, std::size_t part) {
  const glm::dmat3 lattice_from_world = glm::inverse(lattice.world_from_grid);
  const auto turn = lattice_rotation(lattice_from_world * place.world_from_grid);
  if (!turn) {
    throw Error(
        fmt::format("part {} is rotated or scaled relative to the first one (combined voxels need quarter turns "
                    "and equal sizes)",
                    part));
  }
  const dvec3 offset = lattice_from_world * (place.origin - lattice.origin), whole = glm::round(offset);
  const dvec3 away = glm::abs(offset - whole);
  if (!(std::max({away.x, away.y, away.z}) <= kTolerance)) {
    throw Error(
        fmt::format("part {} is ({:.6g}, {:.6g}, {:.6g}) voxels off the lattice of the first one (combined voxels "
                    "need whole offsets)",
                    part, away.x, away.y, away.z));
  }
  if (std::max({std::abs(whole.x), std::abs(whole.y), std::abs(whole.z)}) > kFarthest)
    throw Error(fmt::format("part {} is more than {} voxels from the first one", part, static_cast<int>(kFarthest)));
  const LatticePlace on(*turn, ivec3(whole));
  return {&model, on, on.lattice_box(model.grid().bounds())};
}

// The voxels of a part within a box of the lattice.
VoxelGrid grid_of(const std::vector<OnLattice>& part, const VoxelBox& box) {
  VoxelGrid grid(box.high - box.low, kRgbBits);
  for (const OnLattice& placed : part) {
    const VoxelBox common = intersection(placed.bounds, box);
    if (common.empty()) continue;
    const VoxelGrid& from = placed.model->grid();
    grid.edit({common.low - box.low, common.high - box.low},
              [&](const ivec3& v, const VoxelGrid::Voxel& before) -> VoxelGrid::Voxel {
                if (before) return before;
                const ivec3 voxel = placed.place.grid_voxel(v + box.low);
                if (!from.solid(voxel)) return {};
                const VoxelColour rgb = placed.model->colour(from.entry(voxel));
                return rgb[0] | std::uint32_t{rgb[1]} << 8 | std::uint32_t{rgb[2]} << 16;
              });
  }
  return grid;
}

void combine_into(VoxelGrid& grid, VoxelCombination combination, const VoxelGrid& other) {
  switch (combination) {
    case VoxelCombination::unite:
      grid.unite(other);
      return;
    case VoxelCombination::intersect:
      grid.intersect(other);
      return;
    case VoxelCombination::subtract:
      grid.subtract(other);
      return;
  }
}

}  // namespace

PlacedVoxels combined_voxels(VoxelCombination combination, std::span<const PlacedVoxels> parts,
                             const VoxelFileOptions& options) {
  PlacedVoxels combined{.rounding = options.rounding};
  const auto first = std::find_if(parts.begin(), parts.end(), [](const auto& part) { return !part.places.empty(); });
  if (first == parts.end()) return combined;
  const VoxelPlace lattice = first->places.front();

  std::vector<std::vector<OnLattice>> placed(parts.size());
  std::vector<VoxelBox> bounds(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const VoxelPlace& place : parts[i].places) {
      placed[i].push_back(on_lattice(place, lattice, *parts[i].models.at(place.model), i));
      bounds[i] = around(bounds[i], placed[i].back().bounds);
    }
  }
  VoxelBox box = bounds[0];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (combination == VoxelCombination::unite) box = around(box, bounds[i]);
    if (combination == VoxelCombination::intersect) box = intersection(box, bounds[i]);
  }
  if (box.empty()) return combined;
  const ivec3 size = box.high - box.low;
  if (std::max({size.x, size.y, size.z}) > VoxelGrid::kMaxModelSide) {
    throw Error(fmt::format("{} x {} x {} combined voxels (each side is limited to {})", size.x, size.y, size.z,
                            VoxelGrid::kMaxModelSide));
  }

  VoxelGrid grid = grid_of(placed[0], box);
  for (std::size_t i = 1; i < parts.size(); ++i) combine_into(grid, combination, grid_of(placed[i], box));
  if (grid.solid_count() == 0) return combined;
  if (options.surface_colours) grid.drop_hidden_entries();
  const VoxelMarchEntry& march = file_voxel_march(options.march, {&size, 1});
  combined.models.push_back(std::make_shared<const VoxelModel>(std::move(grid), march));
  combined.places.push_back({0, lattice.world_from_grid, lattice.origin + lattice.world_from_grid * dvec3(box.low)});
  return combined;
}

}  // namespace scarp
