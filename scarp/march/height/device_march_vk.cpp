// SPDX-License-Identifier: MIT
#include "scarp/march/height/device_march_vk.h"

#include <fmt/format.h>

#include <array>
#include <span>

#include "scarp/base/error.h"
#include "scarp/march/height/batch_states.glsl.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/sampling/sampling_entries.h"

namespace scarp {
namespace {

constexpr std::uint32_t kThreads = 64;  // of a workgroup

constexpr std::uint32_t kMaxMipWords[] = {
#include "scarp/march/height/max_mip.comp.inc"
};
constexpr std::uint32_t kMaxMipExactWords[] = {
#include "scarp/march/height/max_mip_exact.comp.inc"
};
constexpr std::uint32_t kHeightMarchesWords[] = {
#include "scarp/march/height/height_marches.comp.inc"
};
constexpr std::uint32_t kHeightMarchesSecondWords[] = {
#include "scarp/march/height/height_marches_second.comp.inc"
};

}  // namespace

struct DeviceHeightMarch::Row {
  std::string_view name;
  std::string_view file;  // of the shader
  std::span<const std::uint32_t> words;
  std::string_view second_file;
  std::span<const std::uint32_t> second;  // for rays that `words` leaves open
  bool second_has_any;                    // whether it supports any hit
  std::uint32_t choice;                   // ScarpSampling::march
  std::size_t state_bytes;                // of an interrupted march

  static constexpr Row sampling(const MarchEntry& march, std::uint32_t choice) {
    return {march.name,
            "scarp/march/height/height_marches.comp",
            kHeightMarchesWords,
            "scarp/march/height/height_marches_second.comp",
            kHeightMarchesSecondWords,
            false,
            choice,
            sizeof(glsl::BatchMarch)};
  }
  static const std::array<Row, 5> kAll;
};

constexpr std::array<DeviceHeightMarch::Row, 5> DeviceHeightMarch::Row::kAll = {
    Row{"max-mip", "scarp/march/height/max_mip.comp", kMaxMipWords, "scarp/march/height/max_mip_exact.comp",
        kMaxMipExactWords, true, 0, sizeof(glsl::BatchWalk)},
    sampling(kNaiveEntry, glsl::kScarpNaive),
    sampling(kFixedStepEntry, glsl::kScarpFixedStep),
    sampling(kRelaxedEntry, glsl::kScarpRelaxed),
    sampling(kLipschitzEntry, glsl::kScarpLipschitz),
};

std::string DeviceHeightMarch::names() { return names_of(Row::kAll); }

const DeviceHeightMarch::Row& DeviceHeightMarch::find(std::string_view march) {
  for (const Row& row : Row::kAll) {
    if (row.name == march) return row;
  }
  throw Error(fmt::format("march '{}': does not run on Vulkan devices (available: {})", march, names()));
}

bool leaves_first_pass(const HeightField& field) {
  constexpr int kMostCells = 1 << 17;
  constexpr double kMostRelief = 0x1p100;
  return field.cell_cols() >= kMostCells || field.cell_rows() >= kMostCells ||
         !(field.max_sample() - field.min_sample() < kMostRelief);
}

std::size_t DeviceHeightMarch::state_bytes(std::string_view march) { return find(march).state_bytes; }

DeviceHeightMarch::DeviceHeightMarch(const Device& device, std::string_view march, int turns_at_once)
    : device_(device),
      march_(find(march)),
      turns_at_once_(turns_at_once),
      under_way_(device, sizeof interrupted_, "a mark of interrupted marches") {}

void DeviceHeightMarch::reserve(std::uint32_t rays) {
  const std::uint64_t bytes = rays * std::uint64_t{march_.state_bytes};
  if (states_ && states_->bytes() >= bytes) return;
  states_.reset();
  states_.emplace(device_, bytes, "states of rays");
}

ShaderProgram DeviceHeightMarch::program_of(const Row& row, const DeviceRayQuery& query, bool second) {
  const bool any = query.any && (!second || row.second_has_any);
  // The second pass reads it from the settings.
  const std::uint32_t refinement = second || any ? glsl::kScarpRefineNone : query.sampling.refinement;
  return {second ? row.second_file : row.file,
          std::string(row.name) + (any ? " any" : ""),
          second ? row.second : row.words,
          sizeof(glsl::RayBatch),
          {kThreads, any, query.statistics, row.choice, query.ground_kind, refinement}};
}

std::vector<ShaderProgram> DeviceHeightMarch::shaders() {
  std::vector<ShaderProgram> all;
  const auto add = [&](const Row& row, bool any, std::uint32_t flags, bool second, const char* name) {
    DeviceRayQuery query{.any = any, .ground_kind = glsl::batch_ground_kind(flags, glsl::kGroundFloat32)};
    // The default of fixed-step (refinement_of_fixed_step()).
    if (row.choice == glsl::kScarpFixedStep) query.sampling.refinement = glsl::kScarpRefineSecant;
    all.push_back(program_of(row, query, second));
    all.back().variant += name;
  };
  for (const Row& row : Row::kAll) {
    for (const bool any : {false, true}) {
      add(row, any, 0, false, "");
      add(row, any, glsl::kScarpStarts, false, " from the surface");
      add(row, any, glsl::kScarpHoles, false, " holes");
      add(row, any, glsl::kScarpTriangles, false, " triangles");
      add(row, any, glsl::kScarpWraps, false, " wrap");
      if (!any || row.second_has_any) add(row, any, 0, true, "");
    }
  }
  return all;
}

const ComputePipeline& DeviceHeightMarch::pipeline(const DeviceRayQuery& query, bool second) {
  const ShaderProgram program = program_of(march_, query, second);
  const PipelineKey key(second, program.constants);
  const auto made = pipelines_.find(key);
  if (made != pipelines_.end()) return made->second;
  return pipelines_.try_emplace(key, device_, program, program.variant + (second ? ", second pass" : "")).first->second;
}

void DeviceHeightMarch::begin(Commands& commands, const DeviceRays& rays, const DeviceRayQuery& query) {
  reserve(rays.count);
  query_ = query;
  second_ = query.exact_only;
  running_ = &pipeline(query, second_);
  batch_ = {.ground = rays.ground,
            .rays = rays.rays,
            .hits = rays.hits,
            .count = rays.count,
            .settings = query.sampling,
            .turns = turns_at_once_,
            .resume = glsl::kBatchBegin,
            .states = states_->address(),
            .under_way = under_way_.address()};
  record(commands);
}

bool DeviceHeightMarch::go_on(Commands& commands) {
  if (interrupted_ == 0) return false;
  batch_.resume = second_ ? glsl::kBatchResume : glsl::kBatchSecond;
  if (!second_) running_ = &pipeline(query_, true);
  second_ = true;
  record(commands);
  return true;
}

void DeviceHeightMarch::record(Commands& commands) {
  commands.fill(under_way_, 0, sizeof interrupted_, 0);
  commands.barrier();
  commands.dispatch(*running_, batch_, {(batch_.count + kThreads - 1) / kThreads, 1, 1});
  commands.barrier();
  commands.read(under_way_, 0, sizeof interrupted_, &interrupted_);
}

}  // namespace scarp
