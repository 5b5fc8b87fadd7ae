// SPDX-License-Identifier: MIT
#include "app/viewer/swapchain.h"

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr std::uint64_t kForever = ~std::uint64_t{0};
constexpr int kAttempts = 5;  // attempts to get an image of a window that is changing

}  // namespace

Swapchain::~Swapchain() {
  if (!device_.device) return;
  destroy_targets();
  destroy_swapchain();
  vkDestroySemaphore(device_.device, acquired_, nullptr);
  vkDestroyRenderPass(device_.device, pass_, nullptr);
}

void Swapchain::open() {
  const auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  require(vkCreateSemaphore(device_.device, &semaphore, nullptr, &acquired_), "making a semaphore");
  choose_format();
  make_pass();
  fit();
}

const Swapchain::Target* Swapchain::acquire() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    int across = 0, down = 0;
    glfwGetFramebufferSize(device_.window, &across, &down);
    const bool outgrown =
        static_cast<std::uint32_t>(across) != extent_.width || static_cast<std::uint32_t>(down) != extent_.height;
    if ((outgrown || targets_.empty()) && !fit()) return nullptr;
    const VkResult got =
        vkAcquireNextImageKHR(device_.device, swapchain_, kForever, acquired_, VK_NULL_HANDLE, &index_);
    if (got == VK_SUCCESS || got == VK_SUBOPTIMAL_KHR) return &targets_[index_];
    surface_lost_ |= got == VK_ERROR_SURFACE_LOST_KHR;
    if (got != VK_ERROR_OUT_OF_DATE_KHR && got != VK_ERROR_SURFACE_LOST_KHR)
      require(got, "asking for an image of the window");
    destroy_targets();
  }
  return nullptr;
}

void Swapchain::present() {
  auto info = of_type<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
  info.waitSemaphoreCount = info.swapchainCount = 1;
  info.pWaitSemaphores = &targets_[index_].rendered;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index_;
  const VkResult shown = vkQueuePresentKHR(device_.queue, &info);
  surface_lost_ |= shown == VK_ERROR_SURFACE_LOST_KHR;
  if (shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR || shown == VK_ERROR_SURFACE_LOST_KHR) {
    vkDeviceWaitIdle(device_.device);
    destroy_targets();
  } else {
    require(shown, "presenting");
  }
}

// Chooses a format without conversion: bytes of pictures are already sRGB.
void Swapchain::choose_format() {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical, device_.surface, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical, device_.surface, &count, formats.data());
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    for (const VkSurfaceFormatKHR& one : formats) {
      if (one.format == wanted) {
        format_ = one;
        return;
      }
    }
  }
  throw Error("window: the device shows no pictures of 8 bits");
}

// ImGui draws over the picture.
void Swapchain::make_pass() {
  VkAttachmentDescription attachment{};
  attachment.format = format_.format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &colour;
  auto info = of_type<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  require(vkCreateRenderPass(device_.device, &info, nullptr, &pass_), "making a render pass");
}

// Creates images of the window's size. Returns false if the window has no area.
bool Swapchain::fit() {
  vkDeviceWaitIdle(device_.device);
  destroy_targets();
  for (int attempt = 0;; ++attempt) {
    if (surface_lost_) {
      destroy_swapchain();
      device_.reopen_surface();
      surface_lost_ = false;
    }
    const VkResult made = make();
    surface_lost_ = made == VK_ERROR_SURFACE_LOST_KHR;
    if (surface_lost_ && attempt < kAttempts) continue;
    require(made, "making the window's images");
    if (extent_.width == 0 || extent_.height == 0) return false;
    make_targets();
    return true;
  }
}

// Creates the swapchain, unless the window has no area.
VkResult Swapchain::make() {
  VkSurfaceCapabilitiesKHR can;
  const VkResult asked = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical, device_.surface, &can);
  if (asked != VK_SUCCESS) return asked;
  int across = 0, down = 0;
  glfwGetFramebufferSize(device_.window, &across, &down);
  extent_ = can.currentExtent;
  if (extent_.width == ~std::uint32_t{0}) {
    extent_.width =
        std::clamp(static_cast<std::uint32_t>(std::max(across, 0)), can.minImageExtent.width, can.maxImageExtent.width);
    extent_.height =
        std::clamp(static_cast<std::uint32_t>(std::max(down, 0)), can.minImageExtent.height, can.maxImageExtent.height);
  }
  if (extent_.width == 0 || extent_.height == 0) return VK_SUCCESS;
  auto info = of_type<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
  info.surface = device_.surface;
  info.minImageCount =
      std::clamp(2u, can.minImageCount, can.maxImageCount == 0 ? std::max(2u, can.minImageCount) : can.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(device_.device, &info, nullptr, &made);
  // The old swapchain is retired even if creating the new one fails.
  destroy_swapchain();
  swapchain_ = made;
  return result;
}

void Swapchain::make_targets() {
  std::uint32_t count = 0;
  vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, nullptr);
  std::vector<VkImage> images(count);
  vkGetSwapchainImagesKHR(device_.device, swapchain_, &count, images.data());
  for (const VkImage image : images) {
    Target target{image, VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE};
    auto view = of_type<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    require(vkCreateImageView(device_.device, &view, nullptr, &target.view), "viewing the window's images");
    auto framebuffer = of_type<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    framebuffer.renderPass = pass_;
    framebuffer.attachmentCount = 1;
    framebuffer.pAttachments = &target.view;
    framebuffer.width = extent_.width;
    framebuffer.height = extent_.height;
    framebuffer.layers = 1;
    require(vkCreateFramebuffer(device_.device, &framebuffer, nullptr, &target.framebuffer), "making a frame buffer");
    auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    require(vkCreateSemaphore(device_.device, &semaphore, nullptr, &target.rendered), "making a semaphore");
    targets_.push_back(target);
  }
}

void Swapchain::destroy_targets() {
  for (const Target& target : targets_) {
    vkDestroyFramebuffer(device_.device, target.framebuffer, nullptr);
    vkDestroyImageView(device_.device, target.view, nullptr);
    vkDestroySemaphore(device_.device, target.rendered, nullptr);
  }
  targets_.clear();
}

void Swapchain::destroy_swapchain() {
  if (swapchain_) vkDestroySwapchainKHR(device_.device, swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
}

}  // namespace scarp::viewer
