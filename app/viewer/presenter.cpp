// SPDX-License-Identifier: MIT
#include "app/viewer/presenter.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "app/viewer/swapchain.h"
#include "app/viewer/vulkan_device.h"
#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr std::uint64_t kForever = ~std::uint64_t{0};

void require_imgui(VkResult result) { require(result, "drawing the panels"); }

}  // namespace

struct Presenter::Impl {
  VulkanDevice vulkan;
  Swapchain swapchain{vulkan};
  VkDevice device = VK_NULL_HANDLE;
  VkDescriptorPool descriptors = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkFence done = VK_NULL_HANDLE;
  DeviceMemory texture, staging, readback;
  int width = 0, height = 0;  // size of the texture
  int left = 0;               // column at which the picture starts
  bool uploads = false;       // the texture must be filled from the staging buffer
  bool has_imgui = false;

  explicit Impl(GLFWwindow* window) : vulkan(window) {}

  ~Impl() {
    if (!device) return;
    vkDeviceWaitIdle(device);
    if (has_imgui) ImGui_ImplVulkan_Shutdown();
    for (DeviceMemory* memory : {&texture, &staging, &readback}) vulkan.destroy(*memory);
    vkDestroyFence(device, done, nullptr);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyDescriptorPool(device, descriptors, nullptr);
  }

  void open(const std::string& choice, bool validation) {
    vulkan.open(choice, validation);
    device = vulkan.device;
    swapchain.open();
    auto pools = of_type<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pools.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pools.queueFamilyIndex = vulkan.family;
    require(vkCreateCommandPool(device, &pools, nullptr, &pool), "making commands");
    auto buffers = of_type<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    buffers.commandPool = pool;
    buffers.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffers.commandBufferCount = 1;
    require(vkAllocateCommandBuffers(device, &buffers, &commands), "making commands");
    auto fence = of_type<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    require(vkCreateFence(device, &fence, nullptr, &done), "making a fence");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    auto pool_info = of_type<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool_info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool_info.maxSets = 8;
    pool_info.poolSizeCount = 1;
    pool_info.pPoolSizes = &size;
    require(vkCreateDescriptorPool(device, &pool_info, nullptr, &descriptors), "making descriptors");
    make_imgui();
  }

  void make_texture(int across, int down) {
    vulkan.make_image(texture, static_cast<std::uint32_t>(across), static_cast<std::uint32_t>(down));
    vulkan.make_buffer(staging, VkDeviceSize{4} * static_cast<VkDeviceSize>(across) * static_cast<VkDeviceSize>(down),
                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    width = across, height = down;
  }

  void barrier(VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags before, VkAccessFlags after) const {
    auto change = of_type<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    change.srcAccessMask = before;
    change.dstAccessMask = after;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &change);
  }

  void begin() {
    require(vkResetFences(device, 1, &done), "resetting a fence");
    auto info = of_type<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands, &info), "recording commands");
  }
  void wait() { require(vkWaitForFences(device, 1, &done, VK_TRUE, kForever), "waiting for the device"); }

  void make_imgui() {
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = vulkan.instance;
    info.PhysicalDevice = vulkan.physical;
    info.Device = device;
    info.QueueFamily = vulkan.family;
    info.Queue = vulkan.queue;
    info.DescriptorPool = descriptors;
    info.MinImageCount = 2;
    info.ImageCount = std::max<std::uint32_t>(2, swapchain.size());
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = require_imgui;
    if (!ImGui_ImplVulkan_Init(&info, swapchain.pass())) throw Error("window: Dear ImGui does not start");
    has_imgui = true;
    wait();
    begin();
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    require(vkEndCommandBuffer(commands), "recording commands");
    auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    require(vkQueueSubmit(vulkan.queue, 1, &submit, done), "uploading the font");
    wait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
  }

  void clear(VkImage target, const VkClearColorValue& colour) const {
    const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &colour, 1, &whole);
  }

  void draw_picture(VkImage target) {
    const VkExtent2D extent = swapchain.extent();
    constexpr VkImageLayout kUndefined = VK_IMAGE_LAYOUT_UNDEFINED, kTo = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            kFrom = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    if (uploads) {
      barrier(texture.image, kUndefined, kTo, 0, VK_ACCESS_TRANSFER_WRITE_BIT);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1};
      vkCmdCopyBufferToImage(commands, staging.buffer, texture.image, kTo, 1, &copy);
      barrier(texture.image, kTo, kFrom, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT);
      uploads = false;
    }
    barrier(target, kUndefined, kTo, 0, VK_ACCESS_TRANSFER_WRITE_BIT);
    const std::int32_t across = static_cast<std::int32_t>(extent.width),
                       down = static_cast<std::int32_t>(extent.height);
    // Wider than the window for a moment, while its size changes.
    const std::int32_t from = std::min(left, across - 1);
    if (texture.image && from > 0) {
      constexpr VkClearColorValue kBlack{{0.0f, 0.0f, 0.0f, 1.0f}};
      clear(target, kBlack);
      barrier(target, kTo, kTo, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    }
    if (texture.image) {
      VkImageBlit blit{};
      blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      blit.srcOffsets[1] = {width, height, 1};
      blit.dstOffsets[0] = {from, 0, 0};
      blit.dstOffsets[1] = {across, down, 1};
      const bool same = width == across - from && height == down;
      vkCmdBlitImage(commands, texture.image, kFrom, target, kTo, 1, &blit,
                     same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    } else {
      constexpr VkClearColorValue kGrey{{0.2f, 0.2f, 0.2f, 1.0f}};
      clear(target, kGrey);
    }
    barrier(target, kTo, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
  }

  void draw_panels(const Swapchain::Target& target) {
    auto info = of_type<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = swapchain.pass();
    info.framebuffer = target.framebuffer;
    info.renderArea.extent = swapchain.extent();
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
    vkCmdEndRenderPass(commands);
  }

  void read_back(VkImage target) {
    const VkExtent2D extent = swapchain.extent();
    barrier(target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    vulkan.make_buffer(readback, VkDeviceSize{4} * extent.width * extent.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback.buffer, 1, &copy);
    barrier(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_ACCESS_TRANSFER_READ_BIT,
            0);
  }
  Image read() const {
    const VkExtent2D extent = swapchain.extent();
    Image image(static_cast<int>(extent.width), static_cast<int>(extent.height));
    const auto* from = static_cast<const std::uint8_t*>(readback.mapped);
    const bool blue_first = swapchain.format() == VK_FORMAT_B8G8R8A8_UNORM;
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) image.rgb[3 * i + k] = from[4 * i + (blue_first ? 2 - k : k)];
    }
    return image;
  }
};

Presenter::Presenter(GLFWwindow* window, const std::string& device, bool validation)
    : impl_(std::make_unique<Impl>(window)) {
  impl_->open(device, validation);
}

Presenter::~Presenter() = default;

std::string Presenter::device_name() const { return impl_->vulkan.properties.deviceName; }
int Presenter::objections() const { return impl_->vulkan.objections; }

void Presenter::set_image(const Image& image) {
  Impl& all = *impl_;
  all.wait();
  if (all.width != image.width || all.height != image.height) all.make_texture(image.width, image.height);
  auto* to = static_cast<std::uint8_t*>(all.staging.mapped);
  for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
    std::memcpy(to + 4 * i, image.rgb.data() + 3 * i, 3);
    to[4 * i + 3] = 255;
  }
  all.uploads = true;
}

void Presenter::set_left(int column) { impl_->left = column; }

void Presenter::begin_frame() { ImGui_ImplVulkan_NewFrame(); }

bool Presenter::present(Image* seen) {
  Impl& all = *impl_;
  all.wait();
  const Swapchain::Target* const acquired = all.swapchain.acquire();
  if (!acquired) return false;
  const Swapchain::Target& target = *acquired;
  all.begin();
  all.draw_picture(target.image);
  all.draw_panels(target);
  if (seen) {
    all.read_back(target.image);
  } else {
    all.barrier(target.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, 0);
  }
  require(vkEndCommandBuffer(all.commands), "recording commands");
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.waitSemaphoreCount = submit.signalSemaphoreCount = submit.commandBufferCount = 1;
  submit.pWaitSemaphores = &all.swapchain.acquired();
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &all.commands;
  submit.pSignalSemaphores = &target.rendered;
  require(vkQueueSubmit(all.vulkan.queue, 1, &submit, all.done), "drawing");
  if (seen) {
    all.wait();
    *seen = all.read();
  }
  all.swapchain.present();
  return true;
}

}  // namespace scarp::viewer
