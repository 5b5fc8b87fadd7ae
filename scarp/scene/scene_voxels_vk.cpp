// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_voxels_vk.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <glm/matrix.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/voxel/voxel_pictures_vk.h"
#include "scarp/scene/camera_batch.h"
#include "scarp/scene/scene_limits.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

std::vector<MarchedGrid> parts_of(const VoxelObjects& objects) {
  std::vector<MarchedGrid> parts;
  for (const auto& model : objects.models()) {
    if (!model->march().gpu) {
      std::vector<std::string_view> available;
      for (const VoxelMarchEntry& march : voxel_marches()) {
        if (march.gpu) available.push_back(march.name);
      }
      throw Error(fmt::format("march '{}': does not run on Vulkan devices (available: {})", model->march().name,
                              fmt::join(available, ", ")));
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
  for (const VoxelObjects::PlacedTurn& turn : voxels.turns()) {
    const glm::dmat3 rows = transpose(turn.grid_from_world);
    glsl::ScarpVoxelTurn& to = turns.emplace_back();
    for (int axis = 0; axis < 3; ++axis) to.rows[axis] = rows[axis];
    to.room = turn.room;
    to.per_metre = turn.per_metre;
    for (std::size_t frame = 0; frame < turn.ties.size(); ++frame)
      to.ties[frame / 4] |= std::uint32_t{turn.ties[frame]} << (8 * (frame % 4));
  }
  const BoxTree::Parts tree = voxels.tree().parts();
  std::vector<glsl::ScarpBoxNode> nodes(tree.nodes.size() / sizeof(glsl::ScarpBoxNode));
  if (!nodes.empty()) std::memcpy(nodes.data(), tree.nodes.data(), tree.nodes.size());
  return {device, grids, objects, turns, {nodes, tree.middle, tree.box.low, tree.box.high, tree.levels}};
}

class VoxelsOnDevice final : public FieldOnDevice {
 public:
  VoxelsOnDevice(const Device& device, std::shared_ptr<DeviceVoxelQueries> queries, std::shared_ptr<VoxelSight> sight,
                 const SceneField& field, SceneFieldParts::Voxels parts)
      : queries_(std::move(queries)),
        sight_(std::move(sight)),
        device_(device),
        field_(field),
        parts_(std::move(parts)),
        there_(device, *parts_.objects) {}

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const> from) override {
    if (parts_.objects->tree().empty()) {
      std::fill(hits.begin(), hits.end(), Hit{});
      return std::fill(steps.begin(), steps.end(), 0);
    }
    const auto left =
        draws(steps, from) ? draw(rays, hits) : queries_->closest_hits(there_.objects, rays, from, hits, {steps, {}});
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
  // Drawings do not count the steps of the whole ray.
  bool draws(std::span<const std::uint32_t> steps, std::span<const Hit* const> from) const {
    return sight_ && sight_->drawing == VoxelDrawing::proxies && steps.empty() && from.empty();
  }

  // As queries_->closest_hits().
  std::vector<std::size_t> draw(std::span<const Ray> rays, std::span<Hit> hits) {
    const std::optional<CameraBatch> batch = camera_batch(sight_->picture, rays);
    if (!batch) return queries_->closest_hits(there_.objects, rays, {}, hits);
    // Pixels without a ray get one with an empty range.
    Ray none;
    none.t_min = 1, none.t_max = 0;
    const std::size_t pixels = batch->ray.size();
    std::vector<Ray> asked(pixels, none);
    std::vector<Hit> answers(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (batch->ray[i] != CameraBatch::kNone) asked[i] = rays[batch->ray[i]];
    }
    std::vector<std::size_t> left;
    for (const std::size_t i : sight_pictures().draw(there_.objects, batch->picture, asked, answers))
      left.push_back(batch->ray[i]);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (batch->ray[i] != CameraBatch::kNone) hits[batch->ray[i]] = answers[i];
    }
    sight_->drawn += rays.size() - batch->others.size();
    if (batch->others.empty()) return left;
    asked.clear();
    for (const std::size_t i : batch->others) asked.push_back(rays[i]);
    answers.resize(asked.size());
    for (const std::size_t i : queries_->closest_hits(there_.objects, asked, {}, answers))
      left.push_back(batch->others[i]);
    for (std::size_t i = 0; i < asked.size(); ++i) hits[batch->others[i]] = answers[i];
    return left;
  }
  // Created on first use: compute does not need graphics.
  DeviceVoxelPictures& sight_pictures() {
    if (!pictures_) pictures_.emplace(device_, queries_);
    return *pictures_;
  }

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
  std::shared_ptr<VoxelSight> sight_;  // may be null
  Device device_;
  std::optional<DeviceVoxelPictures> pictures_;
  const SceneField& field_;
  SceneFieldParts::Voxels parts_;
  ObjectsOnDevice there_;
};

}  // namespace

ObjectsOnDevice::ObjectsOnDevice(const Device& device, const VoxelObjects& voxels)
    : grids(device, parts_of(voxels)), objects(placed_on(device, grids, voxels)) {}

std::unique_ptr<FieldOnDevice> voxels_on_device(const Device& device,
                                                const std::shared_ptr<DeviceVoxelQueries>& queries,
                                                const std::shared_ptr<VoxelSight>& sight, const SceneField& field,
                                                const SceneFieldParts::Voxels& parts) {
  if (parts.objects->rounding()) return nullptr;
  return std::make_unique<VoxelsOnDevice>(device, queries, sight, field, parts);
}

}  // namespace scarp
