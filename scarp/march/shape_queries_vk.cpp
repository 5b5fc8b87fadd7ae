// SPDX-License-Identifier: MIT
#include "scarp/march/shape_queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/march/function_batch.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/shape_batch.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kSphereTraceWords[] = {
#include "scarp/march/sphere_trace.comp.inc"
};

// Values that may follow the last step of a run, and the one that it begins with.
constexpr int kLastValues = 8;

int run_steps(std::size_t instructions) {
  return std::max(1, glsl::kScarpLoopTurns / (static_cast<int>(instructions) + 2) - kLastValues);
}

DeviceBuffer filled(const Device& device, const void* from, std::uint64_t bytes, const std::string& name) {
  DeviceBuffer buffer(device, bytes, name);
  upload(buffer, 0, from, bytes);
  return buffer;
}

}  // namespace

DeviceShape::DeviceShape(const Device& device, const DistanceField& shape)
    : code_([&] {
        const ShapeWords words = shape_words(shape.program());
        return filled(device, words.code.data(), words.code.size() * sizeof(words.code[0]), "a shape");
      }()),
      numbers_([&] {
        const ShapeWords words = shape_words(shape.program());
        return filled(device, words.numbers.data(), words.numbers.size() * sizeof(float), "a shape's numbers");
      }()) {}

struct DeviceShapeQueries::Impl {
  Impl(const Device& device_, const MarchSettings& march_settings_, const DeviceQuerySettings& settings)
      : march_settings(march_settings_), device(device_), runs(device_, settings.rays_at_once) {}

  // Made of what the program has, when it is first asked for.
  const ComputePipeline& pipeline(const DistanceProgram& program, bool any) {
    const std::uint32_t choice = any, parts = shape_parts(program);
    const auto made = pipelines.find({choice, parts});
    if (made != pipelines.end()) return made->second;
    const std::uint32_t constants[] = {RayRuns::kThreads, choice, parts};
    return pipelines
        .try_emplace({choice, parts}, device, kSphereTraceWords, "sphere-trace",
                     std::uint32_t{sizeof(glsl::ShapeBatch)}, constants)
        .first->second;
  }

  template <class Answer>
  void ask(const DeviceShapeTarget& target, bool any, std::span<const Ray> asked, const Answer& answer) {
    const DistanceProgram& program = target.shape->program();
    glsl::ShapeBatch batch{};
    batch.code = target.device->code();
    batch.numbers = target.device->numbers();
    batch.instructions = static_cast<std::uint32_t>(program.code.size());
    batch.tolerance = static_cast<float>(march_settings.sphere_trace.tolerance);
    batch.max_steps = march_settings.sphere_trace.max_steps;
    batch.run_steps = run_steps(program.code.size());
    runs.ask(
        pipeline(program, any), batch, asked.size(),
        [&](std::size_t i) { return device_shape_ray(*target.shape, asked[i]); }, answer);
  }

  MarchSettings march_settings;
  Device device;
  RayRuns runs;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ComputePipeline> pipelines;  // by choice and parts
};

DeviceShapeQueries::DeviceShapeQueries(const Device& device, const MarchEntry& march,
                                       const MarchSettings& march_settings, const DeviceQuerySettings& settings) {
  if (march.name != "sphere-trace") {
    throw Error(
        fmt::format("march '{}': does not run against shapes on Vulkan devices; there runs: sphere-trace", march.name));
  }
  validate(march_settings);
  impl_ = std::make_unique<Impl>(device, march_settings, settings);
}
DeviceShapeQueries::DeviceShapeQueries(DeviceShapeQueries&&) noexcept = default;
DeviceShapeQueries& DeviceShapeQueries::operator=(DeviceShapeQueries&&) noexcept = default;
DeviceShapeQueries::~DeviceShapeQueries() = default;

void DeviceShapeQueries::set_march_settings(const MarchSettings& march_settings) {
  validate(march_settings);
  impl_->march_settings = march_settings;
}

void DeviceShapeQueries::closest_hits(const DeviceShapeTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                                      std::span<std::uint32_t> steps) {
  if (rays.size() != hits.size() || (!steps.empty() && rays.size() != steps.size()))
    throw Error(
        fmt::format("batch: {} rays, room for {} answers and {} costs", rays.size(), hits.size(), steps.size()));
  impl_->ask(target, false, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
               if (!steps.empty()) steps[i] = answer.heights;
             });
}

void DeviceShapeQueries::occluded(const DeviceShapeTarget& target, std::span<const Ray> rays,
                                  std::span<std::uint8_t> blocked) {
  if (rays.size() != blocked.size())
    throw Error(fmt::format("batch: {} rays, room for {} answers", rays.size(), blocked.size()));
  impl_->ask(target, true, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               blocked[i] = prepared.marches && answer.status == glsl::kScarpFunctionHit;
             });
}

}  // namespace scarp
