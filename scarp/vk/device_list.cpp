// SPDX-License-Identifier: MIT
// Enumerates devices, describes their features and selects one.
#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/file_name.h"
#include "scarp/vk/raii.h"

namespace scarp {
namespace {

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

DeviceKind kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return DeviceKind::discrete_gpu;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return DeviceKind::integrated_gpu;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return DeviceKind::virtual_gpu;
    case vk::PhysicalDeviceType::eCpu:
      return DeviceKind::cpu;
    case vk::PhysicalDeviceType::eOther:
      break;
  }
  return DeviceKind::other;
}

bool fits(const DeviceDescription& device, const std::string& choice) {
  const std::string word = lower_case(choice);
  if (word == "auto") return true;
  if (word == "cpu") return device.kind == DeviceKind::cpu;
  if (word == "gpu") return device.kind != DeviceKind::cpu && device.kind != DeviceKind::other;
  return lower_case(device.name).find(word) != std::string::npos;
}

}  // namespace

std::string_view name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::discrete_gpu:
      return "discrete GPU";
    case DeviceKind::integrated_gpu:
      return "integrated GPU";
    case DeviceKind::virtual_gpu:
      return "virtual GPU";
    case DeviceKind::cpu:
      return "CPU";
    case DeviceKind::other:
      break;
  }
  return "other";
}

std::string missing_ability(const DeviceAbilities& abilities) {
  if (abilities.api_major < 1 || (abilities.api_major == 1 && abilities.api_minor < 2)) {
    return fmt::format("Vulkan 1.2 (it has {}.{})", abilities.api_major, abilities.api_minor);
  }
  if (!abilities.compute_queue) return "a compute queue";
  if (!abilities.scalar_block_layout) return "the feature scalarBlockLayout";
  if (!abilities.buffer_device_address) return "the feature bufferDeviceAddress";
  return {};
}

std::optional<std::uint32_t> compute_family(std::span<const vk::QueueFamilyProperties> families) {
  const auto merits = [&](std::uint32_t i) {
    return (families[i].queueFlags & vk::QueueFlagBits::eGraphics ? 2 : 0) + (families[i].timestampValidBits > 0);
  };
  std::optional<std::uint32_t> best;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
    if (!best || merits(i) > merits(*best)) best = i;
  }
  return best;
}

DeviceDescription describe(const vk::raii::PhysicalDevice& device) {
  DeviceDescription description;
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  description.name = std::string(properties.deviceName.data());
  description.kind = kind_of(properties.deviceType);
  description.driver = fmt::format("driver version {:#x}", properties.driverVersion);
  description.api_version = version_text(properties.apiVersion);
  description.max_storage_range = properties.limits.maxStorageBufferRange;
  description.max_workgroup_invocations = properties.limits.maxComputeWorkGroupInvocations;
  description.shared_memory_bytes = properties.limits.maxComputeSharedMemorySize;
  const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
      description.memory_bytes = std::max<std::uint64_t>(description.memory_bytes, memory.memoryHeaps[i].size);
    }
  }
  DeviceAbilities& abilities = description.abilities;
  abilities.api_major = VK_API_VERSION_MAJOR(properties.apiVersion);
  abilities.api_minor = VK_API_VERSION_MINOR(properties.apiVersion);
  const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
  if (const auto used = compute_family(families)) {
    abilities.compute_queue = true;
    abilities.timestamps = families[*used].timestampValidBits > 0;
    abilities.draws = static_cast<bool>(families[*used].queueFlags & vk::QueueFlagBits::eGraphics);
  }
  // The structs below are unknown to devices before Vulkan 1.2.
  if (abilities.api_major > 1 || abilities.api_minor >= 2) {
    const auto more = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                            vk::PhysicalDeviceVulkan12Properties>();
    const auto& v11 = more.get<vk::PhysicalDeviceVulkan11Properties>();
    const auto& v12 = more.get<vk::PhysicalDeviceVulkan12Properties>();
    description.driver = fmt::format("{} {}", v12.driverName.data(), v12.driverInfo.data());
    description.max_allocation_bytes = v11.maxMemoryAllocationSize;
    description.subgroup_size = v11.subgroupSize;
    const auto features = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    const auto& basic = features.get<vk::PhysicalDeviceFeatures2>().features;
    const auto& newer = features.get<vk::PhysicalDeviceVulkan12Features>();
    abilities.scalar_block_layout = newer.scalarBlockLayout;
    abilities.buffer_device_address = newer.bufferDeviceAddress;
    abilities.float64 = basic.shaderFloat64;
    abilities.int64 = basic.shaderInt64;
  }
  description.missing = missing_ability(abilities);
  return description;
}

DeviceList list_devices() {
  DeviceList list;
  try {
    const VulkanInstance instance(false);
    for (const vk::raii::PhysicalDevice& device : instance.physical_devices()) list.devices.push_back(describe(device));
  } catch (const Error& error) {
    list.why_none = error.what();
    return list;
  }
  if (list.devices.empty()) list.why_none = no_driver();
  return list;
}

std::size_t choose_device(const std::vector<DeviceDescription>& devices, const std::string& choice) {
  std::string names, refusals;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceDescription& device = devices[i];
    names += fmt::format("{}'{}' ({})", names.empty() ? "" : ", ", device.name, name_of(device.kind));
    if (!fits(device, choice)) continue;
    if (!device.usable()) {
      refusals += fmt::format("{}'{}' lacks {}", refusals.empty() ? "" : "; ", device.name, device.missing);
    } else if (!best || device.kind < devices[*best].kind) {
      best = i;
    }
  }
  if (best) return *best;
  if (!refusals.empty()) throw Error(fmt::format("device '{}': {}", choice, refusals));
  throw Error(fmt::format("device '{}': no Vulkan device matches (available: {})", choice, names));
}

}  // namespace scarp
