// SPDX-License-Identifier: MIT
#include "app/viewer/presenter.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <string_view>
#include <vector>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint64_t kForever = ~std::uint64_t{0};

template <class T>
T of_type(VkStructureType type) {
  T structure{};
  structure.sType = type;
  return structure;
}

void require(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  if (result == VK_ERROR_DEVICE_LOST) throw Error("window: the device was lost (did its driver restart?)");
  throw Error(fmt::format("window: {} failed (Vulkan error {})", what, static_cast<int>(result)));
}
void require_imgui(VkResult result) { require(result, "drawing the panels"); }

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

struct Presenter::Impl {
  // A buffer or an image with its memory.
  struct Memory {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* mapped = nullptr;
  };

  GLFWwindow* window;
  int objections = 0;
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  VkQueue queue = VK_NULL_HANDLE;
  VkDescriptorPool descriptors = VK_NULL_HANDLE;
  VkRenderPass pass = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkFence done = VK_NULL_HANDLE;
  VkSemaphore acquired = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format{};
  VkSwapchainKHR swapchain = VK_NULL_HANDLE;
  VkExtent2D extent{};
  struct Target {
    VkImage image;
    VkImageView view;
    VkFramebuffer framebuffer;
    VkSemaphore rendered;
  };
  std::vector<Target> targets;
  Memory texture, staging, readback;
  int width = 0, height = 0;  // of the texture
  std::vector<std::uint8_t> rgba;
  bool uploads = false;  // the texture is to be filled from the staging buffer
  bool has_imgui = false;

  explicit Impl(GLFWwindow* of) : window(of) {}

  ~Impl() {
    if (device) vkDeviceWaitIdle(device);
    if (has_imgui) ImGui_ImplVulkan_Shutdown();
    if (device) {
      destroy_targets();
      if (swapchain) vkDestroySwapchainKHR(device, swapchain, nullptr);
      for (Memory* memory : {&texture, &staging, &readback}) destroy(*memory);
      vkDestroySemaphore(device, acquired, nullptr);
      vkDestroyFence(device, done, nullptr);
      vkDestroyCommandPool(device, pool, nullptr);
      vkDestroyRenderPass(device, pass, nullptr);
      vkDestroyDescriptorPool(device, descriptors, nullptr);
      vkDestroyDevice(device, nullptr);
    }
    if (surface) vkDestroySurfaceKHR(instance, surface, nullptr);
    if (messenger) {
      const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
          vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
      destroy_messenger(instance, messenger, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
  }

  void make_instance(bool validation) {
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
    require(create(instance, &listen, nullptr, &messenger), "listening to the validation layer");
  }

  // The first queue family that draws and presents here.
  bool find_family(VkPhysicalDevice of, std::uint32_t& found) const {
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

  void choose_device(const std::string& choice) {
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
      // CPU devices only where there is no other.
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

  void make_device() {
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
    auto pools = of_type<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pools.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pools.queueFamilyIndex = family;
    require(vkCreateCommandPool(device, &pools, nullptr, &pool), "making commands");
    auto buffers = of_type<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    buffers.commandPool = pool;
    buffers.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffers.commandBufferCount = 1;
    require(vkAllocateCommandBuffers(device, &buffers, &commands), "making commands");
    auto fence = of_type<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    require(vkCreateFence(device, &fence, nullptr, &done), "making a fence");
    auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    require(vkCreateSemaphore(device, &semaphore, nullptr, &acquired), "making a semaphore");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    auto pool_info = of_type<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool_info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool_info.maxSets = 8;
    pool_info.poolSizeCount = 1;
    pool_info.pPoolSizes = &size;
    require(vkCreateDescriptorPool(device, &pool_info, nullptr, &descriptors), "making descriptors");
  }

  // Bytes of pictures are sRGB already: a format that does not convert.
  void choose_format() {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data());
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
      for (const VkSurfaceFormatKHR& one : formats) {
        if (one.format == wanted) {
          format = one;
          return;
        }
      }
    }
    throw Error("window: the device shows no pictures of 8 bits");
  }

  // ImGui draws over the picture.
  void make_pass() {
    VkAttachmentDescription attachment{};
    attachment.format = format.format;
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
    require(vkCreateRenderPass(device, &info, nullptr, &pass), "making a render pass");
  }

  void destroy_targets() {
    for (const Target& target : targets) {
      vkDestroyFramebuffer(device, target.framebuffer, nullptr);
      vkDestroyImageView(device, target.view, nullptr);
      vkDestroySemaphore(device, target.rendered, nullptr);
    }
    targets.clear();
  }

  // Returns false if the window has no area.
  bool make_swapchain() {
    vkDeviceWaitIdle(device);
    VkSurfaceCapabilitiesKHR can;
    const VkResult asked = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface, &can);
    if (asked == VK_ERROR_SURFACE_LOST_KHR) {
      vkDestroySwapchainKHR(device, swapchain, nullptr);
      swapchain = VK_NULL_HANDLE;
      vkDestroySurfaceKHR(instance, surface, nullptr);
      surface = VK_NULL_HANDLE;
      require(glfwCreateWindowSurface(instance, window, nullptr, &surface), "opening the surface again");
      require(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface, &can), "asking the surface");
    } else {
      require(asked, "asking the surface");
    }
    int pixels_x = 0, pixels_y = 0;
    glfwGetFramebufferSize(window, &pixels_x, &pixels_y);
    extent = can.currentExtent;
    if (extent.width == ~std::uint32_t{0}) {
      extent.width = std::clamp(static_cast<std::uint32_t>(std::max(pixels_x, 0)), can.minImageExtent.width,
                                can.maxImageExtent.width);
      extent.height = std::clamp(static_cast<std::uint32_t>(std::max(pixels_y, 0)), can.minImageExtent.height,
                                 can.maxImageExtent.height);
    }
    destroy_targets();
    if (extent.width == 0 || extent.height == 0) return false;
    auto info = of_type<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface;
    info.minImageCount =
        std::clamp(2u, can.minImageCount, can.maxImageCount == 0 ? std::max(2u, can.minImageCount) : can.maxImageCount);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    require(vkCreateSwapchainKHR(device, &info, nullptr, &made), "making the window's images");
    if (swapchain) vkDestroySwapchainKHR(device, swapchain, nullptr);
    swapchain = made;
    std::uint32_t count = 0;
    vkGetSwapchainImagesKHR(device, swapchain, &count, nullptr);
    std::vector<VkImage> images(count);
    vkGetSwapchainImagesKHR(device, swapchain, &count, images.data());
    for (const VkImage image : images) {
      Target target{image, VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE};
      auto view = of_type<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
      view.image = image;
      view.viewType = VK_IMAGE_VIEW_TYPE_2D;
      view.format = format.format;
      view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      require(vkCreateImageView(device, &view, nullptr, &target.view), "viewing the window's images");
      auto framebuffer = of_type<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
      framebuffer.renderPass = pass;
      framebuffer.attachmentCount = 1;
      framebuffer.pAttachments = &target.view;
      framebuffer.width = extent.width;
      framebuffer.height = extent.height;
      framebuffer.layers = 1;
      require(vkCreateFramebuffer(device, &framebuffer, nullptr, &target.framebuffer), "making a frame buffer");
      auto semaphore = of_type<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
      require(vkCreateSemaphore(device, &semaphore, nullptr, &target.rendered), "making a semaphore");
      targets.push_back(target);
    }
    return true;
  }

  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    for (std::uint32_t i = 0; i < types.memoryTypeCount; ++i) {
      if ((allowed >> i & 1) != 0 && (types.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    throw Error("window: the device has no memory of the needed kind");
  }
  void allocate(Memory& of, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    auto info = of_type<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = needs.size;
    info.memoryTypeIndex = memory_type(needs.memoryTypeBits, wanted);
    require(vkAllocateMemory(device, &info, nullptr, &of.memory), "allocating memory");
  }
  void destroy(Memory& of) {
    if (of.buffer) vkDestroyBuffer(device, of.buffer, nullptr);
    if (of.image) vkDestroyImage(device, of.image, nullptr);
    if (of.memory) vkFreeMemory(device, of.memory, nullptr);
    of = {};
  }
  void make_buffer(Memory& of, VkDeviceSize bytes, VkBufferUsageFlags usage) {
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
  void make_texture(int across, int down) {
    destroy(texture);
    auto info = of_type<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.extent = {static_cast<std::uint32_t>(across), static_cast<std::uint32_t>(down), 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    require(vkCreateImage(device, &info, nullptr, &texture.image), "making a texture");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, texture.image, &needs);
    allocate(texture, needs, 0);
    require(vkBindImageMemory(device, texture.image, texture.memory, 0), "binding memory");
    make_buffer(staging, VkDeviceSize{4} * static_cast<VkDeviceSize>(across) * static_cast<VkDeviceSize>(down),
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
    info.Instance = instance;
    info.PhysicalDevice = physical;
    info.Device = device;
    info.QueueFamily = family;
    info.Queue = queue;
    info.DescriptorPool = descriptors;
    info.MinImageCount = 2;
    info.ImageCount = std::max<std::uint32_t>(2, static_cast<std::uint32_t>(targets.size()));
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = require_imgui;
    if (!ImGui_ImplVulkan_Init(&info, pass)) throw Error("window: Dear ImGui does not start");
    has_imgui = true;
    wait();
    begin();
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    require(vkEndCommandBuffer(commands), "recording commands");
    auto submit = of_type<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    require(vkQueueSubmit(queue, 1, &submit, done), "uploading the font");
    wait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
  }

  void draw_picture(VkImage target) {
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
    if (texture.image) {
      VkImageBlit blit{};
      blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      blit.srcOffsets[1] = {width, height, 1};
      blit.dstOffsets[1] = {static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height), 1};
      const bool same =
          static_cast<std::uint32_t>(width) == extent.width && static_cast<std::uint32_t>(height) == extent.height;
      vkCmdBlitImage(commands, texture.image, kFrom, target, kTo, 1, &blit,
                     same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    } else {
      constexpr VkClearColorValue kGrey{{0.2f, 0.2f, 0.2f, 1.0f}};
      const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      vkCmdClearColorImage(commands, target, kTo, &kGrey, 1, &whole);
    }
    barrier(target, kTo, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
  }

  void draw_panels(const Target& target) {
    auto info = of_type<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = pass;
    info.framebuffer = target.framebuffer;
    info.renderArea.extent = extent;
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
    vkCmdEndRenderPass(commands);
  }

  void read_back(VkImage target) {
    barrier(target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    make_buffer(readback, VkDeviceSize{4} * extent.width * extent.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback.buffer, 1, &copy);
    barrier(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_ACCESS_TRANSFER_READ_BIT,
            0);
  }
  Image read() const {
    Image image(static_cast<int>(extent.width), static_cast<int>(extent.height));
    const auto* from = static_cast<const std::uint8_t*>(readback.mapped);
    const bool blue_first = format.format == VK_FORMAT_B8G8R8A8_UNORM;
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) image.rgb[3 * i + k] = from[4 * i + (blue_first ? 2 - k : k)];
    }
    return image;
  }
};

Presenter::Presenter(GLFWwindow* window, const std::string& device, bool validation)
    : impl_(std::make_unique<Impl>(window)) {
  Impl& all = *impl_;
  all.make_instance(validation);
  require(glfwCreateWindowSurface(all.instance, window, nullptr, &all.surface), "opening the surface");
  all.choose_device(device);
  all.make_device();
  all.choose_format();
  all.make_pass();
  all.make_swapchain();
  all.make_imgui();
}

Presenter::~Presenter() = default;

std::string Presenter::device_name() const { return impl_->properties.deviceName; }
int Presenter::objections() const { return impl_->objections; }

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

void Presenter::begin_frame() { ImGui_ImplVulkan_NewFrame(); }

bool Presenter::present(Image* seen) {
  Impl& all = *impl_;
  all.wait();
  std::uint32_t index = 0;
  for (int attempt = 0;; ++attempt) {
    int across = 0, down = 0;
    glfwGetFramebufferSize(all.window, &across, &down);
    const bool outgrown =
        static_cast<std::uint32_t>(across) != all.extent.width || static_cast<std::uint32_t>(down) != all.extent.height;
    if ((outgrown || all.targets.empty()) && !all.make_swapchain()) return false;
    const VkResult got =
        vkAcquireNextImageKHR(all.device, all.swapchain, kForever, all.acquired, VK_NULL_HANDLE, &index);
    if (got == VK_SUCCESS || got == VK_SUBOPTIMAL_KHR) break;
    constexpr int kAttempts = 4;
    if ((got != VK_ERROR_OUT_OF_DATE_KHR && got != VK_ERROR_SURFACE_LOST_KHR) ||
        (got == VK_ERROR_SURFACE_LOST_KHR && attempt == kAttempts))
      require(got, "asking for an image of the window");
    all.destroy_targets();
    // The size changes faster than images are made: the next frame will do.
    if (attempt == kAttempts) return false;
  }
  const Impl::Target& target = all.targets[index];
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
  submit.pWaitSemaphores = &all.acquired;
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &all.commands;
  submit.pSignalSemaphores = &target.rendered;
  require(vkQueueSubmit(all.queue, 1, &submit, all.done), "drawing");
  if (seen) {
    all.wait();
    *seen = all.read();
  }
  auto info = of_type<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
  info.waitSemaphoreCount = info.swapchainCount = 1;
  info.pWaitSemaphores = &target.rendered;
  info.pSwapchains = &all.swapchain;
  info.pImageIndices = &index;
  const VkResult shown = vkQueuePresentKHR(all.queue, &info);
  if (shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR || shown == VK_ERROR_SURFACE_LOST_KHR) {
    vkDeviceWaitIdle(all.device);
    all.destroy_targets();
  } else {
    require(shown, "presenting");
  }
  return true;
}

}  // namespace scarp::viewer
