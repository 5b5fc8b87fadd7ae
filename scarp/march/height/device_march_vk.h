// SPDX-License-Identifier: MIT
// Private to the library: one march of height fields for rays in the memory of a Vulkan device. The host only learns
// whether marches are under way.
//
//   march.begin(commands, {ground, rays, hits, count}, query);
//   do commands.run();
//   while (march.go_on(commands));    rays that the first, lean pass leaves open take a second pass,
//                                     and long marches several runs of it (vk/loop_turns.glsl.h)
//
// DeviceQueries (queries_vk.h) uses it for rays from the host, picture renderers for rays made by their shaders.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/field/height_field.h"
#include "scarp/march/height/march_host.h"
#include "scarp/march/height/ray_batch.glsl.h"
#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/loop_turns.glsl.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

/// Rays on a device, given by buffer addresses.
struct DeviceRays {
  std::uint64_t ground = 0;  ///< DeviceGround::address()
  std::uint64_t rays = 0;    ///< glsl::RayBlock, ray_blocks(count) of them for `count` rays
  std::uint64_t hits = 0;    ///< glsl::HitBlock, the same number; any-hit queries define only the status
  std::uint32_t count = 0;   ///< 1 to DeviceHeightMarch::kMostRaysAtOnce
};

/// The query for the rays.
struct DeviceRayQuery {
  bool any = false;         ///< any hit: only the status is valid
  bool statistics = false;  ///< whether steps and fetches are counted; otherwise 0
  /// batch_ground_kind() of the ground gives a smaller shader; kBatchAnyGround reads the kind from the ground. With
  /// kScarpStarts among its flags, rays may start on the surface.
  std::uint32_t ground_kind = glsl::kBatchAnyGround;
  glsl::ScarpSampling sampling{};  ///< for all marches except max-mip
  bool exact_only = false;         ///< skips the first pass, see leaves_first_pass()
};

/// Whether a field exceeds the limits of first passes (max_mip_lean.glsl.h).
bool leaves_first_pass(const HeightField& field);

/// Not thread-safe.
class DeviceHeightMarch {
 public:
  /// `turns_at_once`: maximum iterations of a march's loop in one run, 1 to kScarpLoopTurns. Throws Error if the march
  /// does not run on devices, listing those that do, or if the device lacks memory.
  DeviceHeightMarch(const Device& device, std::string_view march, int turns_at_once = glsl::kScarpLoopTurns);
  DeviceHeightMarch(const DeviceHeightMarch&) = delete;
  DeviceHeightMarch& operator=(const DeviceHeightMarch&) = delete;

  /// Allocates room for batches of this many rays; begin() does so for a larger batch. Throws Error if the device lacks
  /// memory.
  void reserve(std::uint32_t rays);
  /// Records the first run of a batch, one batch at a time. The run sees what was written before commands.barrier().
  /// The buffers must stay alive until go_on() returns false.
  void begin(Commands& commands, const DeviceRays& rays, const DeviceRayQuery& query);
  /// Call after commands.run(). Returns false if all rays of the batch are done; otherwise records the next run.
  bool go_on(Commands& commands);

  /// Returns the device memory per ray of a batch, besides the ray and its hit.
  static std::size_t state_bytes(std::string_view march);
  /// Returns the shaders of all marches, for float32 fields.
  static std::vector<ShaderProgram> shaders();
  /// Returns the names of the marches that run on devices, separated by commas.
  static std::string names();

  static constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  ///< 62,500 workgroups

 private:
  struct Row;  // of the table of marches
  static const Row& find(std::string_view march);
  using PipelineKey = std::pair<bool, std::vector<std::uint32_t>>;  // second pass, constants
  static ShaderProgram program_of(const Row& row, const DeviceRayQuery& query, bool second);
  const ComputePipeline& pipeline(const DeviceRayQuery& query, bool second);
  void record(Commands& commands);

  Device device_;
  const Row& march_;
  int turns_at_once_;
  std::optional<DeviceBuffer> states_;
  DeviceBuffer under_way_;
  std::map<PipelineKey, ComputePipeline> pipelines_;
  // State of the current batch.
  const ComputePipeline* running_ = nullptr;
  glsl::RayBatch batch_{};
  DeviceRayQuery query_{};
  bool second_ = false;            // whether the second pass has begun
  std::uint32_t interrupted_ = 0;  // after the last run: 1 if a march is under way
};

}  // namespace scarp
