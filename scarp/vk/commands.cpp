// SPDX-License-Identifier: MIT
#include "scarp/vk/commands.h"

#include <fmt/format.h>

#include "scarp/vk/raii.h"
#include "scarp/vk/timestamps.h"

namespace scarp {
namespace {

constexpr std::uint32_t kMaxGroups = 65535;

vk::raii::CommandBuffer make_commands(const Device::Impl& device) {
  vk::raii::CommandBuffers one(device.device, {*device.pool, vk::CommandBufferLevel::ePrimary, 1});
  return std::move(one.front());
}

}  // namespace

struct Commands::Impl {
  explicit Impl(const std::shared_ptr<Device::Impl>& open)
      : device(open), commands(make_commands(*open)), fence(open->device, vk::FenceCreateInfo()), timestamps(open) {}

  void begin() {
    if (recording) return;
    finish();  // a run that nobody waited for to its end
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    // What earlier runs and copies have written is there; Vulkan wants it said.
    full_barrier(commands);
    timestamps.reset(commands);
    recording = true;
    passes.clear();
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
  bool recording = false, running = false;
};

Commands::Commands(const Device& device)
    : impl_(guarded(device.description().name, "making a command buffer",
                    [&] { return std::make_unique<Impl>(device.impl()); })) {}
Commands::Commands(Commands&&) noexcept = default;
Commands& Commands::operator=(Commands&&) noexcept = default;

Commands::~Commands() {
  if (!impl_ || !impl_->running) return;
  try {
    impl_->device->device.waitIdle();
  } catch (const vk::SystemError&) {  // lost: nothing runs any more
  }
}

void Commands::record_dispatch(const ComputePipeline& pipeline, const void* push, std::uint32_t bytes,
                               const Groups& groups) {
  const ComputePipeline::Impl& shader = pipeline.impl();
  if (bytes != shader.push_bytes) {
    throw Error(
        fmt::format("shader '{}': {} bytes of push constants, {} expected", shader.name, bytes, shader.push_bytes));
  }
  for (const std::uint32_t count : groups) {
    if (count == 0 || count > kMaxGroups) {
      throw Error(
          fmt::format("shader '{}': {} workgroups along one side; 1 to {} expected", shader.name, count, kMaxGroups));
    }
  }
  guarded(impl_->device->name(), "recording '" + shader.name + "'", [&] {
    impl_->begin();
    const vk::raii::CommandBuffer& commands = impl_->commands;
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *shader.pipeline);
    commands.pushConstants<std::uint8_t>(*shader.layout, vk::ShaderStageFlagBits::eCompute, 0,
                                         {bytes, static_cast<const std::uint8_t*>(push)});
    impl_->timestamps.begin(commands);
    commands.dispatch(groups[0], groups[1], groups[2]);
    impl_->timestamps.end(commands);
    impl_->passes.push_back({shader.name, std::nullopt});
  });
}

void Commands::fill(const DeviceBuffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
  const DeviceBuffer::Impl& to = buffer.impl();
  if (offset % 4 != 0 || bytes % 4 != 0 || bytes == 0 || offset > to.bytes || bytes > to.bytes - offset) {
    throw Error(fmt::format("device buffer '{}': bytes {} to {} of {}; multiples of 4 inside it expected", to.name,
                            offset, offset + bytes, to.bytes));
  }
  guarded(impl_->device->name(), "recording", [&] {
    impl_->begin();
    impl_->commands.fillBuffer(*to.buffer, offset, bytes, word);
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
    all.commands.end();
    all.recording = false;
    all.device->submit(all.commands, all.fence);
    all.running = true;
    all.finish();
    const auto times = all.timestamps.read(all.passes.size());
    for (std::size_t i = 0; i < times.size(); ++i) all.passes[i].nanoseconds = times[i];
  });
}

const std::vector<PassTime>& Commands::passes() const { return impl_->passes; }

}  // namespace scarp
