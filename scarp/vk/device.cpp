// SPDX-License-Identifier: MIT
#include "scarp/vk/device.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <span>

#include "scarp/vk/pipeline_cache.h"
#include "scarp/vk/raii.h"
#include "scarp/vk/staging.h"

namespace scarp {
namespace {

std::vector<DeviceDescription> described(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::vector<DeviceDescription> all;
  for (const vk::raii::PhysicalDevice& device : devices) all.push_back(describe(device));
  return all;
}

vk::raii::PhysicalDevice chosen(const VulkanInstance& instance, const std::string& choice) {
  const auto devices = instance.physical_devices();
  if (devices.empty()) throw Error(no_driver());
  return devices[choose_device(described(devices), choice)];
}

vk::raii::Device open(const vk::raii::PhysicalDevice& physical, std::uint32_t family,
                      const DeviceAbilities& abilities) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features> create;
  create.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue);
  create.get<vk::PhysicalDeviceFeatures2>()
      .features.setShaderFloat64(abilities.float64)
      .setShaderInt64(abilities.int64);
  create.get<vk::PhysicalDeviceVulkan12Features>().setScalarBlockLayout(true).setBufferDeviceAddress(true);
  return {physical, create.get<vk::DeviceCreateInfo>()};
}

}  // namespace

std::string vulkan_failure(vk::Result result, const std::string& device, const std::string& what) {
  const std::string where = device.empty() ? "Vulkan" : fmt::format("device '{}'", device);
  switch (result) {
    case vk::Result::eErrorDeviceLost:
      return fmt::format(
          "{}: lost while {}: the driver has reset it, as after a pass that ran too long (run again, or choose another "
          "device, see 'scarp devices')",
          where, what);
    case vk::Result::eErrorOutOfDeviceMemory:
      return fmt::format("{}: out of device memory while {}", where, what);
    case vk::Result::eErrorOutOfHostMemory:
      return fmt::format("{}: out of memory while {}", where, what);
    case vk::Result::eErrorIncompatibleDriver:  // the loader's error code if there is no driver
      return no_driver();
    default:
      return fmt::format("{}: {} while {}", where, vk::to_string(result), what);
  }
}

Device::Impl::Impl(const DeviceSettings& chosen_settings, VulkanInstance opened)
    : settings(chosen_settings),
      instance(std::move(opened)),
      physical(chosen(instance, settings.choice)),
      queue_family(compute_family(physical.getQueueFamilyProperties()).value()),
      memory(physical.getMemoryProperties()),
      device(open(physical, queue_family, (description = describe(physical)).abilities)),
      queue(device, queue_family, 0),
      pool(device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, queue_family}) {
  constexpr double kUsualTimeout = 60, kCpuTimeout = 600;
  timeout_s = settings.timeout_s.value_or(description.kind == DeviceKind::cpu ? kCpuTimeout : kUsualTimeout);
  timestamp_bits = physical.getQueueFamilyProperties()[queue_family].timestampValidBits;
  const vk::PhysicalDeviceProperties properties = physical.getProperties();
  timestamp_period_ns = static_cast<double>(properties.limits.timestampPeriod);
  std::vector<std::byte> kept;
  const std::string folder = settings.keep_pipelines ? user_cache_folder() : "";
  if (!folder.empty()) {
    const PipelineCacheKey key{properties.vendorID, properties.deviceID, properties.driverVersion,
                               properties.pipelineCacheUUID};
    pipelines_path = folder + "/" + pipeline_cache_name(key);
    kept = read_pipeline_cache(pipelines_path, key);
    pipelines_on_file = kept.size();
  }
  try {
    pipelines = vk::raii::PipelineCache(device, vk::PipelineCacheCreateInfo({}, kept.size(), kept.data()));
  } catch (const vk::SystemError&) {
    pipelines_on_file = 0;
    pipelines = vk::raii::PipelineCache(device, vk::PipelineCacheCreateInfo());
  }
}

Device::Impl::~Impl() {
  save_pipelines();
  if (!hangs) return;
  // Drivers wait forever if a device is destroyed while it runs, so the process leaves the device to the system.
  staging.release();
  new auto(std::move(pipelines));
  new auto(std::move(pool));
  new auto(std::move(device));
  new auto(std::move(instance));
}

void Device::Impl::save_pipelines() noexcept {
  if (pipelines_path.empty()) return;
  try {
    const std::vector<std::uint8_t> data = pipelines.getData();
    if (data.size() == pipelines_on_file) return;  // pipelines are only ever added
    write_pipeline_cache(pipelines_path, std::as_bytes(std::span(data)));
  } catch (const std::exception&) {  // device lost, or out of memory
  }
}

void Device::Impl::submit(const vk::raii::CommandBuffer& commands, const vk::raii::Fence& fence) {
  if (!given_up.empty()) throw Error(given_up);
  const vk::CommandBuffer buffer = *commands;
  queue.submit(vk::SubmitInfo().setCommandBuffers(buffer), *fence);
}

void Device::Impl::wait(const vk::raii::Fence& fence, const std::string& what) {
  if (!given_up.empty()) throw Error(given_up);
  const auto limit = static_cast<std::uint64_t>(timeout_s * 1e9);
  if (device.waitForFences(*fence, true, limit) == vk::Result::eTimeout) {
    given_up = fmt::format(
        "device '{}': {} did not finish within {:g} s, and the device was given up (run again, or choose another "
        "device, see 'scarp devices')",
        name(), what, timeout_s);
    throw Error(given_up);
  }
  device.resetFences(*fence);
}

void Device::Impl::wait_at_end(const vk::raii::Fence& fence) noexcept {
  constexpr double kLastSeconds = 5;
  if (hangs) return;
  const double seconds = given_up.empty() ? timeout_s : kLastSeconds;
  try {
    hangs = device.waitForFences(*fence, true, static_cast<std::uint64_t>(seconds * 1e9)) == vk::Result::eTimeout;
  } catch (const vk::SystemError&) {  // device lost: nothing is running
  }
}

std::optional<std::uint32_t> Device::Impl::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const {
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((allowed >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  }
  return std::nullopt;
}

Device::Device(const DeviceSettings& settings) {
  // 10^9 s in nanoseconds fits in the 64 bits of Vulkan's time limits.
  if (settings.timeout_s && !(*settings.timeout_s > 0 && *settings.timeout_s <= 1e9)) {
    throw Error(fmt::format("device: timeout of {} s (must be above 0, at most 1e9)", *settings.timeout_s));
  }
  VulkanInstance instance(settings.validation);
  guarded("", "opening device '" + settings.choice + "'",
          [&] { impl_ = std::make_shared<Impl>(settings, std::move(instance)); });
}

const DeviceDescription& Device::description() const { return impl_->description; }

std::vector<std::string> Device::validation_messages() const { return impl_->instance.messages(); }

void full_barrier(const vk::raii::CommandBuffer& commands) {
  using Access = vk::AccessFlagBits;
  const auto stages = vk::PipelineStageFlagBits::eAllCommands;
  const vk::MemoryBarrier barrier(Access::eMemoryWrite, Access::eMemoryRead | Access::eMemoryWrite);
  commands.pipelineBarrier(stages, stages, {}, barrier, {}, {});
}

}  // namespace scarp
