// SPDX-License-Identifier: MIT
#include "app/cli/device_option.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#ifdef SCARP_VULKAN
#include "scarp/march/height/queries_vk.h"
#include "scarp/scene/scene_vk.h"
#endif

namespace scarp::cli {
void add_device_option(CLI::App& command, std::string& device) {
  command
      .add_option("--device", device,
                  "cpu, gpu, auto or part of a name: a Vulkan device answers the rays, in single precision, see "
                  "'scarp devices'; without this the marches of the CPU do, in double")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("expected cpu, gpu, auto or part of a name") : std::string();
      });
}

void require_device_march(const std::string& device, const HeightMarchEntry& march) {
  if (device.empty()) return;
#ifdef SCARP_VULKAN
  if (march.gpu) return;
  throw Error(fmt::format("--device {}: march '{}' does not run on Vulkan devices (available: {})", device, march.name,
                          device_march_names()));
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
