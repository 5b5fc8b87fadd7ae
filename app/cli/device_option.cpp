// SPDX-License-Identifier: MIT
#include "app/cli/device_option.h"

#include <fmt/format.h>

#include <utility>

#include "scarp/base/error.h"
#ifdef SCARP_VULKAN
#include "scarp/march/height/queries_vk.h"
#include "scarp/scene/scene_vk.h"
#include "scarp/scene/terrain_scene_vk.h"
#endif

namespace scarp::cli {
namespace {

TerrainScene scene_on_cpu(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings) {
  return {std::move(field), march, settings};
}

}  // namespace

void add_device_option(CLI::App& command, std::string& device) {
  command
      .add_option("--device", device,
                  "cpu, gpu, auto or part of a name: a Vulkan device answers the rays, in single precision, see "
                  "'scarp devices'; without this the marches of the CPU do, in double")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("expected cpu, gpu, auto or part of a name") : std::string();
      });
}

SceneMaker scene_maker(const std::string& device, const HeightMarchEntry& march) {
  if (device.empty()) return {scene_on_cpu, {}};
#ifdef SCARP_VULKAN
  if (!march.gpu) {
    throw Error(fmt::format("--device {}: march '{}' does not run on Vulkan devices; there run: {}", device, march.name,
                            device_march_names()));
  }
  const Device opened({.choice = device});
  return {[opened](HeightField field, const HeightMarchEntry& of, const MarchSettings& settings) {
            return terrain_scene_on(opened, std::move(field), of, settings);
          },
          opened.description().name};
#else
  throw Error(
      fmt::format("--device {}: this scarp was built without Vulkan (SCARP_VULKAN=OFF); leave it out, and march "
                  "'{}' runs on the CPU",
                  device, march.name));
#endif
}

SceneOnDevice scene_on_device(const std::string& device, const Scene& scene) {
  if (device.empty()) return {scene, {}};
#ifdef SCARP_VULKAN
  const Device opened({.choice = device});
  return {scene_on(opened, scene), opened.description().name};
#else
  throw Error(fmt::format("--device {}: this scarp was built without Vulkan (SCARP_VULKAN=OFF); leave it out", device));
#endif
}

}  // namespace scarp::cli
