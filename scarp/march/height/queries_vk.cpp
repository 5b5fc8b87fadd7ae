// SPDX-License-Identifier: MIT
#include "scarp/march/height/queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/march/device_sampling.h"
#include "scarp/march/height/device_march_vk.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/ray_runs_vk.h"

namespace scarp {
namespace {

// The states of interrupted marches stay on the device.
struct HeightRays {
  using Prepared = DeviceRay;
  using Ray = glsl::ScarpRay;
  using Hit = glsl::ScarpHit;
  static Hit none() { return {}; }
};

glsl::ScarpSampling sampling_of(std::string_view march, const MarchSettings& settings, const DeviceTarget& target) {
  const HeightFieldSettings& field = target.field->settings();
  return device_sampling(march, settings, target.slope, 0, field.scale * field.exaggeration);
}

// What a shader for the target is made for.
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
        march_settings(march_settings_),
        runs(device, settings.rays_at_once),
        statistics(settings.statistics),
        exact_only(settings.exact_only),
        clip_at_top(settings.clip_at_top),
        march(device, name, checked_turns(settings.turns_at_once)) {
    march.reserve(settings.rays_at_once);
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceTarget& target, bool any, std::span<const Ray> asked, std::span<DeviceRayCost> costs,
           const Answer& answer) {
    const bool exact = name == "max-mip";
    const bool starts =
        std::any_of(asked.begin(), asked.end(), [](const Ray& ray) { return ray.start == RayStart::on_surface; });
    DeviceRayQuery query{any, statistics, ground_kind(target, starts)};
    query.exact_only = exact_only || leaves_first_pass(*target.field);
    if (!exact) query.sampling = sampling_of(name, march_settings, target);
    runs.ask_there(
        [&](Commands& commands, std::uint64_t rays, std::uint64_t hits, std::uint32_t count) {
          march.begin(commands, {target.ground->address(), rays, hits, count}, query);
        },
        [&](Commands& commands) { return march.go_on(commands); }, asked.size(),
        [&](std::size_t i) {
          return exact ? device_ray(*target.field, asked[i]) : sampled_device_ray(*target.field, asked[i], clip_at_top);
        },
        [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& hit) {
          answer(i, prepared, hit);
          // The shader counts a step for a ray that does not march, too.
          if (!costs.empty()) costs[i] = prepared.marches ? DeviceRayCost{hit.steps, hit.fetches} : DeviceRayCost{};
        });
  }

  std::string_view name;
  MarchSettings march_settings;
  RayRuns<HeightRays> runs;
  bool statistics, exact_only, clip_at_top;
  DeviceHeightMarch march;
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
    hits[i] = prepared.lingers ? march_exhaustive({target.field}, rays[i]) : hit_from_device(rays[i], prepared, answer);
  });
}

void DeviceQueries::occluded(const DeviceTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                             std::span<DeviceRayCost> costs) {
  require_room(rays.size(), blocked.size(), costs.size());
  impl_->ask(target, true, rays, costs, [&](std::size_t i, const DeviceRay& prepared, const glsl::ScarpHit& answer) {
    blocked[i] = prepared.lingers
                     ? static_cast<bool>(march_exhaustive({target.field}, rays[i]))
                     : prepared.marches && (answer.status == glsl::kScarpHit || answer.status == glsl::kScarpWall);
  });
}

const std::vector<PassTime>& DeviceQueries::passes() const { return impl_->runs.passes(); }

}  // namespace scarp
