// SPDX-License-Identifier: MIT
#include "scarp/vk/commands.h"

#include <fmt/format.h>

#include <cstring>

#include "scarp/vk/raii.h"
#include "scarp/vk/raster.h"
#include "scarp/vk/staging.h"
#include "scarp/vk/timestamps.h"

namespace scarp {
namespace {

constexpr std::uint32_t kMaxGroups = 65535;

vk::raii::CommandBuffer make_commands(const Device::Impl& device) {
  vk::raii::CommandBuffers one(device.device, {*device.pool, vk::CommandBufferLevel::ePrimary, 1});
  return std::move(one.front());
}

constexpr auto kDrawStages = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

void require_fits(const RasterTarget::Impl& target, const DrawCall& call) {
  const RasterPipeline::Impl& shader = call.pipeline->impl();
  if (call.push_bytes != shader.push_bytes) {
    throw Error(fmt::format("shader '{}': {} bytes of push constants instead of {}", shader.name, call.push_bytes,
                            shader.push_bytes));
  }
  if (shader.colours != target.colours()) {
    throw Error(fmt::format("shader '{}': writes {} colours, but its target has {}", shader.name, shader.colours,
                            target.colours()));
  }
  if (shader.colours > 0 && shader.of != target.of) {
    const auto name = [](RasterColours of) { return of == RasterColours::words ? "words" : "floats"; };
    throw Error(
        fmt::format("shader '{}': writes {}, but its target has {}", shader.name, name(shader.of), name(target.of)));
  }
  if (call.indices && std::uint64_t{call.count} * 4 > call.indices->bytes()) {
    throw Error(fmt::format("shader '{}': {} indices, but the buffer '{}' holds {}", shader.name, call.count,
                            call.indices->impl().name, call.indices->bytes() / 4));
  }
}

}  // namespace

// Host memory for the reads of a run, one after another.
class HostReads {
 public:
  explicit HostReads(const Device::Impl& device)
      : buffer_(device.device,
                vk::BufferCreateInfo({}, Commands::kMaxReadBytes, vk::BufferUsageFlagBits::eTransferDst)),
        memory_(host_memory(device, buffer_)),
        bytes_(static_cast<const std::byte*>(memory_.mapMemory(0, Commands::kMaxReadBytes))) {}

  std::uint64_t room() const { return Commands::kMaxReadBytes - used_; }

  void record(const vk::raii::CommandBuffer& commands, const DeviceBuffer::Impl& from, std::uint64_t offset,
              std::uint64_t bytes, void* to) {
    commands.copyBuffer(*from.buffer, *buffer_, vk::BufferCopy(offset, used_, bytes));
    reads_.push_back({used_, bytes, to});
    used_ += bytes;
  }
  // Call after the last read of a run.
  void close(const vk::raii::CommandBuffer& commands) const {
    if (reads_.empty()) return;
    const vk::MemoryBarrier to_host(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {}, to_host, {},
                             {});
  }
  // Call after the run.
  void deliver() {
    for (const Read& read : reads_) std::memcpy(read.to, bytes_ + read.begin, read.bytes);
    forget();
  }
  void forget() {
    reads_.clear();
    used_ = 0;
  }

 private:
  struct Read {
    std::uint64_t begin, bytes;
    void* to;
  };
  vk::raii::Buffer buffer_;
  vk::raii::DeviceMemory memory_;
  const std::byte* bytes_;
  std::vector<Read> reads_;
  std::uint64_t used_ = 0;
};

struct Commands::Impl {
  explicit Impl(const std::shared_ptr<Device::Impl>& open)
      : device(open), commands(make_commands(*open)), fence(open->device, vk::FenceCreateInfo()), timestamps(open) {}

  void begin() {
    if (recording) return;
    finish();  // the caller did not wait for the previous run
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    // Vulkan requires a barrier before the results of earlier runs and copies are visible.
    full_barrier(commands);
    timestamps.reset(commands);
    recording = true;
    passes.clear();
    if (reads) reads->forget();
  }

  void finish() {
    if (!running) return;
    device->wait(fence, passes.empty() ? "a run" : "'" + passes.back().name + "'");
    running = false;
  }

  std::shared_ptr<Device::Impl> device;
  vk::raii::CommandBuffer commands;
  vk::raii::Fence fence;
  Timestamps timestamps;
  std::vector<PassTime> passes;
  std::optional<HostReads> reads;  // made on first use
  bool recording = false, running = false;
};

Commands::Commands(const Device& device)
    : impl_(guarded(device.description().name, "making a command buffer",
                    [&] { return std::make_unique<Impl>(device.impl()); })) {}
Commands::Commands(Commands&&) noexcept = default;
Commands& Commands::operator=(Commands&&) noexcept = default;

Commands::~Commands() {
  if (impl_ && impl_->running) impl_->device->wait_at_end(impl_->fence);
}

void Commands::record_dispatch(const ComputePipeline& pipeline, const void* push, std::uint32_t bytes,
                               const Groups& groups) {
  const ComputePipeline::Impl& shader = pipeline.impl();
  if (bytes != shader.push_bytes) {
    throw Error(
        fmt::format("shader '{}': {} bytes of push constants instead of {}", shader.name, bytes, shader.push_bytes));
  }
  for (const std::uint32_t count : groups) {
    if (count == 0 || count > kMaxGroups) {
      throw Error(
          fmt::format("shader '{}': {} workgroups along one side (1 to {} allowed)", shader.name, count, kMaxGroups));
    }
  }
  guarded(impl_->device->name(), "recording '" + shader.name + "'", [&] {
    impl_->begin();
    const vk::raii::CommandBuffer& commands = impl_->commands;
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *shader.pipeline);
    commands.pushConstants<std::uint8_t>(*shader.layout, vk::ShaderStageFlagBits::eCompute, 0,
                                         {bytes, static_cast<const std::uint8_t*>(push)});
    impl_->timestamps.begin(commands, vk::PipelineStageFlagBits::eComputeShader);
    commands.dispatch(groups[0], groups[1], groups[2]);
    impl_->timestamps.end(commands, vk::PipelineStageFlagBits::eComputeShader);
    impl_->passes.push_back({shader.name, std::nullopt});
  });
}

void Commands::draw(const RasterTarget& target, std::initializer_list<DrawCall> calls, float clear_depth) {
  const RasterTarget::Impl& to = target.impl();
  for (const DrawCall& call : calls) require_fits(to, call);
  guarded(impl_->device->name(), "recording '" + calls.begin()->pipeline->name() + "'", [&] {
    impl_->begin();
    const vk::raii::CommandBuffer& commands = impl_->commands;
    // Earlier passes may still read the images.
    full_barrier(commands);
    std::vector<vk::ClearValue> clear(to.images.size());
    clear.back().setDepthStencil({clear_depth, 0});
    const vk::Rect2D area({0, 0}, {to.width, to.height});
    impl_->timestamps.begin(commands, vk::PipelineStageFlagBits::eBottomOfPipe);
    commands.beginRenderPass({*to.pass, *to.framebuffer, area, clear}, vk::SubpassContents::eInline);
    for (const DrawCall& call : calls) {
      const RasterPipeline::Impl& shader = call.pipeline->impl();
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *shader.pipeline);
      commands.setViewport(0, vk::Viewport(0, 0, static_cast<float>(to.width), static_cast<float>(to.height), 0, 1));
      commands.setScissor(0, area);
      if (call.push_bytes > 0) {
        commands.pushConstants<std::uint8_t>(*shader.layout, kDrawStages, 0,
                                             {call.push_bytes, static_cast<const std::uint8_t*>(call.push)});
      }
      if (call.indices) {
        commands.bindIndexBuffer(*call.indices->impl().buffer, 0, vk::IndexType::eUint32);
        commands.drawIndexed(call.count, call.instances, 0, 0, 0);
      } else {
        commands.draw(call.count, call.instances, 0, 0);
      }
    }
    commands.endRenderPass();
    impl_->timestamps.end(commands, vk::PipelineStageFlagBits::eBottomOfPipe);
    impl_->passes.push_back({calls.begin()->pipeline->name(), std::nullopt});
  });
}

void Commands::copy(const RasterTarget& from, std::uint32_t image, const DeviceBuffer& to) {
  const RasterTarget::Impl& target = from.impl();
  const bool depth = image == target.colours();
  const std::uint64_t bytes = std::uint64_t{target.width} * target.height * (depth ? 4 : 16);
  if (image > target.colours() || bytes > to.bytes()) {
    throw Error(fmt::format("device buffer '{}': image {} of {} ({} bytes) does not fit into {} bytes", to.impl().name,
                            image, target.images.size(), bytes, to.bytes()));
  }
  guarded(impl_->device->name(), "recording", [&] {
    impl_->begin();
    const vk::ImageSubresourceLayers layers(depth ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor,
                                            0, 0, 1);
    const vk::BufferImageCopy copy(0, 0, 0, layers, {}, {target.width, target.height, 1});
    impl_->commands.copyImageToBuffer(*target.images[image].image, vk::ImageLayout::eTransferSrcOptimal,
                                      *to.impl().buffer, copy);
  });
}

void Commands::fill(const DeviceBuffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
  const DeviceBuffer::Impl& to = buffer.impl();
  if (offset % 4 != 0 || bytes % 4 != 0 || bytes == 0 || offset > to.bytes || bytes > to.bytes - offset) {
    throw Error(fmt::format("device buffer '{}': bytes {} to {} of {} (must be multiples of 4 within the buffer)",
                            to.name, offset, offset + bytes, to.bytes));
  }
  guarded(impl_->device->name(), "recording", [&] {
    impl_->begin();
    impl_->commands.fillBuffer(*to.buffer, offset, bytes, word);
  });
}

void Commands::read(const DeviceBuffer& from, std::uint64_t offset, std::uint64_t bytes, void* to) {
  const DeviceBuffer::Impl& buffer = from.impl();
  guarded(impl_->device->name(), "recording", [&] {
    impl_->begin();
    if (!impl_->reads) impl_->reads.emplace(*impl_->device);
    if (offset % 4 != 0 || bytes % 4 != 0 || bytes == 0 || offset > buffer.bytes || bytes > buffer.bytes - offset ||
        bytes > impl_->reads->room()) {
      throw Error(
          fmt::format("device buffer '{}': reading bytes {} to {} of {} (must be multiples of 4 within the "
                      "buffer, at most {} in a run)",
                      buffer.name, offset, offset + bytes, buffer.bytes, kMaxReadBytes));
    }
    impl_->reads->record(impl_->commands, buffer, offset, bytes, to);
  });
}

void Commands::barrier() {
  guarded(impl_->device->name(), "recording", [&] {
    impl_->begin();
    full_barrier(impl_->commands);
  });
}

void Commands::run() {
  Impl& all = *impl_;
  guarded(all.device->name(), "computing", [&] {
    all.begin();
    if (all.reads) all.reads->close(all.commands);
    all.commands.end();
    all.recording = false;
    all.device->submit(all.commands, all.fence);
    all.running = true;
    all.finish();
    const auto times = all.timestamps.read(all.passes.size());
    for (std::size_t i = 0; i < times.size(); ++i) all.passes[i].nanoseconds = times[i];
    if (all.reads) all.reads->deliver();
  });
}

const std::vector<PassTime>& Commands::passes() const { return impl_->passes; }

}  // namespace scarp
