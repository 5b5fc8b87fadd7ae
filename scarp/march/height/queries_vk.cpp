// SPDX-License-Identifier: MIT
#include "scarp/march/height/queries_vk.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "scarp/base/error.h"
#include "scarp/march/device_sampling.h"
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/ray_batch.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/vk/loop_turns.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kMaxMipWords[] = {
#include "scarp/march/height/max_mip.comp.inc"
};
constexpr std::uint32_t kHeightMarchesWords[] = {
#include "scarp/march/height/height_marches.comp.inc"
};

// The states of interrupted marches stay on the device.
struct HeightRays {
  using Prepared = DeviceRay;
  using Ray = glsl::ScarpRay;
  using Hit = glsl::ScarpHit;
  static Hit none() { return {}; }
  static bool under_way(const Hit& hit) { return hit.status == glsl::kBatchUnderWay; }
};

struct DeviceMarch {
  std::string_view name;
  std::string_view file;  // of the shader
  std::span<const std::uint32_t> words;
  DeviceRay (*ray)(const HeightField& field, const Ray& ray);
  bool has_any;             // whether it can be asked for any hit
  std::uint32_t choice;     // ScarpSampling::march
  std::size_t state_bytes;  // of a march that has been interrupted
};

constexpr DeviceMarch sampling_march(std::string_view name, std::uint32_t choice) {
  return {name,
          "scarp/march/height/height_marches.comp",
          kHeightMarchesWords,
          sampled_device_ray,
          false,
          choice,
          sizeof(glsl::BatchMarch)};
}

constexpr std::array kDeviceMarches = {
    DeviceMarch{"max-mip", "scarp/march/height/max_mip.comp", kMaxMipWords, device_ray, true, 0,
                sizeof(glsl::BatchWalk)},
    sampling_march("naive", glsl::kScarpNaive),
    sampling_march("fixed-step", glsl::kScarpFixedStep),
    sampling_march("relaxed", glsl::kScarpRelaxed),
    sampling_march("lipschitz", glsl::kScarpLipschitz),
};

const DeviceMarch& device_march(const HeightMarchEntry& march) {
  for (const DeviceMarch& candidate : kDeviceMarches) {
    if (candidate.name == march.name) return candidate;
  }
  throw Error(
      fmt::format("march '{}': does not run on Vulkan devices (available: {})", march.name, device_march_names()));
}

ShaderProgram program_of(const DeviceMarch& march, bool asks_any, bool statistics) {
  return {march.file,
          std::string(march.name) + (asks_any ? " any" : ""),
          march.words,
          sizeof(glsl::RayBatch),
          {RayRuns<HeightRays>::kThreads, asks_any, statistics, march.choice}};
}

glsl::ScarpSampling sampling_of(std::string_view march, const MarchSettings& settings, const DeviceTarget& target) {
  const HeightFieldSettings& field = target.field->settings();
  return device_sampling(march, settings, target.slope, 0, field.scale * field.exaggeration);
}

int checked_turns(int turns) {
  if (turns >= 1 && turns <= glsl::kScarpLoopTurns) return turns;
  throw Error(fmt::format("device queries: {} turns at once (must be 1 to {})", turns, glsl::kScarpLoopTurns));
}

}  // namespace

std::string device_march_names() { return names_of(kDeviceMarches); }

std::vector<ShaderProgram> height_query_shaders() {
  std::vector<ShaderProgram> all;
  for (const DeviceMarch& march : kDeviceMarches) {
    all.push_back(program_of(march, false, false));
    if (march.has_any) all.push_back(program_of(march, true, false));
  }
  return all;
}

struct DeviceQueries::Impl {
  Impl(const Device& device, const HeightMarchEntry& entry, const MarchSettings& march_settings_,
       const DeviceQuerySettings& settings)
      : march(device_march(entry)),
        march_settings(march_settings_),
        turns(checked_turns(settings.turns_at_once)),
        statistics(settings.statistics),
        closest(pipeline(device, false)),
        any(pipeline(device, march.has_any)),
        runs(device, settings.rays_at_once),
        states(device, settings.rays_at_once * std::uint64_t{march.state_bytes}, "states of rays") {}

  ComputePipeline pipeline(const Device& device, bool asks_any) const {
    const ShaderProgram program = program_of(march, asks_any, statistics);
    return {device, program, program.variant};
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceTarget& target, const ComputePipeline& pipeline, std::span<const Ray> asked,
           std::span<DeviceRayCost> costs, const Answer& answer) {
    glsl::RayBatch batch{};
    if (march.name != "max-mip") batch.settings = sampling_of(march.name, march_settings, target);
    batch.ground = target.ground->address();
    batch.states = states.address();
    batch.turns = turns;
    runs.ask(
        pipeline, batch, asked.size(), [&](std::size_t i) { return march.ray(*target.field, asked[i]); },
        [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& hit) {
          answer(i, prepared, hit);
          // The shader counts a step for a ray that does not march, too.
          if (!costs.empty()) costs[i] = prepared.marches ? DeviceRayCost{hit.steps, hit.fetches} : DeviceRayCost{};
        });
  }

  const DeviceMarch& march;
  MarchSettings march_settings;
  int turns;
  bool statistics;
  ComputePipeline closest, any;
  RayRuns<HeightRays> runs;
  DeviceBuffer states;
};

DeviceQueries::DeviceQueries(const Device& device, const HeightMarchEntry& march, const MarchSettings& march_settings,
                             const DeviceQuerySettings& settings) {
  validate(march_settings);
  impl_ = std::make_unique<Impl>(device, march, march_settings, settings);
}
DeviceQueries::DeviceQueries(DeviceQueries&&) noexcept = default;
DeviceQueries& DeviceQueries::operator=(DeviceQueries&&) noexcept = default;
DeviceQueries::~DeviceQueries() = default;

void DeviceQueries::set_march_settings(const MarchSettings& march_settings) {
  validate(march_settings);
  impl_->march_settings = march_settings;
}

void DeviceQueries::closest_hits(const DeviceTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                                 std::span<DeviceRayCost> costs) {
  require_room(rays.size(), hits.size(), costs.size());
  impl_->ask(target, impl_->closest, rays, costs,
             [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
             });
}

void DeviceQueries::occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                             std::span<DeviceRayCost> costs) {
  require_room(rays.size(), blocked.size(), costs.size());
  impl_->ask(target, impl_->any, rays, costs,
             [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
               blocked[i] = prepared.marches && (answer.status == glsl::kScarpHit || answer.status == glsl::kScarpWall);
             });
}

const std::vector<PassTime>& DeviceQueries::passes() const { return impl_->runs.passes(); }

}  // namespace scarp
