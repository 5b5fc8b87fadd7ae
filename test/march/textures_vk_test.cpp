// SPDX-License-Identifier: MIT
// max-mip over textures, as WebGL has them, on a Vulkan device: the answers are those over buffers, bit for bit,
// because it is the same text on the same numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "march/spiteful.h"
#include "march/spiteful_text.h"
#include "march/textures_vk.glsl.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/march/device_ray.h"
#include "scarp/march/queries_vk.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/raii.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

constexpr std::uint32_t kWords[] = {
#include "test/march/textures_vk.comp.inc"
};
constexpr std::uint32_t kThreads = 64;

// Commands of the test's own: the station knows neither images nor descriptors.
template <class Record>
void run(Device::Impl& device, const Record& record) {
  vk::raii::CommandBuffers one(device.device, {*device.pool, vk::CommandBufferLevel::ePrimary, 1});
  const vk::raii::Fence fence(device.device, vk::FenceCreateInfo());
  one.front().begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  full_barrier(one.front());
  record(one.front());
  one.front().end();
  device.submit(one.front(), fence);
  device.wait(fence, "textures");
}

// An image of floats with mip levels; level l has `sizes[l]`, filled from `texels[l]`, `channels` floats per texel.
class Texture {
 public:
  struct Level {
    std::uint32_t cols, rows;
    std::vector<float> texels;
  };

  Texture(const Device& open, const std::vector<Level>& levels, std::uint32_t channels)
      : device_(*open.impl()),
        image_(device_.device,
               vk::ImageCreateInfo({}, vk::ImageType::e2D, format(channels), {levels[0].cols, levels[0].rows, 1},
                                   static_cast<std::uint32_t>(levels.size()), 1, vk::SampleCountFlagBits::e1,
                                   vk::ImageTiling::eOptimal,
                                   vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst)),
        memory_(allocate()),
        view_(nullptr) {
    image_.bindMemory(*memory_, 0);
    const vk::ImageSubresourceRange all(vk::ImageAspectFlagBits::eColor, 0, static_cast<std::uint32_t>(levels.size()),
                                        0, 1);
    view_ = vk::raii::ImageView(
        device_.device, vk::ImageViewCreateInfo({}, *image_, vk::ImageViewType::e2D, format(channels), {}, all));
    const auto change = [&](const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) {
      const vk::ImageMemoryBarrier barrier(vk::AccessFlagBits::eMemoryWrite,
                                           vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite, from, to,
                                           VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *image_, all);
      commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands, {}, {},
                               {}, barrier);
    };
    run(device_, [&](const auto& commands) {
      change(commands, vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferDstOptimal);
    });
    for (std::uint32_t level = 0; level < levels.size(); ++level) {
      const Level& of = levels[level];
      const DeviceBuffer texels(open, of.texels.size() * sizeof(float), "texels");
      upload(texels, 0, of.texels.data(), of.texels.size() * sizeof(float));
      run(device_, [&](const auto& commands) {
        const vk::BufferImageCopy copy(0, 0, 0, {vk::ImageAspectFlagBits::eColor, level, 0, 1}, {0, 0, 0},
                                       {of.cols, of.rows, 1});
        commands.copyBufferToImage(*texels.impl().buffer, *image_, vk::ImageLayout::eTransferDstOptimal, copy);
      });
    }
    run(device_, [&](const auto& commands) {
      change(commands, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eShaderReadOnlyOptimal);
    });
  }

  const vk::raii::ImageView& view() const { return view_; }

 private:
  static vk::Format format(std::uint32_t channels) {
    return channels == 1 ? vk::Format::eR32Sfloat : vk::Format::eR32G32Sfloat;
  }
  vk::raii::DeviceMemory allocate() const {
    const vk::MemoryRequirements needs = image_.getMemoryRequirements();
    const auto type = device_.memory_type(needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal);
    return {device_.device, vk::MemoryAllocateInfo(needs.size, type.value())};
  }

  Device::Impl& device_;
  vk::raii::Image image_;
  vk::raii::DeviceMemory memory_;
  vk::raii::ImageView view_;
};

std::vector<Texture::Level> heights_of(const HeightField& field) {
  Texture::Level level{static_cast<std::uint32_t>(field.cols()), static_cast<std::uint32_t>(field.rows()), {}};
  field.visit([&](const auto& grid) {
    for (int row = 0; row < field.rows(); ++row) {
      for (int col = 0; col < field.cols(); ++col) level.texels.push_back(static_cast<float>(grid.at(col, row)));
    }
  });
  return {level};
}

std::vector<Texture::Level> bounds_of(const MaxPyramid& pyramid) {
  std::vector<Texture::Level> levels;
  std::uint32_t cols = std::bit_ceil(static_cast<std::uint32_t>(pyramid.levels()[0].cols));
  std::uint32_t rows = std::bit_ceil(static_cast<std::uint32_t>(pyramid.levels()[0].rows));
  for (const auto& of : pyramid.levels()) {
    Texture::Level level{cols, rows, std::vector<float>(std::size_t{2} * cols * rows)};
    for (int row = 0; row < of.rows; ++row) {
      for (int col = 0; col < of.cols; ++col) {
        const std::ptrdiff_t entry = of.begin + std::ptrdiff_t{row} * of.cols + col;
        float* texel = &level.texels[2 * (static_cast<std::size_t>(row) * cols + static_cast<std::size_t>(col))];
        texel[0] = pyramid.maxima()[entry];
        texel[1] = pyramid.minima()[entry];
      }
    }
    levels.push_back(std::move(level));
    cols = std::max(cols / 2, 1U);
    rows = std::max(rows / 2, 1U);
  }
  return levels;
}

// The pipeline with its two textures.
class TextureMarch {
 public:
  explicit TextureMarch(const Device& open)
      : device_(*open.impl()),
        sampler_(device_.device,
                 vk::SamplerCreateInfo({}, vk::Filter::eNearest, vk::Filter::eNearest, vk::SamplerMipmapMode::eNearest,
                                       {}, {}, {}, 0, false, 0, false, {}, 0, VK_LOD_CLAMP_NONE)),
        set_layout_(nullptr),
        layout_(nullptr),
        pipeline_(nullptr),
        pool_(nullptr) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (std::uint32_t i = 0; i < 2; ++i)
      bindings.emplace_back(i, vk::DescriptorType::eCombinedImageSampler, 1, vk::ShaderStageFlagBits::eCompute);
    set_layout_ = vk::raii::DescriptorSetLayout(device_.device, vk::DescriptorSetLayoutCreateInfo({}, bindings));
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, sizeof(glsl::TexturesPush));
    layout_ = vk::raii::PipelineLayout(device_.device, vk::PipelineLayoutCreateInfo({}, *set_layout_, push));
    const vk::raii::ShaderModule module(device_.device, vk::ShaderModuleCreateInfo({}, sizeof kWords, kWords));
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main");
    pipeline_ = vk::raii::Pipeline(device_.device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout_));
    const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 2);
    pool_ = vk::raii::DescriptorPool(
        device_.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
  }

  void dispatch(const Texture& heights, const Texture& bounds, const glsl::TexturesPush& push) {
    const vk::raii::DescriptorSets sets(device_.device, vk::DescriptorSetAllocateInfo(*pool_, *set_layout_));
    for (std::uint32_t i = 0; i < 2; ++i) {
      const vk::DescriptorImageInfo image(*sampler_, i == 0 ? *heights.view() : *bounds.view(),
                                          vk::ImageLayout::eShaderReadOnlyOptimal);
      device_.device.updateDescriptorSets(
          vk::WriteDescriptorSet(*sets[0], i, 0, vk::DescriptorType::eCombinedImageSampler, image), {});
    }
    run(device_, [&](const vk::raii::CommandBuffer& commands) {
      commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
      commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *sets[0], {});
      commands.pushConstants<glsl::TexturesPush>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
      commands.dispatch((push.count + kThreads - 1) / kThreads, 1, 1);
    });
  }

 private:
  Device::Impl& device_;
  vk::raii::Sampler sampler_;
  vk::raii::DescriptorSetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
  vk::raii::DescriptorPool pool_;
};

class TexturesOnDevice : public OnDevice {};

TEST_F(TexturesOnDevice, MaxMipAnswersAsOverBuffers) {
  constexpr int kRaysPerKind = 20;
  DeviceQueries over_buffers(device());
  TextureMarch over_textures(device());
  int hit_count = 0;
  for (const FieldKind& fields : spiteful_fields()) {
    Random random(5);
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    const MaxPyramid pyramid(field);
    const DeviceGround ground(device(), field);
    const Texture heights(device(), heights_of(field), 1), bounds(device(), bounds_of(pyramid), 2);
    std::vector<Ray> rays;
    for (const RayKind& kind : spiteful_rays()) {
      if ((fields.has & kind.aims_at) != kind.aims_at) continue;
      for (int i = 0; i < kRaysPerKind; ++i) rays.push_back(kind.make(field, random));
    }
    std::vector<Hit> expected(rays.size());
    over_buffers.closest_hits({&field, &ground}, rays, expected);

    std::vector<DeviceRay> prepared;
    std::vector<glsl::ScarpRay> packed;
    for (const Ray& ray : rays) {
      prepared.push_back(device_ray(field, ray));
      packed.push_back(prepared.back().ray);
    }
    std::vector<glsl::ScarpHit> answers(rays.size());
    const DeviceBuffer on_device(device(), packed.size() * sizeof packed[0], "rays");
    const DeviceBuffer found(device(), answers.size() * sizeof answers[0], "hits");
    upload(on_device, 0, packed.data(), packed.size() * sizeof packed[0]);
    const double nodata = field.settings().nodata.value_or(NAN);
    over_textures.dispatch(heights, bounds,
                           {on_device.address(), found.address(), device_field(field, &pyramid),
                            static_cast<float>(nodata), static_cast<std::uint32_t>(rays.size())});
    download(found, 0, answers.data(), answers.size() * sizeof answers[0]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = hit_from_device(rays[i], prepared[i], answers[i]);
      hit_count += static_cast<bool>(hit);
      ASSERT_TRUE(hit.status == expected[i].status && hit.t == expected[i].t && hit.cell == expected[i].cell &&
                  hit.wall == expected[i].wall)
          << fields.name << ": " << text(rays[i]) << "\n  over textures " << text(hit) << "\n  over buffers "
          << text(expected[i]);
    }
  }
  EXPECT_GT(hit_count, 2000);
}

}  // namespace
}  // namespace scarp::test
