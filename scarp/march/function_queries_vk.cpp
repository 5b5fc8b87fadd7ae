// SPDX-License-Identifier: MIT
#include "scarp/march/function_queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/device_function_ray.h"
#include "scarp/march/function_batch.glsl.h"
#include "scarp/march/function_marches.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kThreads = 64;
constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  // 65,535 workgroups
constexpr std::int64_t kRaysPerPiece = 1024;

constexpr std::uint32_t kFunctionMarchesWords[] = {
#include "scarp/march/function_marches.comp.inc"
};
constexpr std::uint32_t kLipschitzLocalWords[] = {
#include "scarp/march/lipschitz_local.comp.inc"
};

struct DeviceMarch {
  std::string_view name;
  std::span<const std::uint32_t> words;
  std::uint32_t choice;  // the shader's
  bool has_any;          // whether it can be asked for any hit, by the next choice
};
constexpr std::array kDeviceMarches = {
    DeviceMarch{"naive", kFunctionMarchesWords, glsl::kScarpFunctionNaive, false},
    DeviceMarch{"fixed-step", kFunctionMarchesWords, glsl::kScarpFunctionFixedStep, false},
    DeviceMarch{"relaxed", kFunctionMarchesWords, glsl::kScarpFunctionRelaxed, false},
    DeviceMarch{"lipschitz", kFunctionMarchesWords, glsl::kScarpFunctionLipschitz, false},
    DeviceMarch{"lipschitz-local", kLipschitzLocalWords, 0, true},
};

const DeviceMarch& device_march(const MarchEntry& march) {
  std::string names;
  for (const DeviceMarch& candidate : kDeviceMarches) {
    if (candidate.name == march.name) return candidate;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", candidate.name);
  }
  throw Error(
      fmt::format("march '{}': does not run over functions on Vulkan devices; there run: {}", march.name, names));
}

void set_refinement(glsl::FunctionBatch& batch, Refinement refinement, int halvings) {
  batch.refinement = refinement == Refinement::secant   ? glsl::kScarpRefineSecant
                     : refinement == Refinement::bisect ? glsl::kScarpRefineBisect
                                                        : glsl::kScarpRefineNone;
  batch.halvings = halvings;
}

glsl::FunctionBatch batch_settings(std::string_view march, const MarchSettings& settings, double slope) {
  glsl::FunctionBatch batch{};
  set_refinement(batch, settings.function.refinement, settings.function.halvings);
  batch.metres = static_cast<float>(settings.function.tolerance);
  if (march == "naive") {
    batch.factor = static_cast<float>(settings.naive.step_factor);
    batch.least = static_cast<float>(settings.naive.min_step);
    batch.tolerance = static_cast<float>(settings.naive.tolerance);
    batch.max_steps = settings.naive.max_steps;
  } else if (march == "fixed-step") {
    batch.factor = static_cast<float>(settings.function.step);
    batch.least = static_cast<float>(settings.function.step_share);
    batch.max_steps = settings.fixed_step.max_steps;
    if (settings.function.refinement == Refinement::none && settings.fixed_step.interpolate)
      batch.refinement = glsl::kScarpRefineSecant;
  } else if (march == "relaxed") {
    batch.factor = static_cast<float>(settings.relaxed.step_factor);
    batch.tolerance = static_cast<float>(settings.relaxed.tolerance);
    batch.max_steps = settings.relaxed.max_steps;
  } else if (march == "lipschitz") {
    // Less by more than its roundings, here and in the step.
    const double shrink =
        settings.lipschitz.shrink > 0 ? settings.lipschitz.shrink : (1 - 0x1p-20) / std::hypot(1.0, slope);
    batch.factor = static_cast<float>(shrink);
    batch.tolerance = static_cast<float>(settings.lipschitz.tolerance);
    batch.max_steps = settings.lipschitz.max_steps;
  } else {
    batch.tolerance = static_cast<float>(settings.lipschitz_local.tolerance);
    batch.max_steps = settings.lipschitz_local.max_steps;
  }
  return batch;
}

// Steps until a march is interrupted: the interpreter's loop turns once per instruction and step.
int run_steps(std::size_t instructions) {
  if (instructions > static_cast<std::size_t>(glsl::kScarpMostInstructions)) {
    throw Error(
        fmt::format("terrain function: {} instructions; Vulkan devices take {}: use fewer octaves or warps, or the "
                    "CPU",
                    instructions, glsl::kScarpMostInstructions));
  }
  return std::max(1, glsl::kScarpLoopTurns / (static_cast<int>(instructions) + 2) - glsl::kScarpLastEvaluations);
}

std::uint32_t checked_slice(std::uint32_t rays) {
  if (rays >= 1 && rays <= kMostRaysAtOnce) return rays;
  throw Error(fmt::format("device queries: {} rays at once; there can be 1 to {}", rays, kMostRaysAtOnce));
}

}  // namespace

struct DeviceFunctionQueries::Impl {
  Impl(const Device& device_, const MarchEntry& entry, const MarchSettings& march_settings_,
       const DeviceQuerySettings& settings)
      : march(device_march(entry)),
        march_settings(march_settings_),
        slice(checked_slice(settings.rays_at_once)),
        device(device_),
        rays(device, std::uint64_t{slice} * sizeof(glsl::ScarpFunctionRay), "rays"),
        answers(device, std::uint64_t{slice} * sizeof(glsl::ScarpFunctionHit), "hits"),
        commands(device) {}

  // Made of what the program has, when it is first asked for.
  const ComputePipeline& pipeline(const FunctionProgram& program, bool any) {
    const std::uint32_t choice = march.choice + (any && march.has_any ? 1 : 0), parts = function_parts(program);
    const auto made = pipelines.find({choice, parts});
    if (made != pipelines.end()) return made->second;
    const std::uint32_t constants[] = {kThreads, choice, parts};
    return pipelines
        .try_emplace({choice, parts}, device, march.words, std::string(march.name) + " over functions",
                     std::uint32_t{sizeof(glsl::FunctionBatch)}, constants)
        .first->second;
  }

  // Calls answer(i, prepared, hit) for each ray, on all threads.
  template <class Answer>
  void ask(const DeviceFunctionTarget& target, bool any, std::span<const Ray> asked, const Answer& answer) {
    const FunctionProgram& program = target.function->program(target.use);
    const ComputePipeline& shader = pipeline(program, any);
    glsl::FunctionBatch batch =
        batch_settings(march.name, march_settings, target.function->bound_everywhere(target.use).slope);
    batch.code = target.device->address(target.use);
    batch.rays = rays.address();
    batch.hits = answers.address();
    batch.instructions = static_cast<std::uint32_t>(program.code.size());
    batch.result = program.result;
    batch.run_steps = run_steps(program.code.size());
    passes.clear();
    for (std::size_t first = 0; first < asked.size(); first += slice) {
      const std::size_t count = std::min<std::size_t>(slice, asked.size() - first);
      prepared.resize(count);
      packed.clear();
      place.resize(count);
      parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          prepared[i] = device_function_ray(*target.function, target.device->rounding(target.use), asked[first + i],
                                            target.use, march_settings.function.reach);
        }
      });
      // Rays that never come down to the ground's heights stay here.
      for (std::size_t i = 0; i < count; ++i) {
        place[i] = packed.size();
        if (prepared[i].marches) packed.push_back(prepared[i].ray);
      }
      found.assign(packed.size(), glsl::scarp_function_miss());
      run(shader, batch);
      parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          answer(first + i, prepared[i], prepared[i].marches ? found[place[i]] : glsl::scarp_function_miss());
        }
      });
    }
  }

  // Marches what was packed, run after run until none is under way.
  void run(const ComputePipeline& pipeline, glsl::FunctionBatch batch) {
    open.resize(packed.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    while (!open.empty()) {
      batch.count = static_cast<std::uint32_t>(open.size());
      answered.resize(open.size());
      upload(rays, 0, packed.data(), open.size() * sizeof(glsl::ScarpFunctionRay));
      commands.dispatch(pipeline, batch, {(batch.count + kThreads - 1) / kThreads, 1, 1});
      commands.run();
      passes.insert(passes.end(), commands.passes().begin(), commands.passes().end());
      download(answers, 0, answered.data(), open.size() * sizeof(glsl::ScarpFunctionHit));
      std::size_t left = 0;
      for (std::size_t i = 0; i < answered.size(); ++i) {
        glsl::ScarpFunctionHit& hit = found[open[i]];
        const std::uint32_t bounds = hit.bounds, heights = hit.heights;
        hit = answered[i];
        hit.bounds += bounds;
        hit.heights += heights;
        if (hit.status != glsl::kScarpFunctionUnderWay) continue;
        packed[left] = packed[i];
        packed[left].state = hit.state;
        open[left++] = open[i];
      }
      open.resize(left);
    }
  }

  const DeviceMarch& march;
  MarchSettings march_settings;
  std::uint32_t slice;
  Device device;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ComputePipeline> pipelines;  // by choice and parts
  DeviceBuffer rays, answers;
  Commands commands;
  std::vector<PassTime> passes;
  // Of one slice.
  std::vector<DeviceFunctionRay> prepared;
  std::vector<glsl::ScarpFunctionRay> packed;
  std::vector<std::size_t> place;
  std::vector<glsl::ScarpFunctionHit> found;
  // Of one run: those under way, by their places, and what the device tells of them.
  std::vector<std::size_t> open;
  std::vector<glsl::ScarpFunctionHit> answered;
};

DeviceFunctionQueries::DeviceFunctionQueries(const Device& device, const MarchEntry& march,
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
  if (rays.size() != hits.size() || (!steps.empty() && rays.size() != steps.size()))
    throw Error(
        fmt::format("batch: {} rays, room for {} answers and {} costs", rays.size(), hits.size(), steps.size()));
  impl_->ask(target, false, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
               if (!steps.empty()) steps[i] = answer.bounds + answer.heights;
             });
}

void DeviceFunctionQueries::occluded(const DeviceFunctionTarget& target, std::span<const Ray> rays,
                                     std::span<std::uint8_t> blocked) {
  if (rays.size() != blocked.size())
    throw Error(fmt::format("batch: {} rays, room for {} answers", rays.size(), blocked.size()));
  impl_->ask(target, true, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               blocked[i] = prepared.marches && answer.status == glsl::kScarpFunctionHit;
             });
}

const std::vector<PassTime>& DeviceFunctionQueries::passes() const { return impl_->passes; }

}  // namespace scarp
