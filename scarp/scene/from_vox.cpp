// SPDX-License-Identifier: MIT
#include "scarp/scene/from_vox.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Voxels compared in the overlaps of a scene: some minutes.
constexpr std::int64_t kMostCompared = std::int64_t{1} << 36;

VoxelGrid grid_of(const VoxModel& model) {
  VoxelGrid grid(model.size, 8);
  std::vector<std::uint8_t> indices(static_cast<std::size_t>(model.size.x) * static_cast<std::size_t>(model.size.y) *
                                    static_cast<std::size_t>(model.size.z));
  const auto place = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x + model.size.x * (y + model.size.y * z));
  };
  for (const VoxVoxel& v : model.voxels) indices[place(v.x, v.y, v.z)] = v.index;
  grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    const std::uint8_t index = indices[place(v.x, v.y, v.z)];
    return index > 0 ? VoxelGrid::Voxel(index) : VoxelGrid::Voxel();
  });
  return grid;
}

// An instance on the lattice of the world.
class OnLattice {
 public:
  OnLattice(const VoxInstance& instance, const VoxelGrid& grid)
      : grid_(&grid),
        turn_(instance.turn),
        back_(instance.turn.inverse()),
        origin_(instance.move - instance.turn(grid.size() / 2)) {
    if (grid.bounds().empty()) return;
    const ivec3 a = turn_(grid.bounds().low) + origin_, b = turn_(grid.bounds().high) + origin_;
    bounds_ = {glm::min(a, b), glm::max(a, b)};
  }

  const VoxelBox& bounds() const { return bounds_; }
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

// Calls body(a, b) for each pair of boxes that overlap, a before b.
template <class Body>
void for_each_overlap(const std::vector<OnLattice>& instances, const Body& body) {
  std::vector<std::size_t> order(instances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto low = [&](std::size_t i) { return instances[i].bounds().low.x; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const VoxelBox& box = instances[order[i]].bounds();
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) < box.high.x; ++j)
      body(std::min(order[i], order[j]), std::max(order[i], order[j]));
  }
}

}  // namespace

VoxelScene voxel_scene_from(const VoxFile& file, const FromVoxOptions& options) {
  const MarchEntry& march = find_voxel_march(options.voxels.march);
  const std::vector<VoxInstance> instances = vox_instances(file, options.scene);
  std::vector<VoxelColour> palette(256);
  for (std::size_t i = 1; i < palette.size(); ++i) {
    const VoxColour& colour = file.colours()[i - 1];
    palette[i] = {colour[0], colour[1], colour[2]};
  }

  std::map<int, VoxelGrid> grids;  // of the models that are used
  std::vector<OnLattice> on_lattice;
  for (const VoxInstance& instance : instances) {
    auto grid = grids.find(instance.model);
    if (grid == grids.end()) {
      const auto index = static_cast<std::size_t>(instance.model);
      grid = grids.emplace(instance.model, grid_of(file.models[index])).first;
    }
    on_lattice.emplace_back(instance, grid->second);
  }

  // What lies under another instance is taken out of a copy.
  std::map<std::size_t, VoxelGrid> cut;
  std::int64_t compared = 0;
  for_each_overlap(on_lattice, [&](std::size_t first, std::size_t last) {
    const auto [over, under] = file.version >= 200 ? std::pair(first, last) : std::pair(last, first);
    const VoxelBox common = intersection(on_lattice[over].bounds(), on_lattice[under].bounds());
    ++compared;
    if (!common.empty()) {
      const ivec3 size = common.high - common.low;
      compared += std::int64_t{size.x} * size.y * size.z;
    }
    if (compared > kMostCompared) throw Error("vox scene: more overlaps of models than can be settled");
    for_each_voxel(common,
                   [&, &upper = on_lattice[over], &lower = on_lattice[under], under = under](const ivec3& world) {
                     if (!upper.solid(world) || !lower.solid(world)) return;
                     auto grid = cut.find(under);
                     if (grid == cut.end()) grid = cut.emplace(under, grids.at(instances[under].model)).first;
                     grid->second.clear(lower.grid_voxel(world));
                   });
  });

  std::vector<std::shared_ptr<const VoxelModel>> models;
  std::map<int, std::uint32_t> shared;
  std::vector<VoxelPlace> places;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const int model = instances[i].model;
    const auto own = cut.find(i);
    const auto known = shared.find(model);
    auto index = static_cast<std::uint32_t>(models.size());
    if (own == cut.end() && known != shared.end()) {
      index = known->second;
    } else {
      VoxelGrid grid = own != cut.end() ? own->second : grids.at(model);
      if (options.voxels.surface_colours) grid.drop_hidden_entries();
      models.push_back(std::make_shared<const VoxelModel>(std::move(grid), march, palette));
      if (own == cut.end()) shared.emplace(model, index);
    }
    places.push_back(on_lattice[i].place(index));
  }
  return VoxelScene(std::move(models), places, options.voxels.rounding);
}

}  // namespace scarp
