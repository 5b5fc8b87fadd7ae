// SPDX-License-Identifier: MIT
// The images of a window. They follow its size and survive the loss of its surface.
#pragma once

#include <cstdint>
#include <vector>

#include "app/viewer/vulkan_device.h"

namespace scarp::viewer {

class Swapchain {
 public:
  /// An image of the window.
  struct Target {
    VkImage image;
    VkImageView view;
    VkFramebuffer framebuffer;
    VkSemaphore rendered;  ///< signalled by the commands that draw into it
  };

  explicit Swapchain(VulkanDevice& of) : device_(of) {}
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  void open();
  /// The image to draw into, once acquired() is signalled. Null if there is none: the window has no area, or its size
  /// changes faster than images can be created. Throws Error if the device is lost.
  const Target* acquire();
  /// Presents the image that acquire() returned last. Throws Error if the device is lost.
  void present();

  VkFormat format() const { return format_.format; }
  VkExtent2D extent() const { return extent_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(targets_.size()); }
  /// Draws over the contents of the image.
  VkRenderPass pass() const { return pass_; }
  const VkSemaphore& acquired() const { return acquired_; }

 private:
  void choose_format();
  void make_pass();
  bool fit();
  VkResult make();
  void make_targets();
  void destroy_targets();
  void destroy_swapchain();

  VulkanDevice& device_;
  VkSurfaceFormatKHR format_{};
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::vector<Target> targets_;
  std::uint32_t index_ = 0;
  bool surface_lost_ = false;
};

}  // namespace scarp::viewer
