// SPDX-License-Identifier: MIT
#include "scarp/march/height/queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/march/height/device_march_vk.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/ray_blocks.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/sampling/device_sampling.h"
#include "scarp/vk/shader_program.h"

namespace scarp {
namespace {

struct HeightRays {
  using Prepared = DeviceRay;
  using Hit = glsl::ScarpHit;
  static Hit none() { return {}; }
};

// Rays and results are stored in blocks, and the states of interrupted marches stay on the device.
class HeightRuns : public RaySlices<HeightRays> {
 public:
  HeightRuns(const Device& device, std::uint32_t rays_at_once)
      : RaySlices(device, rays_at_once),
        rays_(device, glsl::ray_blocks(slice_) * sizeof(glsl::RayBlock), "rays"),
        answers_(device, glsl::ray_blocks(slice_) * sizeof(glsl::HitBlock), "hits") {}

  // begin(commands, rays, hits, count) records the first run of a march on buffers at these addresses,
  // go_on(commands) the next one, or returns false if there is none.
  template <class Begin, class GoOn, class Prepare, class Answer>
  void ask(const Begin& begin, const GoOn& go_on, std::size_t count, const Prepare& prepare, const Answer& answer) {
    ask_in_slices(count, prepare, answer, [&] {
      // Each ray keeps its index. Those that do not march end at once.
      const std::size_t blocks = glsl::ray_blocks(prepared_.size());
      packed_.resize(blocks);
      for_each_ray([&](std::size_t block, std::uint32_t i, std::size_t ray) {
        glsl::put_ray({packed_[block]}, i, prepared_[ray].ray);
      });
      upload(rays_, 0, packed_.data(), blocks * sizeof(glsl::RayBlock));
      begin(commands_, rays_.address(), answers_.address(), static_cast<std::uint32_t>(prepared_.size()));
      do run();
      while (go_on(commands_));
      answered_.resize(blocks);
      download(answers_, 0, answered_.data(), blocks * sizeof(glsl::HitBlock));
      for_each_ray([&](std::size_t block, std::uint32_t i, std::size_t ray) {
        found_[ray] = glsl::hit_of_block({answered_[block]}, i);
      });
    });
  }

  // Marches the rays of the last slice again, which are still in device memory.
  template <class Begin, class GoOn>
  void ask_again(const Begin& begin, const GoOn& go_on) {
    passes_.clear();
    if (packed_.empty()) return;
    begin(commands_, rays_.address(), answers_.address(), static_cast<std::uint32_t>(prepared_.size()));
    do run();
    while (go_on(commands_));
  }

 private:
  // body(block, i, ray) for each ray of the slice, the i-th of a block.
  template <class Body>
  void for_each_ray(const Body& body) const {
    static_assert(kRaysPerPiece % glsl::kRayBlock == 0);
    for_each(prepared_.size(), [&](std::size_t ray) {
      body(ray / glsl::kRayBlock, static_cast<std::uint32_t>(ray % glsl::kRayBlock), ray);
    });
  }

  DeviceBuffer rays_, answers_;
  std::vector<glsl::RayBlock> packed_;
  std::vector<glsl::HitBlock> answered_;
};

glsl::ScarpSampling sampling_of(Sampling march, const MarchSettings& settings, const DeviceTarget& target) {
  const HeightFieldSettings& field = target.field->settings();
  return device_sampling(march, settings, target.slope, 0, field.scale * field.exaggeration);
}

// Answers rays that DeviceRay::lingers keeps off the device.
Hit on_host(const DeviceTarget& target, const Ray& ray) {
  return march_exhaustive({.field = target.field, .seam = target.seam}, ray);
}

// The kind of ground that a shader for the target is specialised for.
std::uint32_t ground_kind(const DeviceTarget& target, bool starts) {
  return glsl::batch_ground_kind(device_field(*target.field, nullptr).flags | (starts ? glsl::kScarpStarts : 0),
                                 target.ground->layout().sample_type);
}

int checked_turns(int turns) {
  if (turns >= 1 && turns <= glsl::kScarpLoopTurns) return turns;
  throw Error(fmt::format("device queries: {} turns at once (must be 1 to {})", turns, glsl::kScarpLoopTurns));
}

}  // namespace

std::string device_march_names() { return DeviceHeightMarch::names(); }

std::vector<ShaderProgram> height_query_shaders() { return DeviceHeightMarch::shaders(); }

struct DeviceQueries::Impl {
  Impl(const Device& device, const HeightMarchEntry& entry, const MarchSettings& march_settings_,
       const DeviceQuerySettings& settings)
      : name(entry.name),
        sampling(entry.sampling),
        march_settings(march_settings_),
        runs(device, settings.rays_at_once),
        statistics(settings.statistics),
        exact_only(settings.exact_only),
        clip_at_top(settings.clip_at_top),
        march(device, name, checked_turns(settings.turns_at_once)) {
    march.reserve(settings.rays_at_once);
  }

  // Records the first run of a march.
  auto begin(std::uint64_t ground, const DeviceRayQuery& query) {
    return [this, ground, query](Commands& commands, std::uint64_t rays, std::uint64_t hits, std::uint32_t count) {
      march.begin(commands, {ground, rays, hits, count}, query);
    };
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceTarget& target, bool any, std::span<const Ray> asked, std::span<DeviceRayCost> costs,
           const Answer& answer) {
    const bool exact = sampling == Sampling::none;  // max-mip
    const bool starts =
        std::any_of(asked.begin(), asked.end(), [](const Ray& ray) { return ray.start == RayStart::on_surface; });
    DeviceRayQuery query{any, statistics, ground_kind(target, starts)};
    query.exact_only = exact_only || leaves_first_pass(*target.field);
    if (!exact) query.sampling = sampling_of(sampling, march_settings, target);
    last_ground = target.ground->address();
    last_query = query;
    runs.ask(
        begin(target.ground->address(), query), [&](Commands& commands) { return march.go_on(commands); }, asked.size(),
        [&](std::size_t i) {
          return exact ? device_ray(*target.field, asked[i], target.seam)
                       : sampled_device_ray(*target.field, asked[i], clip_at_top);
        },
        [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& hit) {
          answer(i, prepared, hit);
          // The shader also counts a step for a ray that does not march.
          if (!costs.empty()) costs[i] = prepared.marches ? DeviceRayCost{hit.steps, hit.fetches} : DeviceRayCost{};
        });
  }

  void ask_again() {
    runs.ask_again(begin(last_ground, last_query), [&](Commands& commands) { return march.go_on(commands); });
  }

  std::string_view name;
  Sampling sampling;
  MarchSettings march_settings;
  HeightRuns runs;
  bool statistics, exact_only, clip_at_top;
  DeviceHeightMarch march;
  std::uint64_t last_ground = 0;
  DeviceRayQuery last_query{};
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
  impl_->ask(target, false, rays, costs, [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
    hits[i] = prepared.lingers ? on_host(target, rays[i]) : hit_from_device(rays[i], prepared, answer);
  });
}

void DeviceQueries::occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                             std::span<DeviceRayCost> costs) {
  require_room(rays.size(), blocked.size(), costs.size());
  impl_->ask(target, true, rays, costs, [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
    blocked[i] = prepared.lingers
                     ? static_cast<bool>(on_host(target, rays[i]))
                     : prepared.marches && (answer.status == glsl::kScarpHit || answer.status == glsl::kScarpWall);
  });
}

void DeviceQueries::march_again() { impl_->ask_again(); }

const std::vector<PassTime>& DeviceQueries::passes() const { return impl_->runs.passes(); }

}  // namespace scarp
