// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_vox.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/scene/file/voxel_memory.h"
#include "scarp/scene/voxel/lattice_place.h"
#include "scarp/scene/voxel/ordered_pattern.h"
#include "scarp/source/voxel/vox_material.h"

namespace scarp {
namespace {

// Limits against hostile files: pairs of instances that are examined, and voxels that are compared where instances
// overlap, where each pair counts as kVoxelsPerPair voxels. Each limit is about 10 s of work.
constexpr std::int64_t kMostPairs = std::int64_t{1} << 32, kMostCompared = std::int64_t{1} << 29, kVoxelsPerPair = 8;
constexpr const char* kTooManyOverlaps =
    "its models overlap too much to decide which voxels are shown (move them apart, or unite them in the editor)";
constexpr int kIndexBits = 8;

std::int64_t voxels_in(const VoxelBox& box) {
  const ivec3 size = box.high - box.low;
  return std::int64_t{size.x} * size.y * size.z;
}

ivec3 place_of(const VoxVoxel& v) { return {v.x, v.y, v.z}; }

// A model's voxels in the smallest box around them.
struct Model {
  VoxelBox box;  // in the model of the file
  std::int64_t bytes = 0;
  VoxelGrid grid{ivec3(1), kIndexBits};
};

// Decides which voxels of a file are solid.
class Solid {
 public:
  explicit Solid(const VoxPalette& palette) {
    for (std::size_t i = 1; i < ranks_.size(); ++i) ranks_[i] = ranks_of(palette[i - 1][3]);
  }
  bool operator()(const VoxVoxel& v) const { return ordered_rank(place_of(v)) < ranks_[v.index]; }

 private:
  // Rounds to a number of ranks out of four, at least one for visible colours.
  static int ranks_of(int alpha) { return alpha == 0 ? 4 : std::max(1, (4 * alpha + 127) / 255); }

  std::array<int, 256> ranks_{};  // by palette index; 0: none
};

// Materials by palette index; empty if all are plain.
std::vector<VoxelMaterial> materials_of(const VoxFile& file) {
  std::vector<VoxelMaterial> materials;
  for (const VoxMaterial& of : file.materials) {
    const VoxelMaterial material{vox_emission(of), vox_mirror(of)};
    if (material.plain() || of.id < 1 || of.id > 255) continue;
    materials.resize(256);
    materials[static_cast<std::size_t>(of.id)] = material;
  }
  return materials;
}

// The models that are used.
class Models {
 public:
  Models(const VoxFile& file, const std::vector<VoxInstance>& instances, VoxelMemory& memory) : solid_(file.colours()) {
    // Nothing is allocated before all models are counted.
    for (const VoxInstance& instance : instances) {
      const auto [at, is_new] = models_.try_emplace(instance.model);
      if (!is_new) continue;
      measure(at->second, file.models[static_cast<std::size_t>(instance.model)].voxels);
      memory.add(at->second.bytes, "remove stray voxels far from the others");
    }
    for (auto& [index, model] : models_) {
      if (!model.box.empty()) fill(model, file.models[static_cast<std::size_t>(index)].voxels);
    }
  }

  Model& at(int index) { return models_.at(index); }

 private:
  void measure(Model& model, const std::vector<VoxVoxel>& voxels) const {
    std::int64_t solid = 0;
    for (const VoxVoxel& v : voxels) {
      if (!solid_(v)) continue;
      ++solid;
      model.box = around(model.box, {place_of(v), place_of(v) + 1});
    }
    if (model.box.empty()) return;
    const ivec3 size = model.box.high - model.box.low, bricks = (size + 3) / 4;
    std::vector<bool> pages(static_cast<std::size_t>(VoxelGrid::pages_of(size)));
    for (const VoxVoxel& v : voxels) {
      if (!solid_(v)) continue;
      const ivec3 brick = (place_of(v) - model.box.low) >> 2;
      pages[static_cast<std::size_t>((brick.x + bricks.x * (brick.y + bricks.y * brick.z)) / VoxelGrid::kPageBricks)] =
          true;
    }
    model.bytes = VoxelGrid::bytes_of(size, std::count(pages.begin(), pages.end(), true), solid, kIndexBits);
  }
  // Piece by piece, which limits the memory in use.
  void fill(Model& model, const std::vector<VoxVoxel>& voxels) const {
    model.grid = VoxelGrid(model.box.high - model.box.low, kIndexBits);
    std::vector<VoxelGrid::Placed> placed;
    placed.reserve(std::min(kVoxelsAtOnce, voxels.size()));
    for (const VoxVoxel& v : voxels) {
      placed.push_back({place_of(v) - model.box.low, solid_(v) ? VoxelGrid::Voxel(v.index) : VoxelGrid::Voxel()});
      if (placed.size() < kVoxelsAtOnce && &v != &voxels.back()) continue;
      model.grid.set(placed);
      placed.clear();
    }
  }

  Solid solid_;
  std::map<int, Model> models_;
};

// An instance on the lattice of the world.
struct Placed {
  const VoxModel* file_model;
  const Model* model;
  LatticePlace place;
  VoxelBox bounds;  // around its solid voxels

  Placed(const VoxInstance& instance, const VoxModel& from, const Model& of)
      : file_model(&from),
        model(&of),
        // Models rotate about their centre.
        place(instance.turn, instance.move - instance.turn(from.size / 2) + instance.turn(of.box.low)),
        bounds(place.lattice_box(of.grid.bounds())) {}

  bool solid(const ivec3& world) const {
    const ivec3 v = place.grid_voxel(world);
    return model->grid.box().contains(v) && model->grid.solid(v);
  }
  VoxelPlace scene_place(std::uint32_t index) const {
    const LatticeRotation& turn = place.turn();
    VoxelPlace in_scene{index, glm::dmat3(0.0), dvec3(place.origin())};
    for (int i = 0; i < 3; ++i) in_scene.world_from_grid[turn.axis[i]][i] = turn.sign[i];
    return in_scene;
  }
};

// Number of voxels that for_each_hidden() visits.
std::int64_t visited(const Placed& upper, const Placed& lower) {
  return std::min(voxels_in(intersection(upper.bounds, lower.bounds)),
                  static_cast<std::int64_t>(lower.file_model->voxels.size()));
}

// Calls hide(v) for each voxel v of the lower grid that the upper instance covers. Visits the voxels of the common box
// or of the file, whichever are fewer.
template <class Hide>
void for_each_hidden(const Placed& upper, const Placed& lower, const Hide& hide) {
  const VoxelBox common = intersection(upper.bounds, lower.bounds);
  const std::vector<VoxVoxel>& listed = lower.file_model->voxels;
  if (visited(upper, lower) < voxels_in(common)) {
    for (const VoxVoxel& voxel : listed) {
      if (voxel.index == 0) continue;
      const ivec3 v = place_of(voxel) - lower.model->box.low, world = lower.place.lattice_voxel(v);
      if (common.contains(world) && upper.solid(world) && lower.model->grid.solid(v)) hide(v);
    }
    return;
  }
  for_each_voxel(common, [&](const ivec3& world) {
    if (upper.solid(world) && lower.solid(world)) hide(lower.place.grid_voxel(world));
  });
}

// Calls body(a, b) for each pair of boxes that overlap, a before b. Examines the pairs that overlap along one axis: the
// axis with the fewest such pairs.
template <class Body>
void for_each_overlap(const std::vector<Placed>& instances, const Body& body) {
  std::vector<std::size_t> order, best_order;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].bounds.empty()) order.push_back(i);
  }
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  int best_axis = 0;
  std::vector<int> lows;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = [&](std::size_t i) { return instances[i].bounds.low[axis]; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
    lows.clear();
    for (const std::size_t i : order) lows.push_back(low(i));
    std::int64_t pairs = 0;
    for (auto at = lows.begin(); at != lows.end(); ++at) {
      const VoxelBox& box = instances[order[static_cast<std::size_t>(at - lows.begin())]].bounds;
      pairs += std::lower_bound(at + 1, lows.end(), box.high[axis]) - (at + 1);
    }
    if (pairs < least) least = pairs, best_axis = axis, best_order = order;
  }
  if (least > kMostPairs) throw Error(kTooManyOverlaps);
  for (std::size_t i = 0; i < best_order.size(); ++i) {
    const VoxelBox& box = instances[best_order[i]].bounds;
    for (std::size_t j = i + 1; j < best_order.size(); ++j) {
      const VoxelBox& other = instances[best_order[j]].bounds;
      if (other.low[best_axis] >= box.high[best_axis]) break;
      if (intersection(box, other).empty()) continue;
      body(std::min(best_order[i], best_order[j]), std::max(best_order[i], best_order[j]));
    }
  }
}

// Keeps one of several coincident instances of a model: the first, or the last.
std::vector<VoxInstance> different(std::vector<VoxInstance> instances, bool keeps_first) {
  const auto key = [](const VoxInstance& i) {
    return std::tuple(i.model, i.move.x, i.move.y, i.move.z, i.turn.axis, i.turn.sign);
  };
  std::set<decltype(key(instances[0]))> seen;
  std::vector<VoxInstance> kept;
  if (!keeps_first) std::reverse(instances.begin(), instances.end());
  for (const VoxInstance& instance : instances) {
    if (seen.insert(key(instance)).second) kept.push_back(instance);
  }
  if (!keeps_first) std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

PlacedVoxels placed_voxels_from(const VoxFile& file, const FromVoxOptions& options) {
  // Which instance is shown where several overlap.
  const bool first_wins = file.version >= 200;
  const std::vector<VoxInstance> instances = different(vox_instances(file, options.scene), first_wins);
  std::vector<VoxelColour> palette(256);
  for (std::size_t i = 1; i < palette.size(); ++i) {
    const VoxColour& colour = file.colours()[i - 1];
    palette[i] = {colour[0], colour[1], colour[2]};
  }

  const std::vector<VoxelMaterial> materials = materials_of(file);

  std::int64_t listed = 0;
  for (const VoxModel& model : file.models) listed += static_cast<std::int64_t>(model.voxels.size());
  VoxelMemory memory(listed);
  Models models(file, instances, memory);
  std::vector<Placed> placed;
  placed.reserve(instances.size());
  for (const VoxInstance& instance : instances)
    placed.emplace_back(instance, file.models[static_cast<std::size_t>(instance.model)], models.at(instance.model));

  // Voxels below another instance are removed from a copy.
  std::map<std::size_t, VoxelGrid> cut;
  const auto for_each_pair = [&](const auto& body) {
    for_each_overlap(placed,
                     [&](std::size_t first, std::size_t last) { first_wins ? body(first, last) : body(last, first); });
  };
  std::int64_t compared = 0;
  for_each_pair([&](std::size_t over, std::size_t under) {
    compared += kVoxelsPerPair + visited(placed[over], placed[under]);
    if (compared > kMostCompared) throw Error(kTooManyOverlaps);
  });
  for_each_pair([&](std::size_t over, std::size_t under) {
    const Placed& lower = placed[under];
    std::vector<VoxelGrid::Placed> hidden;
    const auto remove_hidden = [&] {
      if (!cut.contains(under)) {
        memory.add(lower.model->bytes, "move objects that overlap apart");
      }
      cut.try_emplace(under, lower.model->grid).first->second.set(hidden);
      hidden.clear();
    };
    for_each_hidden(placed[over], lower, [&](const ivec3& v) {
      hidden.push_back({v, {}});
      if (hidden.size() == kVoxelsAtOnce) remove_hidden();
    });
    if (!hidden.empty()) remove_hidden();
  });

  // Models that are used as they are, then those that lost voxels.
  std::vector<std::uint32_t> model_of(instances.size());
  std::map<int, std::uint32_t> shared;
  std::vector<VoxelGrid*> grids;
  std::vector<ivec3> lows;  // lower corners of the grids in their models
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto own = cut.find(i);
    const auto next = static_cast<std::uint32_t>(grids.size());
    model_of[i] = own != cut.end() ? next : shared.try_emplace(instances[i].model, next).first->second;
    if (model_of[i] != next) continue;
    grids.push_back(own != cut.end() ? &own->second : &models.at(instances[i].model).grid);
    lows.push_back(models.at(instances[i].model).box.low);
  }
  std::vector<ivec3> sizes;
  for (const VoxelGrid* grid : grids) sizes.push_back(grid->size());
  const VoxelMarchEntry& march = file_voxel_march(options.voxels.march, sizes);
  for (const ivec3& size : sizes) {
    require_marchable(march, size);
    memory.add(accelerator_bytes(march.accelerator, size), "choose --march voxel-bricks");
  }

  PlacedVoxels in_scene{.rounding = options.voxels.rounding};
  for (std::size_t i = 0; i < instances.size(); ++i) in_scene.places.push_back(placed[i].scene_place(model_of[i]));
  for (std::size_t i = 0; i < grids.size(); ++i) {
    if (options.voxels.surface_colours) grids[i]->drop_hidden_entries();
    const auto model =
        std::make_shared<VoxelModel>(std::move(*grids[i]), march, palette, VoxelModel::Extent::bounds, materials);
    model->set_file_place({{}, lows[i]});
    in_scene.models.push_back(model);
  }
  return in_scene;
}

}  // namespace scarp
