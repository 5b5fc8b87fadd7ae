// SPDX-License-Identifier: MIT
#include "scarp/vk/shader_statistics.h"

#include <fmt/format.h>

#include "scarp/vk/raii.h"

namespace scarp {
namespace {

bool reports_statistics(const vk::raii::PhysicalDevice& device) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(), [](const vk::ExtensionProperties& extension) {
    return std::string_view(extension.extensionName.data()) == VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  });
}

vk::raii::PhysicalDevice first_with_statistics(const VulkanInstance& instance) {
  std::string names;
  for (vk::raii::PhysicalDevice& device : instance.physical_devices()) {
    if (reports_statistics(device)) return std::move(device);
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", describe(device).name);
  }
  if (names.empty()) throw Error(no_driver());
  throw Error(fmt::format("Vulkan: no driver reports statistics of shaders (available: {})", names));
}

// Opens a device with the same features as devices that compute, as far as possible: a driver may compile for a device
// that cannot run anything.
vk::raii::Device open_to_compile(const vk::raii::PhysicalDevice& physical, const DeviceAbilities& abilities) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, compute_family(physical.getQueueFamilyProperties()).value_or(0), 1,
                                        &priority);
  const char* extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                     vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>
      create;
  create.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue).setPEnabledExtensionNames(extension);
  create.get<vk::PhysicalDeviceFeatures2>()
      .features.setShaderFloat64(abilities.float64)
      .setShaderInt64(abilities.int64);
  create.get<vk::PhysicalDeviceVulkan12Features>()
      .setScalarBlockLayout(abilities.scalar_block_layout)
      .setBufferDeviceAddress(abilities.buffer_device_address);
  create.get<vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>().setPipelineExecutableInfo(true);
  return {physical, create.get<vk::DeviceCreateInfo>()};
}

double number(const vk::PipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case vk::PipelineExecutableStatisticFormatKHR::eBool32:
      return statistic.value.b32 ? 1 : 0;
    case vk::PipelineExecutableStatisticFormatKHR::eInt64:
      return static_cast<double>(statistic.value.i64);
    case vk::PipelineExecutableStatisticFormatKHR::eUint64:
      return static_cast<double>(statistic.value.u64);
    case vk::PipelineExecutableStatisticFormatKHR::eFloat64:
      break;
  }
  return statistic.value.f64;
}

}  // namespace

struct ShaderCompiler::Impl {
  Impl()
      : instance(false),
        physical(first_with_statistics(instance)),
        description(describe(physical)),
        device(open_to_compile(physical, description.abilities)) {}

  VulkanInstance instance;
  vk::raii::PhysicalDevice physical;
  DeviceDescription description;
  // The executable of the program, and the pipeline that contains it.
  struct Compiled {
    vk::raii::PipelineLayout layout;
    vk::raii::Pipeline pipeline;
    vk::PipelineExecutableInfoKHR executable;
  };
  Compiled compile(const ShaderProgram& program, vk::PipelineCreateFlags flags) const {
    if (program.vertex.empty()) {
      vk::raii::PipelineLayout layout = compute_layout(device, program.push_bytes);
      vk::raii::Pipeline pipeline = compute_pipeline(device, layout, program.spirv, program.constants, flags, nullptr);
      const vk::PipelineExecutableInfoKHR whole(*pipeline, 0);
      return {std::move(layout), std::move(pipeline), whole};
    }
    const RasterSettings settings{
        .push_bytes = program.push_bytes, .colours = program.colours, .of = RasterColours::words};
    vk::raii::PipelineLayout layout = raster_layout(device, program.push_bytes);
    vk::raii::Pipeline pipeline =
        raster_pipeline(device, layout, program.vertex, program.spirv, settings, program.constants, flags, nullptr);
    vk::PipelineExecutableInfoKHR fragments(*pipeline, 0);
    for (const auto& of : device.getPipelineExecutablePropertiesKHR(*pipeline)) {
      if (of.stages & vk::ShaderStageFlagBits::eFragment) break;
      ++fragments.executableIndex;
    }
    return {std::move(layout), std::move(pipeline), fragments};
  }

  vk::raii::Device device;
};

ShaderCompiler::ShaderCompiler() {
  guarded("", "opening a device to compile shaders", [&] { impl_ = std::make_unique<Impl>(); });
}
ShaderCompiler::ShaderCompiler(ShaderCompiler&&) noexcept = default;
ShaderCompiler& ShaderCompiler::operator=(ShaderCompiler&&) noexcept = default;
ShaderCompiler::~ShaderCompiler() = default;

const std::string& ShaderCompiler::device_name() const { return impl_->description.name; }
const std::string& ShaderCompiler::driver() const { return impl_->description.driver; }

std::vector<ShaderStatistic> ShaderCompiler::statistics(const ShaderProgram& program) const {
  return guarded(device_name(), fmt::format("compiling the shader '{}'", program.file), [&] {
    const vk::raii::Device& device = impl_->device;
    const Impl::Compiled compiled = impl_->compile(program, vk::PipelineCreateFlagBits::eCaptureStatisticsKHR);
    std::vector<ShaderStatistic> all;
    for (const auto& statistic : device.getPipelineExecutableStatisticsKHR(compiled.executable)) {
      all.push_back({std::string(statistic.name.data()), number(statistic)});
    }
    return all;
  });
}

std::string ShaderCompiler::disassembly(const ShaderProgram& program) const {
  return guarded(device_name(), fmt::format("compiling the shader '{}'", program.file), [&] {
    const vk::raii::Device& device = impl_->device;
    const Impl::Compiled compiled =
        impl_->compile(program, vk::PipelineCreateFlagBits::eCaptureInternalRepresentationsKHR);
    const vk::PipelineExecutableInfoKHR& executable = compiled.executable;
    // The first call returns the sizes, a second one all texts: Vulkan-Hpp offers no other interface.
    auto all = device.getPipelineExecutableInternalRepresentationsKHR(executable);
    std::vector<std::string> texts(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      texts[i].resize(all[i].dataSize);
      all[i].pData = texts[i].data();
    }
    auto count = static_cast<std::uint32_t>(all.size());
    const auto result =
        static_cast<vk::Result>(device.getDispatcher()->vkGetPipelineExecutableInternalRepresentationsKHR(
            static_cast<VkDevice>(*device), reinterpret_cast<const VkPipelineExecutableInfoKHR*>(&executable), &count,
            reinterpret_cast<VkPipelineExecutableInternalRepresentationKHR*>(all.data())));
    vk::resultCheck(result, "vkGetPipelineExecutableInternalRepresentationsKHR");
    for (std::size_t i = 0; i < all.size(); ++i) {
      // Texts are zero-terminated.
      if (std::string_view(all[i].name.data()) == "Assembly") return texts[i].substr(0, texts[i].find('\0'));
    }
    throw Error(fmt::format("device '{}': reports no machine code of shaders", device_name()));
  });
}

}  // namespace scarp
