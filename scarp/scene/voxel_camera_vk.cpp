// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel_camera_vk.h"

#include <optional>
#include <utility>
#include <variant>

#include "scarp/base/error.h"
#include "scarp/march/voxel/voxel_pictures_vk.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/scene_voxels_vk.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

const VoxelObjects& voxels_of(const Scene& scene) {
  if (const SceneField* field = scene.only_field()) {
    const SceneFieldParts parts = field->parts();
    const auto* voxels = std::get_if<SceneFieldParts::Voxels>(&parts.of);
    if (voxels && !voxels->objects->rounding()) return *voxels->objects;
  }
  throw Error("voxel camera: not a scene of one field, of voxels that are not rounded, at the origin");
}

}  // namespace

struct VoxelCamera::Impl {
  Impl(const Device& device_, const Scene& scene_, const DeviceVoxelSettings& settings_)
      : device(device_),
        scene(scene_),
        settings(settings_),
        there(device_, voxels_of(scene_)),
        queries(std::make_shared<DeviceVoxelQueries>(device_, settings_)) {}

  // Created on first use: compute does not need graphics.
  DeviceVoxelPictures& boxes() {
    if (!pictures) pictures.emplace(device, queries, settings.words);
    return *pictures;
  }

  Device device;
  Scene scene;
  DeviceVoxelSettings settings;
  ObjectsOnDevice there;
  std::shared_ptr<DeviceVoxelQueries> queries;
  std::optional<DeviceVoxelPictures> pictures;
  bool drew = false;  // the last picture, by proxies
};

VoxelCamera::VoxelCamera(const Device& device, const Scene& scene, const DeviceVoxelSettings& settings)
    : impl_(std::make_unique<Impl>(device, scene, settings)) {}
VoxelCamera::VoxelCamera(VoxelCamera&&) noexcept = default;
VoxelCamera& VoxelCamera::operator=(VoxelCamera&&) noexcept = default;
VoxelCamera::~VoxelCamera() = default;

void VoxelCamera::look(VoxelDrawing way, const VoxelPicture& picture, std::span<const Ray> rays, std::span<Hit> hits,
                       std::span<std::uint32_t> steps) {
  Impl& all = *impl_;
  all.drew = way == VoxelDrawing::proxies;
  const DeviceVoxelDetails details{steps, {}};
  const std::vector<std::size_t> left = all.drew
                                            ? all.boxes().draw(all.there.objects, picture, rays, hits, details)
                                            : all.queries->closest_hits(all.there.objects, rays, {}, hits, details);
  for (const std::size_t i : left) {
    MarchStats stats;
    hits[i] = all.scene.closest_hit(rays[i], nullptr, &stats);
    if (!steps.empty()) steps[i] = stats.steps;
  }
}

const std::vector<PassTime>& VoxelCamera::passes() const {
  return impl_->drew ? impl_->pictures->passes() : impl_->queries->passes();
}
std::size_t VoxelCamera::tied() const { return impl_->drew ? impl_->pictures->tied() : 0; }
VoxelCamera::Bytes VoxelCamera::bytes() const {
  return {impl_->there.grids.bytes(), impl_->there.objects.bytes(), impl_->pictures ? impl_->pictures->bytes() : 0};
}

}  // namespace scarp
