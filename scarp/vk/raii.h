// SPDX-License-Identifier: MIT
// Private to the station: implementation types in terms of Vulkan-Hpp. Other stations see neither vk:: types nor vk::
// exceptions.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "scarp/base/error.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"
#include "scarp/vk/raster.h"

namespace scarp {

/// Returns the message that no driver was found, and where drivers were searched for.
std::string no_driver();

/// Returns the message for a Vulkan failure during `what`; `device` names the device.
std::string vulkan_failure(vk::Result result, const std::string& device, const std::string& what);

/// Calls `f` and converts exceptions of Vulkan-Hpp to Error.
template <class F>
decltype(auto) guarded(const std::string& device, const std::string& what, F&& f) {
  try {
    return std::forward<F>(f)();
  } catch (const vk::SystemError& error) {
    throw Error(vulkan_failure(static_cast<vk::Result>(error.code().value()), device, what));
  }
}

/// The loader and an instance, with the validation layer if requested.
class VulkanInstance {
 public:
  /// Throws Error if there is no loader or no validation layer.
  explicit VulkanInstance(bool validation);

  std::vector<vk::raii::PhysicalDevice> physical_devices() const;
  std::vector<std::string> messages() const;

 private:
  struct Messages {
    std::mutex mutex;
    std::vector<std::string> texts;
  };
  static VkBool32 VKAPI_PTR collect(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                    VkDebugUtilsMessageTypeFlagsEXT types,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages);

  std::unique_ptr<Messages> messages_;  // the messenger writes to it until destroyed
  std::optional<vk::raii::Context> context_;
  std::optional<vk::raii::Instance> instance_;
  std::optional<vk::raii::DebugUtilsMessengerEXT> messenger_;
};

/// Returns the queue family for all work: the first that supports compute; prefers families with graphics, then with
/// timestamps.
std::optional<std::uint32_t> compute_family(std::span<const vk::QueueFamilyProperties> families);

DeviceDescription describe(const vk::raii::PhysicalDevice& device);

class StagingRing;

struct Device::Impl {
  Impl(const DeviceSettings& settings, VulkanInstance instance);
  ~Impl();

  /// Throws Error if the device has been given up.
  void submit(const vk::raii::CommandBuffer& commands, const vk::raii::Fence& fence);
  /// Waits for the fence and resets it. After the time limit, gives the device up and throws Error, as does every later
  /// call.
  void wait(const vk::raii::Fence& fence, const std::string& what);
  /// Waits for the fence before its resources are destroyed; at most a few seconds on a device that was given up.
  void wait_at_end(const vk::raii::Fence& fence) noexcept;
  const std::string& name() const { return description.name; }
  /// Returns the first memory type for a buffer that has all `flags`.
  std::optional<std::uint32_t> memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const;
  /// Writes the pipelines to the user's cache folder if there are new ones.
  void save_pipelines() noexcept;

  DeviceSettings settings;
  double timeout_s = 0;  // from the settings, or the default
  DeviceDescription description;
  VulkanInstance instance;
  vk::raii::PhysicalDevice physical;
  std::uint32_t queue_family = 0;
  std::uint32_t timestamp_bits = 0;
  double timestamp_period_ns = 1;
  vk::PhysicalDeviceMemoryProperties memory;
  vk::raii::Device device;
  vk::raii::Queue queue;
  vk::raii::CommandPool pool;
  std::string pipelines_path;         // empty: pipelines are not kept
  std::size_t pipelines_on_file = 0;  // bytes
  vk::raii::PipelineCache pipelines = nullptr;
  std::unique_ptr<StagingRing> staging;  // made on first use
  std::string given_up;                  // the reason, as a sentence; empty if the device was not given up
  bool hangs = false;                    // the device did not even finish before it was closed
  bool has_drawn = false;                // whether a first drawing has been tried
};

struct DeviceBuffer::Impl {
  std::shared_ptr<Device::Impl> device;
  std::string name;
  std::uint64_t bytes;
  vk::raii::DeviceMemory memory;  // destroyed after the buffer
  vk::raii::Buffer buffer;
  std::uint64_t address;
};

struct ComputePipeline::Impl {
  std::shared_ptr<Device::Impl> device;
  std::string name;
  std::uint32_t push_bytes;
  vk::raii::PipelineLayout layout;
  vk::raii::Pipeline pipeline;
};

struct DeviceImage {
  vk::raii::Image image;
  vk::raii::DeviceMemory memory;
  vk::raii::ImageView view;
};

struct RasterTarget::Impl {
  std::shared_ptr<Device::Impl> device;
  std::uint32_t width, height;
  RasterColours of;
  std::vector<DeviceImage> images;  // colours, then depth
  vk::raii::RenderPass pass;
  vk::raii::Framebuffer framebuffer;

  std::uint32_t colours() const { return static_cast<std::uint32_t>(images.size()) - 1; }
};

struct RasterPipeline::Impl {
  std::shared_ptr<Device::Impl> device;
  std::string name;
  std::uint32_t push_bytes, colours;
  RasterColours of;
  vk::raii::PipelineLayout layout;
  vk::raii::Pipeline pipeline;
};

/// Specialisation constants 0, 1, 2, ...; valid while both arguments live.
vk::SpecializationInfo specialisation(std::span<const std::uint32_t> constants,
                                      std::vector<vk::SpecializationMapEntry>& entries);

vk::raii::PipelineLayout compute_layout(const vk::raii::Device& device, std::uint32_t push_bytes);
/// Compiles a shader with the entry point main; `constants` as for specialisation().
vk::raii::Pipeline compute_pipeline(const vk::raii::Device& device, const vk::raii::PipelineLayout& layout,
                                    std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> constants,
                                    vk::PipelineCreateFlags flags,
                                    const vk::Optional<const vk::raii::PipelineCache>& cache);

vk::raii::PipelineLayout raster_layout(const vk::raii::Device& device, std::uint32_t push_bytes);
/// Compiles a vertex and a fragment shader, as compute_pipeline() does.
vk::raii::Pipeline raster_pipeline(const vk::raii::Device& device, const vk::raii::PipelineLayout& layout,
                                   std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                                   const RasterSettings& settings, std::span<const std::uint32_t> constants,
                                   vk::PipelineCreateFlags flags,
                                   const vk::Optional<const vk::raii::PipelineCache>& cache);

/// Makes earlier commands finish, and their writes visible, before later commands begin.
void full_barrier(const vk::raii::CommandBuffer& commands);

}  // namespace scarp
