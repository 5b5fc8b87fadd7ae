// SPDX-License-Identifier: MIT
#include "scarp/march/height/queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/device_sampling.h"
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/ray_batch.glsl.h"
#include "scarp/vk/loop_turns.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kThreads = 64;
constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  // 65,535 workgroups
constexpr std::int64_t kRaysPerPiece = 1024;

constexpr std::uint32_t kMaxMipWords[] = {
#include "scarp/march/height/max_mip.comp.inc"
};
constexpr std::uint32_t kHeightMarchesWords[] = {
#include "scarp/march/height/height_marches.comp.inc"
};

struct DeviceMarch {
  std::string_view name;
  std::span<const std::uint32_t> words;
  DeviceRay (*ray)(const HeightField& field, const Ray& ray);
  bool has_any;             // whether it can be asked for any hit
  std::uint32_t choice;     // ScarpSampling::march
  std::size_t state_bytes;  // of a march that has been interrupted
};

constexpr DeviceMarch sampling_march(std::string_view name, std::uint32_t choice) {
  return {name, kHeightMarchesWords, sampled_device_ray, false, choice, sizeof(glsl::BatchLook)};
}

constexpr std::array kDeviceMarches = {
    DeviceMarch{"max-mip", kMaxMipWords, device_ray, true, 0, sizeof(glsl::BatchWalk)},
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
      fmt::format("march '{}': does not run on Vulkan devices; there run: {}", march.name, device_march_names()));
}

glsl::ScarpSampling sampling_of(std::string_view march, const MarchSettings& settings, const DeviceTarget& target) {
  double shrink = settings.lipschitz.shrink;
  if (march == "lipschitz" && shrink == 0) {
    if (std::isnan(target.slope))
      throw Error("lipschitz: neither the field's slope bound (slope) nor a shrink factor is given");
    shrink = 1 / std::hypot(1.0, target.slope);
  }
  const HeightFieldSettings& field = target.field->settings();
  return device_sampling(march, settings, shrink, field.scale * field.exaggeration);
}

std::uint32_t checked_slice(std::uint32_t rays) {
  if (rays >= 1 && rays <= kMostRaysAtOnce) return rays;
  throw Error(fmt::format("device queries: {} rays at once; there can be 1 to {}", rays, kMostRaysAtOnce));
}

int checked_turns(int turns) {
  if (turns >= 1 && turns <= glsl::kScarpLoopTurns) return turns;
  throw Error(fmt::format("device queries: {} turns at once; there can be 1 to {}", turns, glsl::kScarpLoopTurns));
}

}  // namespace

std::string device_march_names() {
  std::string names;
  for (const DeviceMarch& march : kDeviceMarches) names += fmt::format("{}{}", names.empty() ? "" : ", ", march.name);
  return names;
}

struct DeviceQueries::Impl {
  Impl(const Device& device, const HeightMarchEntry& entry, const MarchSettings& march_settings_,
       const DeviceQuerySettings& settings)
      : march(device_march(entry)),
        march_settings(march_settings_),
        slice(checked_slice(settings.rays_at_once)),
        turns(checked_turns(settings.turns_at_once)),
        statistics(settings.statistics),
        closest(pipeline(device, false)),
        any(pipeline(device, march.has_any)),
        rays(device, std::uint64_t{slice} * sizeof(glsl::ScarpRay), "rays"),
        answers(device, std::uint64_t{slice} * sizeof(glsl::ScarpHit), "hits"),
        states(device, std::uint64_t{slice} * march.state_bytes, "states of rays"),
        commands(device) {}

  ComputePipeline pipeline(const Device& device, bool asks_any) const {
    const std::uint32_t constants[] = {kThreads, asks_any, statistics, march.choice};
    return {device, march.words, std::string(march.name) + (asks_any ? ", any" : ""), sizeof(glsl::RayBatch),
            constants};
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceTarget& target, const ComputePipeline& pipeline, std::span<const Ray> asked,
           std::span<DeviceRayCost> costs, const Answer& answer) {
    const HeightField& field = *target.field;
    glsl::RayBatch batch{};
    if (march.name != "max-mip") batch.settings = sampling_of(march.name, march_settings, target);
    batch.ground = target.ground->address();
    batch.rays = rays.address();
    batch.hits = answers.address();
    batch.states = states.address();
    batch.turns = turns;
    if (!costs.empty() && costs.size() != asked.size())
      throw Error(fmt::format("batch: {} rays, room for {} costs", asked.size(), costs.size()));
    passes.clear();
    for (std::size_t first = 0; first < asked.size(); first += slice) {
      const std::size_t count = std::min<std::size_t>(slice, asked.size() - first);
      prepared.resize(count);
      packed.resize(count);
      found.assign(count, {});
      parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          prepared[i] = march.ray(field, asked[first + i]);
          packed[i] = prepared[i].ray;
          // There is nothing to march: neither from the begin to the exit, nor over the first cell.
          if (!prepared[i].marches) packed[i].exit = -1;
        }
      });
      batch.count = static_cast<std::uint32_t>(count);
      if (field.has_cells() && !field.all_nodata()) run(pipeline, batch);
      parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          answer(first + i, prepared[i], found[i]);
          // A ray with nothing to march takes a look all the same, at nothing.
          if (!costs.empty())
            costs[first + i] = prepared[i].marches ? DeviceRayCost{found[i].steps, found[i].fetches} : DeviceRayCost{};
        }
      });
    }
  }

  // Until no march is under way.
  void run(const ComputePipeline& pipeline, glsl::RayBatch batch) {
    upload(rays, 0, packed.data(), batch.count * sizeof(glsl::ScarpRay));
    batch.resume = 0;
    do {
      commands.dispatch(pipeline, batch, {(batch.count + kThreads - 1) / kThreads, 1, 1});
      commands.run();
      passes.insert(passes.end(), commands.passes().begin(), commands.passes().end());
      download(answers, 0, found.data(), batch.count * sizeof(glsl::ScarpHit));
      batch.resume = 1;
    } while (std::any_of(found.begin(), found.end(),
                         [](const glsl::ScarpHit& hit) { return hit.status == glsl::kBatchUnderWay; }));
  }

  const DeviceMarch& march;
  MarchSettings march_settings;
  std::uint32_t slice;
  int turns;
  bool statistics;
  ComputePipeline closest, any;
  DeviceBuffer rays, answers, states;
  Commands commands;
  std::vector<PassTime> passes;
  // Of one slice.
  std::vector<DeviceRay> prepared;
  std::vector<glsl::ScarpRay> packed;
  std::vector<glsl::ScarpHit> found;
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
  if (rays.size() != hits.size())
    throw Error(fmt::format("batch: {} rays, room for {} answers", rays.size(), hits.size()));
  impl_->ask(target, impl_->closest, rays, costs,
             [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
             });
}

void DeviceQueries::occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                             std::span<DeviceRayCost> costs) {
  if (rays.size() != blocked.size())
    throw Error(fmt::format("batch: {} rays, room for {} answers", rays.size(), blocked.size()));
  impl_->ask(target, impl_->any, rays, costs,
             [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
               blocked[i] = prepared.marches && (answer.status == glsl::kScarpHit || answer.status == glsl::kScarpWall);
             });
}

const std::vector<PassTime>& DeviceQueries::passes() const { return impl_->passes; }

}  // namespace scarp
