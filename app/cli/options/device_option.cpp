// SPDX-License-Identifier: MIT
#include "app/cli/options/device_option.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#ifdef SCARP_VULKAN
#include "scarp/march/height/queries_vk.h"
#include "scarp/scene/scene_vk.h"
#endif

namespace scarp::cli {

#ifdef SCARP_VULKAN
struct DeviceSight {
  VoxelSight voxels;
};
#else
struct DeviceSight {};
#endif

void add_device_option(Command& command, std::string& device) {
  command.add(
      [&device](const std::string& text) {
        if (text.empty()) throw WrongUsage("--device '': expected cpu, gpu, auto or part of a name");
        device = text;
      },
      {.names = "--device",
       .value = "NAME",
       .help = "Vulkan device that traces the rays: cpu, gpu, auto or part of a name",
       .note = "see 'scarp devices'",
       .fallback = "none: the CPU",
       .common = true,
       .inputs = {kTerrain | kVoxels | kScene | kFunction, "meshes are traced on the CPU"}});
}

void add_voxel_drawing_option(Command& command, std::string& drawing, const std::string& device) {
  command.add(&drawing, {.names = "--voxel-drawing",
                         .value = "WAY",
                         .help = "method for camera rays over voxels on the device",
                         .choices = {"compute", "proxies"},
                         .closed = true,
                         .note = "compute: hierarchy of boxes; proxies: boxes drawn as triangles; the picture is the "
                                 "same",
                         .inputs = {kVoxels | kScene, "only voxels are drawn"},
                         .rules = {needs("--device NAME", [&device] { return !device.empty(); })}});
}

void require_device_march(const std::string& device, const HeightMarchEntry& march) {
  if (device.empty()) return;
#ifdef SCARP_VULKAN
  if (march.gpu) return;
  throw Error(fmt::format("--device {}: march '{}' does not run on Vulkan devices (available: {})", device, march.name,
                          device_march_names()));
#else
  throw Error(
      fmt::format("--device {}: this scarp was built without Vulkan (SCARP_VULKAN=OFF); without the option, march "
                  "'{}' runs on the CPU",
                  device, march.name));
#endif
}

SceneOnDevice scene_on_device(const std::string& device, const Scene& scene,
                              [[maybe_unused]] const std::string& drawing) {
  if (device.empty()) return {scene, {}};
#ifdef SCARP_VULKAN
  const Device opened({.choice = device});
  const auto sight = std::make_shared<DeviceSight>();
  for (const VoxelDrawingName& way : kVoxelDrawings) {
    if (way.name == drawing) sight->voxels.drawing = way.drawing;
  }
  return {scene_on(opened, scene, {sight, &sight->voxels}), opened.description().name, sight};
#else
  throw Error(fmt::format("--device {}: this scarp was built without Vulkan (SCARP_VULKAN=OFF)", device));
#endif
}

#ifdef SCARP_VULKAN
void look_through(const SceneOnDevice& there, const Camera& camera, int aa) {
  if (!there.sight) return;
  const Camera::PixelRays rays = camera.pixel_rays();
  const dvec2 size = camera.size() * static_cast<double>(aa);
  // A pixel per sample.
  there.sight->voxels.picture = {
      static_cast<std::uint32_t>(size.x),          static_cast<std::uint32_t>(size.y),         rays.origin,
      rays.origin_right / static_cast<double>(aa), rays.origin_down / static_cast<double>(aa), rays.direction,
      rays.right / static_cast<double>(aa),        rays.down / static_cast<double>(aa)};
}

std::string drawn_by(const SceneOnDevice& there) {
  if (!there.sight || there.sight->voxels.drawing != VoxelDrawing::proxies) return {};
  return fmt::format("{} rays by drawing", there.sight->voxels.drawn);
}
#else
void look_through(const SceneOnDevice&, const Camera&, int) {}
std::string drawn_by(const SceneOnDevice&) { return {}; }
#endif

}  // namespace scarp::cli
