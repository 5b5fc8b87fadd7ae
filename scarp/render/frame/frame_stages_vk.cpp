// SPDX-License-Identifier: MIT
#include "scarp/render/frame/frame_stages_vk.h"

#include <algorithm>
#include <cstddef>

#include "scarp/base/error.h"
#include "scarp/march/sampling/fixed_step.glsl.h"
#include "scarp/vk/memory.h"

namespace scarp {
namespace {

constexpr std::uint32_t kThreads = 64;

constexpr std::uint32_t kRaysWords[] = {
#include "scarp/render/frame/terrain_frame_rays.comp.inc"
};
constexpr std::uint32_t kTakeWords[] = {
#include "scarp/render/frame/terrain_frame_take.comp.inc"
};
constexpr std::uint32_t kWaterWords[] = {
#include "scarp/render/frame/terrain_frame_water.comp.inc"
};
constexpr std::uint32_t kLightWords[] = {
#include "scarp/render/frame/terrain_frame_light.comp.inc"
};
constexpr std::uint32_t kPaintWords[] = {
#include "scarp/render/frame/terrain_frame_paint.comp.inc"
};
constexpr std::uint32_t kResolveWords[] = {
#include "scarp/render/frame/terrain_frame_resolve.comp.inc"
};

// Pixels with water have three rays. The mirrored ray and the ray to the bottom are traced together, and their hits are
// lit together; where there is water, the camera sees no ground.
std::uint64_t seens_per_pixel(bool water) { return water ? glsl::kFrameSeens : 1; }
std::uint64_t rays_per_pixel(bool water) { return water ? 2 : 1; }

std::uint64_t bytes_per_pixel(bool water, std::string_view march) {
  const std::uint64_t of_pixel = seens_per_pixel(water) * sizeof(glsl::FrameSeen) +
                                 (water ? sizeof(glsl::FrameWater) : 0) + sizeof(glsl::FrameSum) + 4;
  const std::uint64_t of_ray =
      sizeof(glsl::ScarpRay) + sizeof(glsl::ScarpHit) + DeviceHeightMarch::state_bytes(march) + 4 + 4;
  return of_pixel + rays_per_pixel(water) * of_ray;
}

std::string_view march_name(bool stepped) { return stepped ? "fixed-step" : "max-mip"; }

// Number of rays to sun and sky per ground.
int lights(const glsl::FrameSettings& s, std::uint32_t parts) {
  if ((parts & glsl::kFrameHasSamples) != 0) return s.sun_rays + s.sky_rays;
  return (parts & glsl::kFrameHasShadows) != 0 ? 1 : 0;
}

// Sampling for rays whose cell_time is the time between two samples.
glsl::ScarpSampling samples(int interpolate, int max_steps) {
  return glsl::scarp_fixed_step(1, interpolate != 0 ? glsl::kScarpRefineSecant : glsl::kScarpRefineNone, max_steps);
}

}  // namespace

struct FrameStages::Stage {
  std::uint32_t number;
  std::string_view name;
  std::string_view file;
  std::span<const std::uint32_t> words;
  std::uint32_t parts;  // flags that it reads: pictures that differ in others share its shader
  bool reads_field;

  static const Stage kRays, kTake, kWater, kLight, kPaint, kResolve;
};

const FrameStages::Stage FrameStages::Stage::kRays{0,
                                                   "frame, rays",
                                                   "scarp/render/frame/terrain_frame_rays.comp",
                                                   kRaysWords,
                                                   glsl::kFrameHasWater | glsl::kFrameHasPlinth | glsl::kFrameHasRims,
                                                   true};
const FrameStages::Stage FrameStages::Stage::kTake{1,
                                                   "frame, take",
                                                   "scarp/render/frame/terrain_frame_take.comp",
                                                   kTakeWords,
                                                   glsl::kFrameHasShadows | glsl::kFrameHasSamples,
                                                   true};
const FrameStages::Stage FrameStages::Stage::kWater{
    2,
    "frame, water",
    "scarp/render/frame/terrain_frame_water.comp",
    kWaterWords,
    glsl::kFrameHasWater | glsl::kFrameHasRims | glsl::kFrameHasScattering,
    true};
const FrameStages::Stage FrameStages::Stage::kLight{3,
                                                    "frame, light",
                                                    "scarp/render/frame/terrain_frame_light.comp",
                                                    kLightWords,
                                                    glsl::kFrameHasShadows | glsl::kFrameHasSamples,
                                                    true};
const FrameStages::Stage FrameStages::Stage::kPaint{4,
                                                    "frame, paint",
                                                    "scarp/render/frame/terrain_frame_paint.comp",
                                                    kPaintWords,
                                                    glsl::kFrameHasPatches | glsl::kFrameHasDrape |
                                                        glsl::kFrameHasContours | glsl::kFrameHasTexture |
                                                        glsl::kFrameHasShadows | glsl::kFrameHasSamples,
                                                    true};
const FrameStages::Stage FrameStages::Stage::kResolve{
    5,
    "frame, resolve",
    "scarp/render/frame/terrain_frame_resolve.comp",
    kResolveWords,
    glsl::kFrameHasWater | glsl::kFrameHasFog | glsl::kFrameHasScattering,
    false};

FrameStages::FrameStages(const Device& device, bool stepped)
    : device_(device), stepped_(stepped), march_(device, march_name(stepped)), commands_(device) {}

ShaderProgram FrameStages::program_of(const Stage& stage, Take take, bool stepped, std::uint32_t parts,
                                      std::uint32_t field_flags) {
  parts &= stage.parts;
  // The purpose of a ray determines how its hit is stored.
  if (stage.number == Stage::kTake.number && take != Take::light) parts = 0;
  // Constants that a shader does not declare are ignored.
  return {stage.file,
          stepped ? "fixed-step" : "max-mip",
          stage.words,
          sizeof(glsl::FramePush),
          {kThreads, stepped, parts, stage.reads_field ? field_flags : 0, take == Take::light,
           take == Take::sights_and_grounds}};
}

std::vector<ShaderProgram> FrameStages::shaders() {
  std::vector<ShaderProgram> all;
  const auto add = [&](const Stage& stage, Take take, std::uint32_t parts, const char* name) {
    all.push_back(program_of(stage, take, false, parts, 0));
    all.back().variant = name;
  };
  constexpr std::uint32_t kLake = glsl::kFrameHasShadows | glsl::kFrameHasWater | glsl::kFrameHasFog;
  add(Stage::kRays, Take::sights, glsl::kFrameHasShadows, "shadows");
  add(Stage::kRays, Take::sights, kLake, "water");
  add(Stage::kTake, Take::sights_and_grounds, 0, "sights");
  add(Stage::kTake, Take::light, glsl::kFrameHasShadows, "light");
  add(Stage::kWater, Take::sights, kLake, "water");
  add(Stage::kLight, Take::sights, glsl::kFrameHasShadows, "shadows");
  add(Stage::kPaint, Take::sights, glsl::kFrameHasShadows, "shadows");
  add(Stage::kResolve, Take::sights, glsl::kFrameHasShadows, "shadows");
  add(Stage::kResolve, Take::sights, kLake, "water and fog");
  return all;
}

const ComputePipeline& FrameStages::pipeline(const Stage& stage, Take take) {
  const ShaderProgram program = program_of(stage, take, stepped_, work_->parts, work_->field_flags);
  const PipelineKey key{stage.number, program.constants};
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return found->second;
  return pipelines_.try_emplace(key, device_, program, std::string(stage.name)).first->second;
}

void FrameStages::reserve(std::uint32_t pixels) {
  const bool water = (work_->parts & glsl::kFrameHasWater) != 0;
  const std::uint64_t rays = pixels * rays_per_pixel(water);
  const auto address = [&](KeptBuffer& buffer, std::uint64_t bytes) {
    return buffer.reserve(device_, bytes).address();
  };
  push_.seens = address(seens_, pixels * seens_per_pixel(water) * sizeof(glsl::FrameSeen));
  if (water) push_.waters = address(waters_, pixels * sizeof(glsl::FrameWater));
  push_.rays = address(rays_, glsl::ray_blocks(rays) * sizeof(glsl::RayBlock));
  push_.hits = address(hits_, glsl::ray_blocks(rays) * sizeof(glsl::HitBlock));
  push_.owners = address(owners_, rays * 4);
  push_.grounds = address(grounds_, rays * 4);
  push_.counters = address(counters_, sizeof(glsl::FrameCounters));
  push_.sums = address(sums_, pixels * sizeof(glsl::FrameSum));
  push_.pixels = address(pixels_, std::uint64_t{pixels} * 4);
}

void FrameStages::clear(std::uint64_t offset, std::uint64_t bytes) {
  commands_.barrier();
  commands_.fill(counters_.buffer(), offset, bytes, 0);
}

void FrameStages::record(const Stage& stage, std::uint32_t threads, Take take) {
  if (threads == 0) return;
  push_.threads = threads;
  commands_.barrier();
  commands_.dispatch(pipeline(stage, take), push_, {(threads + kThreads - 1) / kThreads, 1, 1});
}

// Runs the recorded commands. Nothing is recorded if `progress` throws.
void FrameStages::submit() {
  commands_.barrier();
  commands_.read(counters_.buffer(), 0, sizeof counts_, &counts_);
  commands_.run();
  for (const PassTime& pass : commands_.passes()) {
    if (pass.nanoseconds) device_s_ = device_s_.value_or(0) + 1e-9 * *pass.nanoseconds;
  }
  if (*progress_ && !(*progress_)(done_)) throw Interrupted();
}

// Marches all rays of the list.
void FrameStages::march(const DeviceRayQuery& query) {
  if (counts_.rays == 0) return;
  march_.begin(commands_, {work_->ground, rays_.buffer().address(), hits_.buffer().address(), counts_.rays}, query);
  do submit();
  while (march_.go_on(commands_));
}

void FrameStages::see_through_water() {
  record(Stage::kTake, counts_.rays, Take::sights);
  clear(offsetof(glsl::FrameCounters, rays), 4);
  record(Stage::kWater, push_.count);
  if (work_->numbers->iterations != 0) return;
  submit();
  march(sight_);
  record(Stage::kTake, counts_.rays, Take::sights_and_grounds);
}

void FrameStages::light_grounds() {
  submit();
  if (counts_.grounds == 0) return;
  for (push_.light = 0; push_.light < lights(*work_->numbers, work_->parts); ++push_.light) {
    clear(offsetof(glsl::FrameCounters, rays), 4);
    record(Stage::kLight, counts_.grounds);
    submit();
    march(light_);
    record(Stage::kTake, counts_.rays, Take::light);
  }
  record(Stage::kPaint, counts_.grounds);
}

void FrameStages::make_point(int point) {
  push_.point = point;
  clear(0, sizeof(glsl::FrameCounters));
  record(Stage::kRays, push_.count);
  submit();
  march(sight_);
  if ((work_->parts & glsl::kFrameHasWater) != 0)
    see_through_water();
  else
    record(Stage::kTake, counts_.rays, Take::sights_and_grounds);
  if (work_->numbers->iterations == 0) light_grounds();
  record(Stage::kResolve, push_.count);
}

std::optional<double> FrameStages::run(
    const FrameWork& work, const Progress& progress,
    const std::function<void(std::int64_t first, std::span<const std::uint32_t> words)>& take) {
  const glsl::FrameSettings& s = *work.numbers;
  work_ = &work;
  progress_ = &progress;
  device_s_.reset();
  const bool tells_steps = s.iterations != 0 || s.fog == glsl::kScarpFogByIterations || work.sights != 0;
  const std::uint32_t walls = (work.parts & glsl::kFrameHasRims) != 0 ? glsl::kScarpSolid : 0;
  const bool water = (work.parts & glsl::kFrameHasWater) != 0;
  const auto kind = [&](std::uint32_t more_flags) {
    return glsl::batch_ground_kind(work.field_flags | more_flags, work.sample_type);
  };
  // Reflected rays start on the ground where the sea is flat ground.
  sight_ = {.statistics = tells_steps,
            .ground_kind = kind(walls | (water ? glsl::kScarpStarts : 0)),
            .sampling = samples(s.interpolate, s.steps + 1),
            .exact_only = work.exact_only};
  // Steps are the same for any hit and closest hit: one shader for both.
  light_ = {.any = true,
            .statistics = stepped_ && tells_steps,
            .ground_kind = kind(glsl::kScarpStarts),
            .sampling = samples(s.sun_interpolate, s.sun_steps),
            .exact_only = work.exact_only};

  const std::int64_t pixels = std::int64_t{s.width} * s.height;
  const auto most = static_cast<std::int64_t>(kMemory / bytes_per_pixel(water, march_name(stepped_)));
  push_ = {};
  push_.settings = work.settings;
  push_.ground = work.ground;
  push_.sights = work.sights;
  push_.tell_sights = work.sights != 0;
  reserve(static_cast<std::uint32_t>(std::min(pixels, most)));
  const int points = s.aa * s.aa;
  for (std::int64_t first = 0; first < pixels; first += most) {
    push_.first = static_cast<std::uint32_t>(first);
    push_.count = static_cast<std::uint32_t>(std::min(most, pixels - first));
    for (int point = 0; point < points; ++point) {
      done_ = (static_cast<double>(first) + push_.count * (static_cast<double>(point) / points)) /
              static_cast<double>(pixels);
      make_point(point);
    }
    submit();
    words_.resize(push_.count);
    download(pixels_.buffer(), 0, words_.data(), 4 * std::uint64_t{push_.count});
    take(first, words_);
  }
  return device_s_;
}

}  // namespace scarp
