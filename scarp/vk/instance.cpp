// SPDX-License-Identifier: MIT
// The Vulkan loader, an instance, and messages of the validation layer.
#include <array>
#include <cstdlib>

#include "scarp/vk/raii.h"

namespace scarp {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::array<const char*, 2> kValidationExtensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                                              VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};

bool has_validation_layer(const vk::raii::Context& context) {
  const auto layers = context.enumerateInstanceLayerProperties();
  return std::any_of(layers.begin(), layers.end(),
                     [](const auto& layer) { return std::string_view(layer.layerName.data()) == kValidationLayer; });
}

// Environment variables that replace the loader's search path for drivers.
std::string where_drivers_are_sought() {
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    if (const char* value = std::getenv(name)) return std::string(" (search path: ") + name + "=" + value + ")";
  }
  return {};
}

}  // namespace

std::string no_driver() {
  const std::string sought = where_drivers_are_sought();
  if (!sought.empty()) return "Vulkan: no driver found" + sought;
  return "Vulkan: no driver installed (install one; on Debian, mesa-vulkan-drivers runs on any CPU)";
}

VkBool32 VKAPI_PTR VulkanInstance::collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
  auto& all = *static_cast<Messages*>(messages);
  const std::scoped_lock lock(all.mutex);
  all.texts.emplace_back(data->pMessage);
  return VK_FALSE;
}

VulkanInstance::VulkanInstance(bool validation) : messages_(std::make_unique<Messages>()) {
  try {
    context_.emplace();
  } catch (const std::runtime_error&) {
    throw Error("Vulkan: no loader, cannot open libvulkan.so.1 (on Debian, install libvulkan1)");
  }
  const auto open = [&] {
    const vk::ApplicationInfo application("scarp", 0, "scarp", 0, VK_API_VERSION_1_2);
    vk::InstanceCreateInfo create({}, &application);
    if (!validation) {
      instance_.emplace(*context_, create);
      return;
    }
    if (!has_validation_layer(*context_)) {
      throw Error(std::string("Vulkan: layer ") + kValidationLayer +
                  " is not installed (on Debian, install vulkan-validationlayers)");
    }
    const auto synchronisation = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT features(synchronisation);
    create.setPNext(&features).setPEnabledLayerNames(kValidationLayer).setPEnabledExtensionNames(kValidationExtensions);
    instance_.emplace(*context_, create);
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    messenger_.emplace(*instance_, vk::DebugUtilsMessengerCreateInfoEXT({}, Severity::eWarning | Severity::eError,
                                                                        Type::eValidation | Type::ePerformance, collect,
                                                                        messages_.get()));
  };
  guarded("", "opening it", [&] {
    try {
      open();
    } catch (const vk::OutOfHostMemoryError&) {
      throw Error("Vulkan: the loader is out of memory, or a driver manifest (.json) is damaged" +
                  where_drivers_are_sought());
    }
  });
}

std::vector<vk::raii::PhysicalDevice> VulkanInstance::physical_devices() const {
  return guarded("", "listing devices", [&]() -> std::vector<vk::raii::PhysicalDevice> {
    try {
      return vk::raii::PhysicalDevices(*instance_);
    } catch (const vk::InitializationFailedError&) {
      return {};  // the loader's error code if there is no driver
    }
  });
}

std::vector<std::string> VulkanInstance::messages() const {
  const std::scoped_lock lock(messages_->mutex);
  return messages_->texts;
}

}  // namespace scarp
