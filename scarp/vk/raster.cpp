// SPDX-License-Identifier: MIT
#include "scarp/vk/raster.h"

#include <fmt/format.h>

#include <array>

#include "scarp/vk/first_drawing.h"
#include "scarp/vk/raii.h"

namespace scarp {
namespace {

constexpr vk::Format kDepth = vk::Format::eD32Sfloat;

// Every device can draw into both formats.
vk::Format format_of(RasterColours colours) {
  return colours == RasterColours::words ? vk::Format::eR32G32B32A32Uint : vk::Format::eR32G32B32A32Sfloat;
}

// Colours are written in one stage, depths in two.
constexpr auto kDrawing = vk::PipelineStageFlagBits::eColorAttachmentOutput |
                          vk::PipelineStageFlagBits::eEarlyFragmentTests |
                          vk::PipelineStageFlagBits::eLateFragmentTests;
constexpr auto kDrawn = vk::AccessFlagBits::eColorAttachmentWrite | vk::AccessFlagBits::eDepthStencilAttachmentWrite;

void require_draws(const Device& device) {
  const DeviceDescription& description = device.description();
  if (!description.abilities.draws) {
    throw Error(fmt::format("device '{}': no queue draws triangles (choose another device, see 'scarp devices')",
                            description.name));
  }
  const auto depth = device.impl()->physical.getFormatProperties(kDepth).optimalTilingFeatures;
  if (!(depth & vk::FormatFeatureFlagBits::eDepthStencilAttachment)) {
    throw Error(fmt::format("device '{}': no 32-bit float depth buffers (choose another device, see 'scarp devices')",
                            description.name));
  }
  try_first_drawing(device);
}

DeviceImage make_image(const Device::Impl& device, std::uint32_t width, std::uint32_t height, vk::Format format) {
  using Usage = vk::ImageUsageFlagBits;
  const bool depth = format == kDepth;
  vk::raii::Image image(
      device.device,
      vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {width, height, 1}, 1, 1, vk::SampleCountFlagBits::e1,
                          vk::ImageTiling::eOptimal,
                          (depth ? Usage::eDepthStencilAttachment : Usage::eColorAttachment) | Usage::eTransferSrc));
  const vk::MemoryRequirements needs = image.getMemoryRequirements();
  const auto type = device.memory_type(needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal);
  vk::StructureChain<vk::MemoryAllocateInfo, vk::MemoryDedicatedAllocateInfo> allocate;
  allocate.get<vk::MemoryAllocateInfo>().setAllocationSize(needs.size).setMemoryTypeIndex(type.value());
  allocate.get<vk::MemoryDedicatedAllocateInfo>().setImage(*image);
  vk::raii::DeviceMemory memory(device.device, allocate.get<vk::MemoryAllocateInfo>());
  image.bindMemory(*memory, 0);
  const auto aspect = depth ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
  vk::raii::ImageView view(
      device.device, vk::ImageViewCreateInfo({}, *image, vk::ImageViewType::e2D, format, {}, {aspect, 0, 1, 0, 1}));
  return {std::move(image), std::move(memory), std::move(view)};
}

// The pass clears, draws, then makes the images ready for copying. Pipelines are compatible with passes that have the
// same colours.
vk::raii::RenderPass make_pass(const vk::raii::Device& device, std::uint32_t colours, RasterColours of) {
  std::vector<vk::AttachmentDescription> attachments;
  std::vector<vk::AttachmentReference> references;
  for (std::uint32_t i = 0; i <= colours; ++i) {
    attachments.push_back({{},
                           i == colours ? kDepth : format_of(of),
                           vk::SampleCountFlagBits::e1,
                           vk::AttachmentLoadOp::eClear,
                           vk::AttachmentStoreOp::eStore,
                           vk::AttachmentLoadOp::eDontCare,
                           vk::AttachmentStoreOp::eDontCare,
                           vk::ImageLayout::eUndefined,
                           vk::ImageLayout::eTransferSrcOptimal});
    references.push_back(
        {i, i == colours ? vk::ImageLayout::eDepthStencilAttachmentOptimal : vk::ImageLayout::eColorAttachmentOptimal});
  }
  const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, 0, nullptr, colours, references.data(),
                                       nullptr, &references.back());
  using Access = vk::AccessFlagBits;
  const std::array dependencies = {
      vk::SubpassDependency(VK_SUBPASS_EXTERNAL, 0, vk::PipelineStageFlagBits::eAllCommands, kDrawing,
                            Access::eMemoryWrite, kDrawn | Access::eDepthStencilAttachmentRead),
      vk::SubpassDependency(0, VK_SUBPASS_EXTERNAL, kDrawing, vk::PipelineStageFlagBits::eTransfer, kDrawn,
                            Access::eTransferRead)};
  return {device, vk::RenderPassCreateInfo({}, attachments, subpass, dependencies)};
}

vk::raii::Framebuffer make_framebuffer(const Device::Impl& device, const vk::raii::RenderPass& pass,
                                       const std::vector<DeviceImage>& images, std::uint32_t width,
                                       std::uint32_t height) {
  std::vector<vk::ImageView> views;
  for (const DeviceImage& image : images) views.push_back(*image.view);
  return {device.device, vk::FramebufferCreateInfo({}, *pass, views, width, height, 1)};
}

}  // namespace

vk::raii::PipelineLayout raster_layout(const vk::raii::Device& device, std::uint32_t push_bytes) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, 0,
                                   push_bytes);
  vk::PipelineLayoutCreateInfo create;
  if (push_bytes > 0) create.setPushConstantRanges(push);
  return {device, create};
}

vk::raii::Pipeline raster_pipeline(const vk::raii::Device& device, const vk::raii::PipelineLayout& layout,
                                   std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                                   const RasterSettings& settings, std::span<const std::uint32_t> constants,
                                   vk::PipelineCreateFlags flags,
                                   const vk::Optional<const vk::raii::PipelineCache>& cache) {
  const vk::raii::RenderPass pass = make_pass(device, settings.colours, settings.of);
  std::vector<vk::SpecializationMapEntry> entries;
  const vk::SpecializationInfo special = specialisation(constants, entries);
  std::vector<vk::raii::ShaderModule> modules;
  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  const auto add = [&](vk::ShaderStageFlagBits stage, std::span<const std::uint32_t> words) {
    if (words.empty()) return;
    modules.emplace_back(device, vk::ShaderModuleCreateInfo({}, words.size_bytes(), words.data()));
    stages.push_back({{}, stage, *modules.back(), "main", &special});
  };
  add(vk::ShaderStageFlagBits::eVertex, vertex);
  add(vk::ShaderStageFlagBits::eFragment, fragment);
  const vk::PipelineVertexInputStateCreateInfo no_vertices;
  const vk::PipelineInputAssemblyStateCreateInfo triangles({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo one_viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo fill;
  fill.setPolygonMode(vk::PolygonMode::eFill).setCullMode(vk::CullModeFlagBits::eNone).setLineWidth(1);
  const vk::PipelineMultisampleStateCreateInfo one_sample({}, vk::SampleCountFlagBits::e1);
  const vk::PipelineDepthStencilStateCreateInfo depth(
      {}, true, true, settings.depth_test ? vk::CompareOp::eGreater : vk::CompareOp::eAlways);
  using Component = vk::ColorComponentFlagBits;
  vk::PipelineColorBlendAttachmentState opaque;
  opaque.setColorWriteMask(Component::eR | Component::eG | Component::eB | Component::eA);
  const std::vector<vk::PipelineColorBlendAttachmentState> opaques(settings.colours, opaque);
  vk::PipelineColorBlendStateCreateInfo blend;
  blend.setAttachments(opaques);
  const std::array dynamic = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo sized_by_target({}, dynamic);
  const vk::GraphicsPipelineCreateInfo create(flags, stages, &no_vertices, &triangles, nullptr, &one_viewport, &fill,
                                              &one_sample, &depth, &blend, &sized_by_target, *layout, *pass);
  return {device, cache, create};
}

RasterLimits raster_limits(const Device& device) {
  const vk::PhysicalDeviceLimits limits = device.impl()->physical.getProperties().limits;
  return {std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight}),
          limits.subPixelPrecisionBits};
}

RasterTarget::RasterTarget(const Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t colours,
                           RasterColours of) {
  require_draws(device);
  const std::uint32_t most = raster_limits(device).most_pixels;
  if (width < 1 || height < 1 || width > most || height > most) {
    throw Error(fmt::format("device '{}': render target of {} x {} pixels (1 to {} per side supported)",
                            device.description().name, width, height, most));
  }
  const std::shared_ptr<Device::Impl>& open = device.impl();
  guarded(open->name(), fmt::format("making images of {} x {} pixels", width, height), [&] {
    std::vector<DeviceImage> images;
    for (std::uint32_t i = 0; i <= colours; ++i)
      images.push_back(make_image(*open, width, height, i == colours ? kDepth : format_of(of)));
    vk::raii::RenderPass pass = make_pass(open->device, colours, of);
    vk::raii::Framebuffer framebuffer = make_framebuffer(*open, pass, images, width, height);
    impl_.reset(new Impl{open, width, height, of, std::move(images), std::move(pass), std::move(framebuffer)});
  });
}
RasterTarget::RasterTarget(RasterTarget&&) noexcept = default;
RasterTarget& RasterTarget::operator=(RasterTarget&&) noexcept = default;
RasterTarget::~RasterTarget() = default;

std::uint32_t RasterTarget::width() const { return impl_->width; }
std::uint32_t RasterTarget::height() const { return impl_->height; }

RasterPipeline::RasterPipeline(const Device& device, std::span<const std::uint32_t> vertex,
                               std::span<const std::uint32_t> fragment, const std::string& name,
                               const RasterSettings& settings, std::span<const std::uint32_t> constants) {
  require_draws(device);
  if (settings.push_bytes % 4 != 0 || settings.push_bytes > kMaxPushBytes) {
    throw Error(fmt::format("shader '{}': {} bytes of push constants (must be a multiple of 4, at most {})", name,
                            settings.push_bytes, kMaxPushBytes));
  }
  const std::shared_ptr<Device::Impl>& open = device.impl();
  guarded(open->name(), "making the shader '" + name + "'", [&] {
    vk::raii::PipelineLayout layout = raster_layout(open->device, settings.push_bytes);
    vk::raii::Pipeline pipeline =
        raster_pipeline(open->device, layout, vertex, fragment, settings, constants, {}, open->pipelines);
    impl_.reset(new Impl{open, name, settings.push_bytes, settings.colours, settings.of, std::move(layout),
                         std::move(pipeline)});
  });
}
RasterPipeline::RasterPipeline(RasterPipeline&&) noexcept = default;
RasterPipeline& RasterPipeline::operator=(RasterPipeline&&) noexcept = default;
RasterPipeline::~RasterPipeline() = default;

const std::string& RasterPipeline::name() const { return impl_->name; }

}  // namespace scarp
