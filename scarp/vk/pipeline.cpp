// SPDX-License-Identifier: MIT
#include "scarp/vk/pipeline.h"

#include <fmt/format.h>

#include "scarp/vk/raii.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

vk::raii::PipelineLayout compute_layout(const vk::raii::Device& device, std::uint32_t push_bytes) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, push_bytes);
  vk::PipelineLayoutCreateInfo create;
  if (push_bytes > 0) create.setPushConstantRanges(push);
  return {device, create};
}

vk::raii::Pipeline compute_pipeline(const vk::raii::Device& device, const vk::raii::PipelineLayout& layout,
                                    std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> constants,
                                    vk::PipelineCreateFlags flags,
                                    const vk::Optional<const vk::raii::PipelineCache>& cache) {
  const vk::raii::ShaderModule module(device, vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
  std::vector<vk::SpecializationMapEntry> entries;
  const vk::SpecializationInfo special = specialisation(constants, entries);
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &special);
  return {device, cache, vk::ComputePipelineCreateInfo(flags, stage, *layout)};
}

vk::SpecializationInfo specialisation(std::span<const std::uint32_t> constants,
                                      std::vector<vk::SpecializationMapEntry>& entries) {
  for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
  return {static_cast<std::uint32_t>(entries.size()), entries.data(), constants.size_bytes(), constants.data()};
}

ComputePipeline::ComputePipeline(const Device& device, std::span<const std::uint32_t> spirv, const std::string& name,
                                 std::uint32_t push_bytes, std::span<const std::uint32_t> constants) {
  const std::shared_ptr<Device::Impl>& open = device.impl();
  if (push_bytes % 4 != 0 || push_bytes > kMaxPushBytes) {
    throw Error(fmt::format("shader '{}': {} bytes of push constants (must be a multiple of 4, at most {})", name,
                            push_bytes, kMaxPushBytes));
  }
  guarded(open->name(), "making the shader '" + name + "'", [&] {
    vk::raii::PipelineLayout layout = compute_layout(open->device, push_bytes);
    vk::raii::Pipeline pipeline = compute_pipeline(open->device, layout, spirv, constants, {}, open->pipelines);
    impl_.reset(new Impl{open, name, push_bytes, std::move(layout), std::move(pipeline)});
  });
}
ComputePipeline::ComputePipeline(const Device& device, const ShaderProgram& program, const std::string& name)
    : ComputePipeline(device, program.spirv, name, program.push_bytes, program.constants) {}
ComputePipeline::ComputePipeline(ComputePipeline&&) noexcept = default;
ComputePipeline& ComputePipeline::operator=(ComputePipeline&&) noexcept = default;
ComputePipeline::~ComputePipeline() = default;

const std::string& ComputePipeline::name() const { return impl_->name; }

}  // namespace scarp
