// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "scarp/base/error.h"
#include "scarp/field/function_node.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/function/function_batch.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/sampling/device_sampling.h"
#include "scarp/march/sampling/sampling_entries.h"
#include "scarp/vk/shader_program.h"

namespace scarp {
namespace {

constexpr std::uint32_t kFunctionMarchesWords[] = {
#include "scarp/march/function/function_marches.comp.inc"
};
constexpr std::uint32_t kLipschitzLocalWords[] = {
#include "scarp/march/function/lipschitz_local.comp.inc"
};

struct DeviceMarch {
  std::string_view name;
  Sampling sampling;
  std::string_view file;  // of the shader
  std::span<const std::uint32_t> words;
  std::uint32_t choice;  // value of the shader's constant
  bool has_any;          // whether it supports any hit, with choice + 1
  int evaluations;       // maximum evaluations of the program per step
};

constexpr DeviceMarch sampling_march(const MarchEntry& march, std::uint32_t choice) {
  return {
      march.name, march.sampling, "scarp/march/function/function_marches.comp", kFunctionMarchesWords, choice, false,
      1};
}

constexpr std::array kDeviceMarches = {
    sampling_march(kNaiveEntry, glsl::kScarpNaive),
    sampling_march(kFixedStepEntry, glsl::kScarpFixedStep),
    sampling_march(kRelaxedEntry, glsl::kScarpRelaxed),
    sampling_march(kLipschitzEntry, glsl::kScarpLipschitz),
    DeviceMarch{"lipschitz-local", Sampling::none, "scarp/march/function/lipschitz_local.comp", kLipschitzLocalWords, 0,
                true, 2},
};

const DeviceMarch& device_march(const FunctionMarchEntry& march) {
  for (const DeviceMarch& candidate : kDeviceMarches) {
    if (candidate.name == march.name) return candidate;
  }
  throw Error(fmt::format("march '{}': does not run over functions on Vulkan devices (available: {})", march.name,
                          names_of(kDeviceMarches)));
}

// `parts`: function_parts(); `contents` names them.
ShaderProgram program_of(const DeviceMarch& march, bool any, std::uint32_t parts, std::string_view contents) {
  const bool asks_any = any && march.has_any;
  return {march.file,
          fmt::format("{}{}{}", march.name, asks_any ? " any" : "", contents),
          march.words,
          sizeof(glsl::FunctionBatch),
          {RayRuns<FunctionRays>::kThreads, march.choice + (asks_any ? 1 : 0), parts}};
}

glsl::ScarpSampling sampling_of(Sampling march, const MarchSettings& settings, double slope) {
  glsl::ScarpSampling result{};
  if (march == Sampling::none) {  // lipschitz-local
    result.tolerance = static_cast<float>(settings.lipschitz_local.tolerance);
    result.max_steps = settings.lipschitz_local.max_steps;
    return result;
  }
  // 2^-20 exceeds the rounding errors of the factor and the step.
  result = device_sampling(march, settings, slope, 0x1p-20, 1);
  if (march == Sampling::fixed_step) {
    result.factor = static_cast<float>(settings.function.step);
    result.least = static_cast<float>(settings.function.step_share);
  }
  return result;
}

// Steps per run: the interpreter iterates once per instruction and step.
int run_steps(std::size_t instructions, int evaluations) {
  if (instructions > static_cast<std::size_t>(glsl::kScarpMostInstructions)) {
    throw Error(
        fmt::format("terrain function: {} instructions; Vulkan devices take {}: use fewer octaves or warps, or the "
                    "CPU",
                    instructions, glsl::kScarpMostInstructions));
  }
  const int all = glsl::kScarpLoopTurns / (static_cast<int>(instructions) + 2);
  return std::max(1, (all - glsl::kScarpLastEvaluations) / evaluations);
}

}  // namespace

struct DeviceFunctionQueries::Impl {
  Impl(const Device& device_, const FunctionMarchEntry& entry, const MarchSettings& march_settings_,
       const DeviceQuerySettings& settings)
      : march(device_march(entry)),
        march_settings(march_settings_),
        device(device_),
        runs(device_, settings.rays_at_once) {}

  // Specialised for the contents of the program, on first use.
  const ComputePipeline& pipeline(const FunctionProgram& program, bool any) {
    const ShaderProgram shader = program_of(march, any, function_parts(program), "");
    const auto made = pipelines.find(shader.constants);
    if (made != pipelines.end()) return made->second;
    return pipelines.try_emplace(shader.constants, device, shader, std::string(march.name) + " over functions")
        .first->second;
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceFunctionTarget& target, bool any, std::span<const Ray> asked, const Answer& answer) {
    const FunctionProgram& program = target.function->program(target.use);
    glsl::FunctionBatch batch{};
    batch.settings = sampling_of(march.sampling, march_settings, target.function->bound_everywhere(target.use).slope);
    batch.code = target.device->address(target.use);
    batch.instructions = static_cast<std::uint32_t>(program.code.size());
    batch.result = program.result;
    batch.run_steps = run_steps(program.code.size(), march.evaluations);
    runs.ask(
        pipeline(program, any), batch, asked.size(),
        [&](std::size_t i) {
          return device_function_ray(*target.function, target.device->rounding(target.use), asked[i], target.use,
                                     march_settings.function.reach);
        },
        answer);
  }

  const DeviceMarch& march;
  MarchSettings march_settings;
  Device device;
  RayRuns<FunctionRays> runs;
  std::map<std::vector<std::uint32_t>, ComputePipeline> pipelines;  // by specialisation
};

DeviceFunctionQueries::DeviceFunctionQueries(const Device& device, const FunctionMarchEntry& march,
                                             const MarchSettings& march_settings, const DeviceQuerySettings& settings) {
  validate(march_settings);
  impl_ = std::make_unique<Impl>(device, march, march_settings, settings);
}
DeviceFunctionQueries::DeviceFunctionQueries(DeviceFunctionQueries&&) noexcept = default;
DeviceFunctionQueries& DeviceFunctionQueries::operator=(DeviceFunctionQueries&&) noexcept = default;
DeviceFunctionQueries::~DeviceFunctionQueries() = default;

void DeviceFunctionQueries::set_march_settings(const MarchSettings& march_settings) {
  validate(march_settings);
  impl_->march_settings = march_settings;
}

void DeviceFunctionQueries::closest_hits(const DeviceFunctionTarget& target, std::span<const Ray> rays,
                                         std::span<Hit> hits, std::span<std::uint32_t> steps) {
  require_room(rays.size(), hits.size(), steps.size());
  impl_->ask(target, false, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
               if (!steps.empty()) steps[i] = answer.bounds + answer.heights;
             });
}

void DeviceFunctionQueries::occluded(const DeviceFunctionTarget& target, std::span<const Ray> rays,
                                     std::span<std::uint8_t> blocked) {
  require_room(rays.size(), blocked.size(), 0);
  impl_->ask(target, true, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               blocked[i] = FunctionRays::is_hit(prepared, answer);
             });
}

const std::vector<PassTime>& DeviceFunctionQueries::passes() const { return impl_->runs.passes(); }

std::vector<ShaderProgram> function_query_shaders() {
  const HeightFunction fractal(make_function(Fractal{}));
  std::vector<ShaderProgram> all;
  for (const DeviceMarch& march : kDeviceMarches) {
    for (const bool any : {false, true}) {
      if (any && !march.has_any) continue;
      all.push_back(program_of(march, any, function_parts(fractal.program(FunctionUse::march)), " fractal"));
      all.push_back(program_of(march, any, ~0u, " all"));
    }
  }
  return all;
}

}  // namespace scarp
