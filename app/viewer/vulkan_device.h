// SPDX-License-Identifier: MIT
// The Vulkan device that shows a window: instance, surface, queue, and memory on it.
#pragma once

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <cstdint>
#include <string>

namespace scarp::viewer {

template <class T>
T of_type(VkStructureType type) {
  T structure{};
  structure.sType = type;
  return structure;
}

/// Throws Error unless `result` is a success: "window: WHAT failed", or that the device was lost.
void require(VkResult result, const char* what);

/// A buffer or an image with its memory.
struct DeviceMemory {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;  ///< address; buffers only
};

class VulkanDevice {
 public:
  explicit VulkanDevice(GLFWwindow* of) : window(of) {}
  ~VulkanDevice();
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  /// `choice`: "auto" or part of a device's name. With `validation`, messages of the validation layer are counted and
  /// printed. Throws Error naming the missing part: loader, driver, device, layer.
  void open(const std::string& choice, bool validation);
  /// Replaces a lost surface. Its swapchain must have been destroyed.
  void reopen_surface();

  /// Replaces `of` by a mapped buffer.
  void make_buffer(DeviceMemory& of, VkDeviceSize bytes, VkBufferUsageFlags usage) const;
  /// Replaces `of` by an image of RGBA bytes that are copied to and from.
  void make_image(DeviceMemory& of, std::uint32_t width, std::uint32_t height) const;
  void destroy(DeviceMemory& of) const;

  GLFWwindow* const window;
  VkInstance instance = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  std::uint32_t family = 0;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  int objections = 0;  ///< messages of the validation layer

 private:
  void make_instance(bool validation);
  bool find_family(VkPhysicalDevice of, std::uint32_t& found) const;
  void choose_device(const std::string& choice);
  void make_device();
  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;
  void allocate(DeviceMemory& of, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const;

  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

}  // namespace scarp::viewer
