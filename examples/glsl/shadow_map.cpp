// SPDX-License-Identifier: MIT
// A plain Vulkan program that uses only Scarp's shader sources. It generates heights and a pyramid of their maxima,
// runs shadow_map.comp, which calls max-mip for each cell to determine whether the cell sees the sun, and writes the
// shadow map.
//   shadow_map shadow_map.spv shadows.pgm
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace {

constexpr int kCells = 256, kSamples = kCells + 1;

struct Push {  // as in shadow_map.comp, std430
  std::int32_t cells = kCells, top_level = 0;
  float lowest = 0, highest = 0, code_step = 0, padding[3] = {};
  float sun[3] = {0.8f, 0.5f, 0.5f};
};

std::vector<float> hills() {
  std::vector<float> heights;
  for (int row = 0; row < kSamples; ++row) {
    for (int col = 0; col < kSamples; ++col) {
      const double x = col, y = row;
      heights.push_back(static_cast<float>(30 + 14 * std::sin(x / 17) * std::cos(y / 23) + 6 * std::sin(x / 5 + y / 9) +
                                           2 * std::sin(x * 0.9) * std::sin(y * 0.7)));
    }
  }
  return heights;
}

// Returns levels 1, 2, ..., each with half the size of the one before, rounded up, to the level with one block. A
// block's entry is the highest sample in or on the border of its 2^level x 2^level cells, in steps, rounded up.
std::vector<float> maxima_of(const std::vector<float>& heights, float step, std::int32_t& top_level) {
  std::vector<float> maxima, below;
  int side = kCells;
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const float* at = &heights[static_cast<std::size_t>(row * kSamples + col)];
      below.push_back(std::ceil(std::max({at[0], at[1], at[kSamples], at[kSamples + 1]}) / step));
    }
  }
  for (top_level = 0; side > 1; ++top_level) {
    const int half = (side + 1) / 2;
    std::vector<float> level(static_cast<std::size_t>(half * half), 0.0f);
    for (int row = 0; row < side; ++row) {
      for (int col = 0; col < side; ++col) {
        float& block = level[static_cast<std::size_t>(row / 2 * half + col / 2)];
        block = std::max(block, below[static_cast<std::size_t>(row * side + col)]);
      }
    }
    maxima.insert(maxima.end(), level.begin(), level.end());
    below = level;
    side = half;
  }
  return maxima;
}

struct Buffer {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Buffer buffer = nullptr;
  void* data = nullptr;
};

Buffer make_buffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, std::size_t bytes) {
  Buffer made;
  made.buffer = device.createBuffer({{}, bytes, vk::BufferUsageFlagBits::eStorageBuffer});
  const vk::MemoryRequirements needs = made.buffer.getMemoryRequirements();
  const vk::PhysicalDeviceMemoryProperties memory = physical.getMemoryProperties();
  // Every device has a host-visible memory type that buffers can use.
  constexpr auto kSeen = vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
  std::uint32_t type = 0;
  while (!(needs.memoryTypeBits >> type & 1) || (memory.memoryTypes[type].propertyFlags & kSeen) != kSeen) ++type;
  made.memory = device.allocateMemory({needs.size, type});
  made.buffer.bindMemory(*made.memory, 0);
  made.data = made.memory.mapMemory(0, VK_WHOLE_SIZE);
  return made;
}

Buffer make_buffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                   const std::vector<float>& numbers) {
  Buffer made = make_buffer(physical, device, numbers.size() * sizeof(float));
  std::memcpy(made.data, numbers.data(), numbers.size() * sizeof(float));
  return made;
}

// Runs the shader once per cell; element row * kCells + col of the result is 1 where the sun is hidden. Empty without a
// device.
std::vector<std::uint32_t> run(const std::vector<std::uint32_t>& shader, const std::vector<float>& heights,
                               const std::vector<float>& maxima, const Push& push) {
  const vk::raii::Context context;
  const vk::ApplicationInfo application("shadow_map", 1, nullptr, 0, VK_API_VERSION_1_1);
  const vk::raii::Instance instance = context.createInstance({{}, &application});
  const std::vector<vk::raii::PhysicalDevice> all = instance.enumeratePhysicalDevices();
  if (all.empty()) return {};
  const vk::raii::PhysicalDevice& physical = all.front();
  const auto families = physical.getQueueFamilyProperties();
  std::uint32_t family = 0;
  while (!(families.at(family).queueFlags & vk::QueueFlagBits::eCompute)) ++family;
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue_info({}, family, 1, &priority);
  const vk::raii::Device device = physical.createDevice({{}, queue_info});
  const vk::raii::Queue queue = device.getQueue(family, 0);

  const Buffer buffers[] = {make_buffer(physical, device, heights), make_buffer(physical, device, maxima),
                            make_buffer(physical, device, kCells * kCells * sizeof(std::uint32_t))};
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < 3; ++i)
    bindings.emplace_back(i, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  const vk::raii::DescriptorSetLayout set_layout = device.createDescriptorSetLayout({{}, bindings});
  const vk::DescriptorPoolSize pool_size(vk::DescriptorType::eStorageBuffer, 3);
  const vk::raii::DescriptorPool pool =
      device.createDescriptorPool({vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, pool_size});
  const vk::raii::DescriptorSet set = std::move(device.allocateDescriptorSets({*pool, *set_layout}).front());
  for (std::uint32_t i = 0; i < 3; ++i) {
    const vk::DescriptorBufferInfo whole(*buffers[i].buffer, 0, VK_WHOLE_SIZE);
    device.updateDescriptorSets(vk::WriteDescriptorSet(*set, i, 0, vk::DescriptorType::eStorageBuffer, {}, whole), {});
  }

  const vk::PushConstantRange range(vk::ShaderStageFlagBits::eCompute, 0, sizeof(Push));
  const vk::raii::PipelineLayout layout = device.createPipelineLayout({{}, *set_layout, range});
  const vk::raii::ShaderModule module = device.createShaderModule({{}, shader});
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main");
  const vk::raii::Pipeline pipeline = device.createComputePipeline(nullptr, {{}, stage, *layout});

  const vk::raii::CommandPool command_pool = device.createCommandPool({{}, family});
  const vk::raii::CommandBuffer commands =
      std::move(device.allocateCommandBuffers({*command_pool, vk::CommandBufferLevel::ePrimary, 1}).front());
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, *set, {});
  commands.pushConstants<Push>(*layout, vk::ShaderStageFlagBits::eCompute, 0, push);
  commands.dispatch(kCells / 8, kCells / 8, 1);
  const vk::MemoryBarrier seen(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
  commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {}, seen, {},
                           {});
  commands.end();
  queue.submit(vk::SubmitInfo({}, {}, *commands));
  queue.waitIdle();
  const auto* shadows = static_cast<const std::uint32_t*>(buffers[2].data);
  return {shadows, shadows + kCells * kCells};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: shadow_map shadow_map.spv shadows.pgm");
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint32_t> shader(bytes.size() / 4);
  std::memcpy(shader.data(), bytes.data(), shader.size() * 4);
  if (shader.empty()) throw std::runtime_error(std::string(argv[1]) + ": no such shader");
  const std::vector<float> heights = hills();
  Push push;
  push.lowest = *std::min_element(heights.begin(), heights.end());
  push.highest = *std::max_element(heights.begin(), heights.end());
  push.code_step = push.highest / 65535;
  const std::vector<float> maxima = maxima_of(heights, push.code_step, push.top_level);
  const std::vector<std::uint32_t> shadows = run(shader, heights, maxima, push);
  if (shadows.empty()) throw vk::IncompatibleDriverError("enumeratePhysicalDevices");
  std::ofstream picture(argv[2], std::ios::binary);
  picture << "P5\n" << kCells << ' ' << kCells << "\n255\n";
  for (const std::uint32_t shadow : shadows) picture.put(static_cast<char>(shadow ? 0 : 255));
  if (!picture.flush()) throw std::runtime_error(std::string(argv[2]) + ": cannot be written");
  std::printf("%d of %d cells are in shadow\n", static_cast<int>(std::count(shadows.begin(), shadows.end(), 1u)),
              kCells * kCells);
  return 0;
} catch (const vk::IncompatibleDriverError&) {
  std::puts("no Vulkan device");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "shadow_map: %s\n", error.what());
  return 1;
}
