// SPDX-License-Identifier: MIT
// A plain Vulkan program that knows nothing of Scarp but its shader texts: it makes a field of heights and a pyramid of
// their maxima, lets shadow_map.comp ask max-mip for each cell whether it sees the sun, and writes the shadow map.
//   shadow_map shadow_map.spv shadows.pgm
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

namespace {

constexpr int kCells = 256, kSamples = kCells + 1;

struct Push {  // as in shadow_map.comp, std430
  std::int32_t cells = kCells, top_level = 0;
  float lowest = 0, highest = 0, code_step = 0, padding[3] = {};
  float sun[3] = {0.8f, 0.5f, 0.3f};
};

void check(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  std::fprintf(stderr, "shadow_map: %s failed: VkResult %d\n", what, static_cast<int>(result));
  std::exit(1);
}

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

// Level 1, level 2, ..., each half of the one below, rounded up, to the level of one block: the highest sample on the
// border or inside of each block of 2^level x 2^level cells, in steps, rounded up.
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
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* data = nullptr;
};

Buffer make_buffer(VkPhysicalDevice physical, VkDevice device, std::size_t bytes, const void* from) {
  Buffer made;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  check(vkCreateBuffer(device, &info, nullptr, &made.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, made.buffer, &needs);
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  constexpr VkMemoryPropertyFlags kWanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  while (!(needs.memoryTypeBits >> allocate.memoryTypeIndex & 1) ||
         (memory.memoryTypes[allocate.memoryTypeIndex].propertyFlags & kWanted) != kWanted)
    ++allocate.memoryTypeIndex;
  check(vkAllocateMemory(device, &allocate, nullptr, &made.memory), "vkAllocateMemory");
  check(vkBindBufferMemory(device, made.buffer, made.memory, 0), "vkBindBufferMemory");
  check(vkMapMemory(device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.data), "vkMapMemory");
  if (from) std::memcpy(made.data, from, bytes);
  return made;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: shadow_map shadow_map.spv shadows.pgm\n"), 1;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> words{std::istreambuf_iterator<char>(file), {}};
  const std::vector<float> heights = hills();
  Push push;
  push.lowest = *std::min_element(heights.begin(), heights.end());
  push.highest = *std::max_element(heights.begin(), heights.end());
  push.code_step = push.highest / 65535;
  const std::vector<float> maxima = maxima_of(heights, push.code_step, push.top_level);

  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  VkInstance instance;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  std::uint32_t count = 1;
  if (vkCreateInstance(&instance_info, nullptr, &instance) != VK_SUCCESS ||
      vkEnumeratePhysicalDevices(instance, &count, &physical) < VK_SUCCESS || count == 0)
    return std::puts("no Vulkan device"), 0;
  // The first family that computes; all but a few devices have it first.
  std::uint32_t families = 16;
  VkQueueFamilyProperties family[16];
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &families, family);
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  while (!(family[queue_info.queueFamilyIndex].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++queue_info.queueFamilyIndex;
  const float priority = 1;
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  VkDevice device;
  check(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
  VkQueue queue;
  vkGetDeviceQueue(device, queue_info.queueFamilyIndex, 0, &queue);

  const Buffer buffers[] = {make_buffer(physical, device, heights.size() * sizeof(float), heights.data()),
                            make_buffer(physical, device, maxima.size() * sizeof(float), maxima.data()),
                            make_buffer(physical, device, kCells * kCells * sizeof(std::uint32_t), nullptr)};
  VkDescriptorSetLayoutBinding bindings[3];
  for (std::uint32_t i = 0; i < 3; ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, {}, {}, 3, bindings};
  VkDescriptorSetLayout set_layout;
  check(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout), "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, {}, {}, 1, 1, &size};
  VkDescriptorPool pool;
  check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo take{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, {}, pool, 1, &set_layout};
  VkDescriptorSet set;
  check(vkAllocateDescriptorSets(device, &take, &set), "vkAllocateDescriptorSets");
  for (std::uint32_t i = 0; i < 3; ++i) {
    const VkDescriptorBufferInfo whole{buffers[i].buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, {}, set, i, 0, 1, bindings[i].descriptorType};
    write.pBufferInfo = &whole;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }

  VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, {}, {}, words.size()};
  module_info.pCode = reinterpret_cast<const std::uint32_t*>(words.data());
  VkShaderModule module;
  check(vkCreateShaderModule(device, &module_info, nullptr, &module), "vkCreateShaderModule");
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo layout_info{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, {}, {}, 1, &set_layout, 1, &range};
  VkPipelineLayout layout;
  check(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout), "vkCreatePipelineLayout");
  VkComputePipelineCreateInfo pipeline_info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  pipeline_info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                         {},
                         {},
                         VK_SHADER_STAGE_COMPUTE_BIT,
                         module,
                         "main",
                         nullptr};
  pipeline_info.layout = layout;
  VkPipeline pipeline;
  check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &pipeline_info, nullptr, &pipeline), "the pipeline");

  VkCommandPoolCreateInfo commands_info{
      VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, {}, {}, queue_info.queueFamilyIndex};
  VkCommandPool command_pool;
  check(vkCreateCommandPool(device, &commands_info, nullptr, &command_pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo command_info{
      VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, {}, command_pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  VkCommandBuffer commands;
  check(vkAllocateCommandBuffers(device, &command_info, &commands), "vkAllocateCommandBuffers");
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
  vkCmdPushConstants(commands, layout, range.stageFlags, 0, sizeof push, &push);
  vkCmdDispatch(commands, kCells / 8, kCells / 8, 1);
  VkMemoryBarrier to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER, {}, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0,
                       nullptr, 0, nullptr);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");

  const auto* shadows = static_cast<const std::uint32_t*>(buffers[2].data);
  std::ofstream picture(argv[2], std::ios::binary);
  picture << "P5\n" << kCells << ' ' << kCells << "\n255\n";
  for (int i = 0; i < kCells * kCells; ++i) picture.put(static_cast<char>(shadows[i] ? 0 : 255));
  std::printf("%d of %d cells are in shadow\n", static_cast<int>(std::count(shadows, shadows + kCells * kCells, 1u)),
              kCells * kCells);
  return picture ? 0 : 1;
}
