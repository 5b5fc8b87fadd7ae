// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_vox.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// What files may ask for before they are refused. Voxels in the boxes of all models, those that lose voxels to others
// counted once more each: 2 GiB of masks and pages. Pairs of instances that are looked at, and voxels compared where
// they overlap, each pair as much as some: about a minute each.
constexpr std::int64_t kMostVoxels = std::int64_t{1} << 34, kMostPairs = std::int64_t{1} << 34,
                       kMostCompared = std::int64_t{1} << 32, kVoxelsPerPair = 8;
constexpr std::size_t kPiece = std::size_t{1} << 20;  // voxels put into a grid at once

std::int64_t voxels_in(const VoxelBox& box) {
  const ivec3 size = box.high - box.low;
  return std::int64_t{size.x} * size.y * size.z;
}

ivec3 place_of(const VoxVoxel& v) { return {v.x, v.y, v.z}; }

// A model's voxels in the least box around them: canvases are mostly empty.
struct Model {
  VoxelBox box;  // in the canvas
  VoxelGrid grid{ivec3(1), 8};
};

// The models that are used.
class Models {
 public:
  Models(const VoxFile& file, const std::vector<VoxInstance>& instances) {
    // Nothing is allocated before all are counted.
    for (const VoxInstance& instance : instances) {
      const auto [at, is_new] = models_.try_emplace(instance.model);
      if (!is_new) continue;
      for (const VoxVoxel& v : file.models[static_cast<std::size_t>(instance.model)].voxels) {
        if (v.index > 0) at->second.box = around(at->second.box, {place_of(v), place_of(v) + 1});
      }
      count(at->second.box);
    }
    for (auto& [index, model] : models_) {
      if (!model.box.empty()) fill(model, file.models[static_cast<std::size_t>(index)].voxels);
    }
  }

  const Model& at(int index) const { return models_.at(index); }
  // Counts another grid of this box.
  void count(const VoxelBox& box) {
    voxels_ += voxels_in(box);
    if (voxels_ > kMostVoxels) {
      throw Error(
          fmt::format("vox scene: the boxes round its models, those that others overlap counted one by one, hold more "
                      "than {} voxels",
                      kMostVoxels));
    }
  }

 private:
  // Piece by piece, which bounds what is remembered.
  static void fill(Model& model, const std::vector<VoxVoxel>& voxels) {
    model.grid = VoxelGrid(model.box.high - model.box.low, 8);
    std::vector<VoxelGrid::Placed> placed;
    for (const VoxVoxel& v : voxels) {
      placed.push_back({place_of(v) - model.box.low, v.index > 0 ? VoxelGrid::Voxel(v.index) : VoxelGrid::Voxel()});
      if (placed.size() < kPiece && &v != &voxels.back()) continue;
      model.grid.set(placed);
      placed.clear();
    }
  }

  std::map<int, Model> models_;
  std::int64_t voxels_ = 0;
};

// An instance on the lattice of the world.
class OnLattice {
 public:
  // canvas: the sides of the model, as the file has it; they turn about its middle.
  OnLattice(const VoxInstance& instance, const ivec3& canvas, const Model& model)
      : grid_(&model.grid),
        turn_(instance.turn),
        back_(instance.turn.inverse()),
        origin_(instance.move - instance.turn(canvas / 2) + instance.turn(model.box.low)) {
    const VoxelBox& solid = grid_->bounds();
    if (solid.empty()) return;
    const ivec3 a = turn_(solid.low) + origin_, b = turn_(solid.high) + origin_;
    bounds_ = {glm::min(a, b), glm::max(a, b)};
  }

  const VoxelBox& bounds() const { return bounds_; }
  const VoxelGrid& grid() const { return *grid_; }
  // The voxel of the grid in the cube of the world whose lowest corner this is: their middles are the same.
  ivec3 grid_voxel(const ivec3& world) const {
    // Twice the coordinates, so that middles are whole.
    const ivec3 middle = back_(2 * (world - origin_) + 1);
    return (middle - 1) / 2;
  }
  bool solid(const ivec3& world) const {
    const ivec3 v = grid_voxel(world);
    return grid_->box().contains(v) && grid_->solid(v);
  }
  VoxelPlace place(std::uint32_t model) const {
    VoxelPlace place{model, glm::dmat3(0.0), dvec3(origin_)};
    for (int i = 0; i < 3; ++i) place.world_from_grid[turn_.axis[i]][i] = turn_.sign[i];
    return place;
  }

 private:
  const VoxelGrid* grid_;
  LatticeRotation turn_, back_;
  ivec3 origin_;
  VoxelBox bounds_;
};

// Calls body(a, b) for each pair of boxes that overlap, a before b: of those that overlap along one axis, that along
// which the fewest do.
template <class Body>
void for_each_overlap(const std::vector<OnLattice>& instances, const Body& body) {
  std::vector<std::size_t> order, best_order;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].bounds().empty()) order.push_back(i);
  }
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  int best_axis = 0;
  std::vector<int> lows;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = [&](std::size_t i) { return instances[i].bounds().low[axis]; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
    lows.clear();
    for (const std::size_t i : order) lows.push_back(low(i));
    std::int64_t pairs = 0;
    for (auto at = lows.begin(); at != lows.end(); ++at) {
      const VoxelBox& box = instances[order[static_cast<std::size_t>(at - lows.begin())]].bounds();
      pairs += std::lower_bound(at + 1, lows.end(), box.high[axis]) - (at + 1);
    }
    if (pairs < least) least = pairs, best_axis = axis, best_order = order;
  }
  if (least > kMostPairs) throw Error("vox scene: more of its models overlap than can be settled");
  for (std::size_t i = 0; i < best_order.size(); ++i) {
    const VoxelBox& box = instances[best_order[i]].bounds();
    for (std::size_t j = i + 1; j < best_order.size(); ++j) {
      const VoxelBox& other = instances[best_order[j]].bounds();
      if (other.low[best_axis] >= box.high[best_axis]) break;
      if (intersection(box, other).empty()) continue;
      body(std::min(best_order[i], best_order[j]), std::max(best_order[i], best_order[j]));
    }
  }
}

}  // namespace

PlacedVoxels placed_voxels_from(const VoxFile& file, const FromVoxOptions& options) {
  const std::vector<VoxInstance> instances = vox_instances(file, options.scene);
  std::vector<VoxelColour> palette(256);
  for (std::size_t i = 1; i < palette.size(); ++i) {
    const VoxColour& colour = file.colours()[i - 1];
    palette[i] = {colour[0], colour[1], colour[2]};
  }

  Models grids(file, instances);
  std::vector<OnLattice> on_lattice;
  for (const VoxInstance& instance : instances) {
    const VoxModel& model = file.models[static_cast<std::size_t>(instance.model)];
    on_lattice.emplace_back(instance, model.size, grids.at(instance.model));
  }

  // What lies under another instance is taken out of a copy.
  std::map<std::size_t, VoxelGrid> cut;
  std::int64_t compared = 0;
  for_each_overlap(on_lattice, [&](std::size_t first, std::size_t last) {
    const auto [over, under] = file.version >= 200 ? std::pair(first, last) : std::pair(last, first);
    const OnLattice &upper = on_lattice[over], &lower = on_lattice[under];
    const VoxelBox common = intersection(upper.bounds(), lower.bounds());
    compared += kVoxelsPerPair + voxels_in(common);
    if (compared > kMostCompared) throw Error("vox scene: larger overlaps of its models than can be settled");
    // Layer by layer, which bounds what is remembered.
    std::vector<VoxelGrid::Placed> hidden;
    for (int z = common.low.z; z < common.high.z; ++z) {
      hidden.clear();
      for_each_voxel({{common.low.x, common.low.y, z}, {common.high.x, common.high.y, z + 1}}, [&](const ivec3& world) {
        if (upper.solid(world) && lower.solid(world)) hidden.push_back({lower.grid_voxel(world), {}});
      });
      if (hidden.empty()) continue;
      if (!cut.contains(under)) grids.count(lower.grid().box());
      cut.try_emplace(under, lower.grid()).first->second.set(hidden);
    }
  });

  PlacedVoxels placed{.rounding = options.voxels.rounding};
  std::vector<VoxelGrid> own_grids;
  std::vector<ivec3> sizes;
  std::map<int, std::uint32_t> shared;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const int model = instances[i].model;
    const auto own = cut.find(i);
    const auto known = shared.find(model);
    auto index = static_cast<std::uint32_t>(own_grids.size());
    if (own == cut.end() && known != shared.end()) {
      index = known->second;
    } else {
      VoxelGrid grid = own != cut.end() ? std::move(own->second) : grids.at(model).grid;
      if (options.voxels.surface_colours) grid.drop_hidden_entries();
      sizes.push_back(grid.size());
      own_grids.push_back(std::move(grid));
      if (own == cut.end()) shared.emplace(model, index);
    }
    placed.places.push_back(on_lattice[i].place(index));
  }
  const VoxelMarchEntry& march = file_voxel_march(options.voxels.march, sizes);
  for (VoxelGrid& grid : own_grids)
    placed.models.push_back(std::make_shared<const VoxelModel>(std::move(grid), march, palette));
  return placed;
}

}  // namespace scarp
