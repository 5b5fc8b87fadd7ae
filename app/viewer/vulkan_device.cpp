// SPDX-License-Identifier: MIT
#include "app/viewer/vulkan_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL note_objection(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* count) {
  ++*static_cast<int*>(count);
  fmt::print(stderr, "validation: {}\n", data->pMessage);
  return VK_FALSE;
}

bool contains(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

}  // namespace

void require(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  if (result == VK_ERROR_DEVICE_LOST) throw Error("window: the device was lost (did its driver restart?)");
  throw Error(fmt::format("window: {} failed (Vulkan error {})", what, static_cast<int>(result)));
}

VulkanDevice::~VulkanDevice() {
  if (device) vkDestroyDevice(device, nullptr);
  if (surface) vkDestroySurfaceKHR(instance, surface, nullptr);
  if (messenger_) {
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy_messenger(instance, messenger_, nullptr);
  }
  if (instance) vkDestroyInstance(instance, nullptr);
}

void VulkanDevice::open(const std::string& choice, bool validation) {
  make_instance(validation);
  require(glfwCreateWindowSurface(instance, window, nullptr, &surface), "opening the surface");
  choose_device(choice);
  make_device();
}

void VulkanDevice::reopen_surface() {
  vkDestroySurfaceKHR(instance, surface, nullptr);
  surface = VK_NULL_HANDLE;
  require(glfwCreateWindowSurface(instance, window, nullptr, &surface), "opening the surface again");
  VkBool32 presents = VK_FALSE;
  require(vkGetPhysicalDeviceSurfaceSupportKHR(physical, family, surface, &presents), "asking the surface");
  if (!presents) throw Error("window: the device no longer shows pictures here");
}

void VulkanDevice::make_instance(bool validation) {
  if (!glfwVulkanSupported())
    throw Error("window: there is no Vulkan loader or driver (Debian: libvulkan1 and mesa-vulkan-drivers)");
  std::uint32_t count = 0;
  const char** required = glfwGetRequiredInstanceExtensions(&count);
  std::vector<const char*> extensions(required, required + count);
  if (validation) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  auto about = of_type<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  about.pApplicationName = "scarp-view";
  about.apiVersion = VK_API_VERSION_1_1;
  auto info = of_type<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &about;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  if (validation) info.enabledLayerCount = 1, info.ppEnabledLayerNames = &kLayer;
  const VkResult made = vkCreateInstance(&info, nullptr, &instance);
  if (made == VK_ERROR_LAYER_NOT_PRESENT)
    throw Error("--validation: there is no validation layer (Debian: vulkan-validationlayers)");
  require(made, "opening Vulkan");
  if (!validation) return;
  auto listen = of_type<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  listen.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  listen.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  listen.pfnUserCallback = note_objection;
  listen.pUserData = &objections;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  require(create(instance, &listen, nullptr, &messenger_), "listening to the validation layer");
}

// Finds the first queue family that can draw and present to the surface.
bool VulkanDevice::find_family(VkPhysicalDevice of, std::uint32_t& found) const {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(of, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(of, &count, families.data());
  for (found = 0; found < count; ++found) {
    VkBool32 presents = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(of, found, surface, &presents);
    if (presents && (families[found].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) return true;
  }
  return false;
}

void VulkanDevice::choose_device(const std::string& choice) {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> all(count);
  vkEnumeratePhysicalDevices(instance, &count, all.data());
  std::string names;
  for (const VkPhysicalDevice one : all) {
    VkPhysicalDeviceProperties about;
    vkGetPhysicalDeviceProperties(one, &about);
    names += (names.empty() ? "" : ", ") + std::string(about.deviceName);
    std::uint32_t found;
    if ((choice != "auto" && !contains(about.deviceName, choice)) || !find_family(one, found)) continue;
    // CPU devices are used only if there is no other.
    if (physical &&
        (about.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU || properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU))
      continue;
    physical = one, properties = about, family = found;
  }
  if (!physical) {
    throw Error(all.empty() ? std::string("window: Vulkan has no device (Debian: mesa-vulkan-drivers)")
                            : fmt::format("--window-device '{}': no such device shows pictures here (there is: {})",
                                          choice, names));
  }
}

void VulkanDevice::make_device() {
  const float priority = 1;
  auto queues = of_type<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queues.queueFamilyIndex = family;
  queues.queueCount = 1;
  queues.pQueuePriorities = &priority;
  const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  auto info = of_type<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queues;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  require(vkCreateDevice(physical, &info, nullptr, &device), "opening the device");
  vkGetDeviceQueue(device, family, 0, &queue);
}

std::uint32_t VulkanDevice::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties types;
  vkGetPhysicalDeviceMemoryProperties(physical, &types);
  for (std::uint32_t i = 0; i < types.memoryTypeCount; ++i) {
    if ((allowed >> i & 1) != 0 && (types.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  throw Error("window: the device has no memory of the needed kind");
}
void VulkanDevice::allocate(DeviceMemory& of, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const {
  auto info = of_type<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.allocationSize = needs.size;
  info.memoryTypeIndex = memory_type(needs.memoryTypeBits, wanted);
  require(vkAllocateMemory(device, &info, nullptr, &of.memory), "allocating memory");
}
void VulkanDevice::destroy(DeviceMemory& of) const {
  if (of.buffer) vkDestroyBuffer(device, of.buffer, nullptr);
  if (of.image) vkDestroyImage(device, of.image, nullptr);
  if (of.memory) vkFreeMemory(device, of.memory, nullptr);
  of = {};
}
void VulkanDevice::make_buffer(DeviceMemory& of, VkDeviceSize bytes, VkBufferUsageFlags usage) const {
  destroy(of);
  auto info = of_type<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = bytes;
  info.usage = usage;
  require(vkCreateBuffer(device, &info, nullptr, &of.buffer), "making a buffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, of.buffer, &needs);
  allocate(of, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  require(vkBindBufferMemory(device, of.buffer, of.memory, 0), "binding memory");
  require(vkMapMemory(device, of.memory, 0, VK_WHOLE_SIZE, 0, &of.mapped), "mapping memory");
}
void VulkanDevice::make_image(DeviceMemory& of, std::uint32_t width, std::uint32_t height) const {
  destroy(of);
  auto info = of_type<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {width, height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  require(vkCreateImage(device, &info, nullptr, &of.image), "making a texture");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, of.image, &needs);
  allocate(of, needs, 0);
  require(vkBindImageMemory(device, of.image, of.memory, 0), "binding memory");
}

}  // namespace scarp::viewer
