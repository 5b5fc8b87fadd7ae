// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_voxels_vk.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/scene_limits.h"
#include "scarp/scene/voxel_objects.h"

namespace scarp {
namespace {

std::vector<MarchedGrid> parts_of(const VoxelObjects& objects) {
  std::vector<MarchedGrid> parts;
  for (const auto& model : objects.models()) {
    if (!model->march().gpu) {
      throw Error(fmt::format("march '{}': does not run on Vulkan devices (available: all other voxel marches)",
                              model->march().name));
    }
    const VoxelTarget target = model->target();
    parts.push_back({target.grid, target.box, target.spheres, target.cubes, target.octants, target.bricks});
  }
  return parts;
}

DeviceVoxelObjects placed_on(const Device& device, const DeviceVoxels& grids, const VoxelObjects& voxels) {
  std::vector<glsl::ScarpVoxelObject> objects;
  for (const VoxelObjects::Placed& placed : voxels.placed())
    objects.push_back({placed.origin, placed.model, placed.turn, placed.part, 0});
  std::vector<glsl::ScarpVoxelTurn> turns;
  for (const glm::dmat3& turn : voxels.turns()) {
    const glm::dmat3 rows = transpose(turn);
    turns.push_back({{rows[0], rows[1], rows[2]}});
  }
  const BoxTree::Parts tree = voxels.tree().parts();
  std::vector<glsl::ScarpBoxNode> nodes(tree.nodes.size() / sizeof(glsl::ScarpBoxNode));
  if (!nodes.empty()) std::memcpy(nodes.data(), tree.nodes.data(), tree.nodes.size());
  return {device, grids, objects, turns, {nodes, tree.middle, tree.box.low, tree.box.high, tree.levels}};
}

class VoxelsOnDevice final : public FieldOnDevice {
 public:
  VoxelsOnDevice(const Device& device, std::shared_ptr<DeviceVoxelQueries> queries, const SceneField& field,
                 SceneFieldParts::Voxels parts)
      : queries_(std::move(queries)), field_(field), parts_(std::move(parts)), there_(device, *parts_.objects) {}

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const> from) override {
    if (parts_.objects->tree().empty()) {
      std::fill(hits.begin(), hits.end(), Hit{});
      return std::fill(steps.begin(), steps.end(), 0);
    }
    const auto left = queries_->closest_hits(there_.objects, rays, from, hits, {steps, {}});
    for_each(left, [&](std::size_t i) {
      MarchStats stats;
      hits[i] = field_.closest_hit(rays[i], from.empty() ? nullptr : from[i], &stats);
      if (!steps.empty()) steps[i] = stats.steps;
    });
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, std::span<const Hit* const> from) override {
    if (parts_.objects->tree().empty()) return std::fill(blocked.begin(), blocked.end(), 0);
    if (parts_.shadow_ray && !from.empty()) {
      std::vector<Ray> begun(rays.begin(), rays.end());
      std::vector<std::size_t> all(rays.size());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
      for_each(all, [&](std::size_t i) {
        if (from[i]) begun[i] = parts_.shadow_ray(rays[i], *from[i]);
      });
      return ask_occluded(begun, blocked, {});
    }
    ask_occluded(rays, blocked, from);
  }

 private:
  void ask_occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, std::span<const Hit* const> from) {
    const auto left = queries_->occluded(there_.objects, rays, from, blocked);
    for_each(left, [&](std::size_t i) {
      blocked[i] = from.empty() || !from[i] ? parts_.objects->occluded(rays[i])
                                            : parts_.objects->occluded_from(*from[i], rays[i]);
    });
  }

  template <class Body>
  static void for_each(const std::vector<std::size_t>& indices, const Body& body) {
    parallel_for(static_cast<std::int64_t>(indices.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(indices[i]);
    });
  }

  std::shared_ptr<DeviceVoxelQueries> queries_;
  const SceneField& field_;
  SceneFieldParts::Voxels parts_;
  ObjectsOnDevice there_;
};

}  // namespace

ObjectsOnDevice::ObjectsOnDevice(const Device& device, const VoxelObjects& voxels)
    : grids(device, parts_of(voxels)), objects(placed_on(device, grids, voxels)) {}

std::unique_ptr<FieldOnDevice> voxels_on_device(const Device& device,
                                                const std::shared_ptr<DeviceVoxelQueries>& queries,
                                                const SceneField& field, const SceneFieldParts::Voxels& parts) {
  if (parts.objects->rounding()) return nullptr;
  return std::make_unique<VoxelsOnDevice>(device, queries, field, parts);
}

}  // namespace scarp
