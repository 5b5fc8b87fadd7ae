// SPDX-License-Identifier: MIT
#include "scarp/march/shape/shape_queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "scarp/base/error.h"
#include "scarp/march/function/device_function_ray.h"
#include "scarp/march/function/function_batch.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/shape/shape_batch.glsl.h"
#include "scarp/vk/shader_program.h"

namespace scarp {
namespace {

constexpr std::uint32_t kSphereTraceWords[] = {
#include "scarp/march/shape/sphere_trace.comp.inc"
};

// Values that may follow the last step of a run, and its first one.
constexpr int kLastValues = 8;

int run_steps(std::size_t turns) {
  return std::max(1, glsl::kScarpLoopTurns / (static_cast<int>(turns) + 2) - kLastValues);
}

// Iterations of the interpreter: one per instruction, plus those of grounds.
std::size_t turns_of(const DistanceProgram& program) {
  constexpr std::size_t kRim = 9;
  std::size_t turns = program.code.size();
  for (const DistanceInstruction& in : program.code) {
    if (in.op == DistanceOp::function_ground)
      turns += program.functions[in.index]->program(FunctionUse::march).code.size();
    if (in.op == DistanceOp::field_ground && program.holes[in.index]) turns += kRim;
  }
  // A run has some steps besides the values that may follow the last.
  constexpr std::size_t kMost = static_cast<std::size_t>(glsl::kScarpLoopTurns) / (2 * kLastValues);
  if (turns > kMost) {
    throw Error(
        fmt::format("shape: {} instructions, those of its functions included; Vulkan devices take {}: use fewer solids "
                    "or octaves, several objects, or the CPU",
                    turns, kMost));
  }
  return turns;
}

// `parts`: shape_parts(), `functions`: shape_function_parts(); `contents` names both.
ShaderProgram program_of(bool any, std::uint32_t parts, std::uint32_t functions, std::string_view contents) {
  return {"scarp/march/shape/sphere_trace.comp",
          fmt::format("sphere-trace{}{}", any ? " any" : "", contents),
          kSphereTraceWords,
          sizeof(glsl::ShapeBatch),
          {RayRuns<FunctionRays>::kThreads, any, parts, functions}};
}

DeviceBuffer filled(const Device& device, const void* from, std::uint64_t bytes, const std::string& name) {
  DeviceBuffer buffer(device, bytes, name);
  upload(buffer, 0, from, bytes);
  return buffer;
}

}  // namespace

DeviceShape::DeviceShape(const Device& device, const DistanceField& shape)
    : DeviceShape(device, shape, shape_words(shape.program())) {}

DeviceShape::DeviceShape(const Device& device, const DistanceField& shape, const ShapeWords& words)
    : rounding_(shape),
      code_(filled(device, words.code.data(), words.code.size() * sizeof(words.code[0]), "a shape")),
      numbers_(filled(device, words.numbers.data(), words.numbers.size() * sizeof(float), "a shape's numbers")),
      grounds_(device,
               (shape.program().functions.size() + shape.program().fields.size() + 1) * sizeof(glsl::ScarpShapeGround),
               "a shape's grounds"),
      turns_(turns_of(shape.program())) {
  const DistanceProgram& program = shape.program();
  std::vector<glsl::ScarpShapeGround> grounds;
  for (const auto& function : program.functions) {
    functions_.emplace_back(device, *function);
    const FunctionProgram& march = function->program(FunctionUse::march);
    glsl::ScarpShapeGround ground{};
    ground.data = functions_.back().address(FunctionUse::march);
    ground.count = static_cast<std::uint32_t>(march.code.size());
    ground.result = march.result;
    grounds.push_back(ground);
  }
  for (std::size_t i = 0; i < program.fields.size(); ++i) {
    glsl::ScarpShapeGround ground{};
    fields_.emplace_back(device, *program.fields[i]);
    ground.data = fields_.back().address();
    if (program.holes[i]) {
      fields_.emplace_back(device, *program.holes[i]);
      ground.holes = fields_.back().address();
      ground.has_holes = 1;
    }
    grounds.push_back(ground);
  }
  if (!grounds.empty()) upload(grounds_, 0, grounds.data(), grounds.size() * sizeof(grounds[0]));
}

struct DeviceShapeQueries::Impl {
  Impl(const Device& device_, const MarchSettings& march_settings_, const DeviceQuerySettings& settings)
      : march_settings(march_settings_), device(device_), runs(device_, settings.rays_at_once) {}

  // Specialised for the contents of the program, on first use.
  const ComputePipeline& pipeline(const DistanceProgram& program, bool any) {
    const ShaderProgram shader = program_of(any, shape_parts(program), shape_function_parts(program), "");
    const auto made = pipelines.find(shader.constants);
    if (made != pipelines.end()) return made->second;
    return pipelines.try_emplace(shader.constants, device, shader, "sphere-trace").first->second;
  }

  template <class Answer>
  void ask(const DeviceShapeTarget& target, bool any, std::span<const Ray> asked, const Answer& answer) {
    const DistanceProgram& program = target.shape->program();
    glsl::ShapeBatch batch{};
    batch.code = target.device->code();
    batch.numbers = target.device->numbers();
    batch.grounds = target.device->grounds();
    batch.growth = static_cast<float>(shape_ray_growth(target.device->rounding()) * (1 + 0x1p-20));
    batch.instructions = static_cast<std::uint32_t>(program.code.size());
    batch.tolerance = static_cast<float>(march_settings.sphere_trace.tolerance);
    batch.max_steps = march_settings.sphere_trace.max_steps;
    batch.run_steps = run_steps(target.device->turns());
    runs.ask(
        pipeline(program, any), batch, asked.size(),
        [&](std::size_t i) { return device_shape_ray(*target.shape, target.device->rounding(), asked[i]); }, answer);
  }

  MarchSettings march_settings;
  Device device;
  RayRuns<FunctionRays> runs;
  std::map<std::vector<std::uint32_t>, ComputePipeline> pipelines;  // by specialisation
};

DeviceShapeQueries::DeviceShapeQueries(const Device& device, const ShapeMarchEntry& march,
                                       const MarchSettings& march_settings, const DeviceQuerySettings& settings) {
  if (!march.gpu) {
    throw Error(
        fmt::format("march '{}': does not run on shapes on Vulkan devices (available: sphere-trace)", march.name));
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
  require_room(rays.size(), hits.size(), steps.size());
  impl_->ask(target, false, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               hits[i] = hit_from_device(rays[i], prepared, answer);
               if (!steps.empty()) steps[i] = answer.heights;
             });
}

void DeviceShapeQueries::occluded(const DeviceShapeTarget& target, std::span<const Ray> rays,
                                  std::span<std::uint8_t> blocked) {
  require_room(rays.size(), blocked.size(), 0);
  impl_->ask(target, true, rays,
             [&](std::size_t i, const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
               blocked[i] = FunctionRays::is_hit(prepared, answer);
             });
}

std::vector<ShaderProgram> shape_query_shaders() {
  constexpr std::uint32_t kFields = 1u << glsl::kScarpShapeFieldGround,
                          kGrounds = kFields | 1u << glsl::kScarpShapeFunctionGround;
  std::vector<ShaderProgram> all;
  for (const bool any : {false, true}) {
    all.push_back(program_of(any, 1u << glsl::kScarpShapeSphere, 0, " sphere"));
    all.push_back(program_of(any, ~kGrounds, 0, " solids"));
    all.push_back(program_of(any, kFields, 0, " field"));
    all.push_back(program_of(any, ~0u, ~0u, " all"));
  }
  return all;
}

}  // namespace scarp
