// SPDX-License-Identifier: MIT
#include "app/cli/device_option.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#ifdef SCARP_VULKAN
#include "scarp/march/height/queries_vk.h"
#include "scarp/scene/scene_vk.h"
#endif

namespace scarp::cli {

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

SceneOnDevice scene_on_device(const std::string& device, const Scene& scene) {
  if (device.empty()) return {scene, {}};
#ifdef SCARP_VULKAN
  const Device opened({.choice = device});
  return {scene_on(opened, scene), opened.description().name};
#else
  throw Error(fmt::format("--device {}: this scarp was built without Vulkan (SCARP_VULKAN=OFF)", device));
#endif
}

}  // namespace scarp::cli
