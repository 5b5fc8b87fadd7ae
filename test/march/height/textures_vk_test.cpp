// SPDX-License-Identifier: MIT
// The marches over textures, as WebGL has them, on a Vulkan device: the answers match those over buffers, bit for bit,
// because the same source runs on the same numbers. parity_vk_test.cpp judges the answers over buffers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "march/height/texture_levels.h"
#include "march/height/textures_vk.glsl.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/sampling/device_sampling.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/raii.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

constexpr std::uint32_t kWords[] = {
#include "test/march/height/textures_vk.comp.inc"
};
constexpr std::uint32_t kThreads = 64;

// The test has its own commands: the station supports neither images nor descriptors.
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
  Texture(const Device& open, const std::vector<TextureLevel>& levels, std::uint32_t channels)
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
      const TextureLevel& of = levels[level];
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

// The pipeline with its two textures.
class TextureMarch {
 public:
  TextureMarch(const Device& open, std::int32_t march, bool any, std::uint32_t sampled)
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
    const vk::Bool32 constants[] = {static_cast<vk::Bool32>(march), any, sampled};
    const vk::SpecializationMapEntry entries[] = {
        {0, 0, sizeof constants[0]}, {1, 4, sizeof constants[1]}, {2, 8, sizeof constants[2]}};
    const vk::SpecializationInfo specialised(3, entries, sizeof constants, constants);
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &specialised);
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

// A march over buffers and over textures, with the same settings.
struct Realisation {
  std::string_view name;
  std::int32_t constant;
  DeviceRay (*prepare)(const HeightField& field, const Ray& ray);
  glsl::ScarpSampling settings;
};

constexpr int kMostSteps = 300;

MarchSettings march_settings() {
  MarchSettings settings;
  settings.naive.max_steps = settings.fixed_step.max_steps = settings.relaxed.max_steps = kMostSteps;
  settings.lipschitz.max_steps = kMostSteps;
  settings.sampling = {.refinement = Refinement::bisect, .halvings = 5};
  return settings;
}

DeviceRay sampled(const HeightField& field, const Ray& ray) { return sampled_device_ray(field, ray); }
DeviceRay exact(const HeightField& field, const Ray& ray) { return device_ray(field, ray); }

std::vector<Realisation> realisations(double slope) {
  std::vector<Realisation> all = {{"max-mip", glsl::kTexturesMaxMip, exact, {}}};
  for (const std::string_view name : {"naive", "fixed-step", "relaxed", "lipschitz"}) {
    all.push_back({name, glsl::kTexturesSampled, sampled,
                   device_sampling(find_height_march(name).sampling, march_settings(), slope, 0, 1)});
  }
  return all;
}

TEST(TexturesLayout, MatchesTheShader) { EXPECT_TRUE(is_laid_out_like<glsl::TexturesPush>(kWords)); }

class TexturesOnDevice : public OnDevice {};

TEST_F(TexturesOnDevice, EveryMarchMatchesBuffers) {
  constexpr int kRaysPerKind = 8;
  std::map<std::string_view, DeviceQueries> over_buffers;
  std::map<std::pair<std::string_view, bool>, TextureMarch> over_textures;
  for (const Realisation& of : realisations(0)) {
    over_buffers.try_emplace(of.name, device(), find_height_march(of.name), march_settings(),
                             DeviceQuerySettings{.exact_only = true});
    over_textures.try_emplace({of.name, false}, device(), of.constant, false, of.settings.march);
  }
  over_textures.try_emplace({"max-mip", true}, device(), glsl::kTexturesMaxMip, true, 0);
  EXPECT_EQ(over_buffers.size(),
            static_cast<std::size_t>(std::count_if(height_marches().begin(), height_marches().end(),
                                                   [](const auto& march) { return march.gpu; })));
  std::map<std::string_view, int> hit_counts;
  for (const FieldKind& fields : spiteful_fields()) {
    Random random(5);
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    const MaxPyramid pyramid(field);
    const DeviceGround ground(device(), field);
    const DeviceTarget target{&field, &ground, slope_bound(field)};
    const Texture heights(device(), heights_of(field), 1), bounds(device(), bounds_of(pyramid), 2);
    std::vector<Ray> rays;
    for (const RayKind& kind : spiteful_rays()) {
      if ((fields.has & kind.aims_at) != kind.aims_at) continue;
      for (int i = 0; i < kRaysPerKind; ++i) rays.push_back(kind.make(field, random));
    }
    for (const Realisation& of : realisations(target.slope)) {
      SCOPED_TRACE(std::string(of.name) + " on " + std::string(fields.name));
      std::vector<DeviceRay> prepared;
      std::vector<glsl::ScarpRay> packed;
      for (const Ray& ray : rays) {
        prepared.push_back(of.prepare(field, ray));
        packed.push_back(prepared.back().ray);
        // There are no cells.
        if (!prepared.back().marches) packed.back().exit = -1;
      }
      const DeviceBuffer on_device(device(), packed.size() * sizeof packed[0], "rays");
      upload(on_device, 0, packed.data(), packed.size() * sizeof packed[0]);
      const DeviceBuffer found(device(), rays.size() * sizeof(glsl::ScarpHit), "hits");
      glsl::TexturesPush push{};
      push.settings = of.settings;
      push.rays = on_device.address();
      push.hits = found.address();
      push.field = device_field(field, &pyramid);
      push.nodata = static_cast<float>(field.settings().nodata.value_or(NAN));
      push.count = static_cast<std::uint32_t>(rays.size());
      const auto ask = [&](bool any) {
        over_textures.at({of.name, any}).dispatch(heights, bounds, push);
        std::vector<glsl::ScarpHit> answers(rays.size());
        download(found, 0, answers.data(), answers.size() * sizeof answers[0]);
        std::vector<Hit> hits;
        for (std::size_t i = 0; i < rays.size(); ++i) hits.push_back(hit_from_device(rays[i], prepared[i], answers[i]));
        return hits;
      };
      std::vector<Hit> expected(rays.size());
      over_buffers.at(of.name).closest_hits(target, rays, expected);
      const std::vector<Hit> hits = ask(false);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        hit_counts[of.name] += static_cast<bool>(hits[i]);
        // Over buffers the host traces rays that stay on a line.
        if (prepared[i].lingers) continue;
        ASSERT_TRUE(hits[i].status == expected[i].status && hits[i].t == expected[i].t &&
                    hits[i].cell == expected[i].cell && hits[i].wall == expected[i].wall)
            << text(rays[i]) << "\n  over textures " << text(hits[i]) << "\n  over buffers " << text(expected[i]);
      }
      if (of.name != "max-mip") continue;
      std::vector<std::uint8_t> blocked(rays.size());
      over_buffers.at(of.name).occluded(target, rays, blocked);
      const std::vector<Hit> any = ask(true);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (prepared[i].lingers) continue;
        ASSERT_EQ(static_cast<bool>(any[i]), blocked[i] != 0) << "any: " << text(rays[i]);
      }
    }
  }
  for (const auto& [march, count] : hit_counts) EXPECT_GT(count, 400) << march;
}

}  // namespace
}  // namespace scarp::test
