// SPDX-License-Identifier: MIT
// Private to the station: rays of ray_states.glsl.h by the batch on a device, run after run until none is under way.
//
//   slice of rays ──prepare──▶ those that march ──▶ run ──▶ under way ──▶ run ──▶ ... ──▶ answers, in the rays' order
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/device_function_ray.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"

namespace scarp {

/// Throws Error when a batch has not as many answers and costs (or none) as rays.
inline void require_room(std::size_t rays, std::size_t hits, std::size_t steps) {
  if (rays != hits || (steps != 0 && rays != steps))
    throw Error(fmt::format("batch: {} rays, room for {} answers and {} costs", rays, hits, steps));
}
inline void require_room(std::size_t rays, std::size_t blocked) {
  if (rays != blocked) throw Error(fmt::format("batch: {} rays, room for {} answers", rays, blocked));
}
inline bool is_blocked(const DeviceFunctionRay& prepared, const glsl::ScarpFunctionHit& answer) {
  return prepared.marches && answer.status == glsl::kScarpFunctionHit;
}

class RayRuns {
 public:
  static constexpr std::uint32_t kThreads = 64;  // of a workgroup

  /// Throws Error: a slice out of its range, no memory on the device.
  RayRuns(const Device& device, std::uint32_t rays_at_once)
      : slice_(checked(rays_at_once)),
        rays_(device, std::uint64_t{slice_} * sizeof(glsl::ScarpFunctionRay), "rays"),
        answers_(device, std::uint64_t{slice_} * sizeof(glsl::ScarpFunctionHit), "hits"),
        commands_(device) {}

  /// For each i below count, on all threads: prepare(i) makes a DeviceFunctionRay, answer(i, prepared, answer) takes
  /// what the march tells. `batch` is the shader's push constants, with rays, hits and count.
  template <class Batch, class Prepare, class Answer>
  void ask(const ComputePipeline& pipeline, Batch batch, std::size_t count, const Prepare& prepare,
           const Answer& answer) {
    batch.rays = rays_.address();
    batch.hits = answers_.address();
    passes_.clear();
    for (std::size_t first = 0; first < count; first += slice_) {
      const std::size_t some = std::min<std::size_t>(slice_, count - first);
      prepared_.resize(some);
      place_.resize(some);
      packed_.clear();
      for_each(some, [&](std::size_t i) { prepared_[i] = prepare(first + i); });
      // Rays that never come to where the field can be met stay here.
      for (std::size_t i = 0; i < some; ++i) {
        place_[i] = packed_.size();
        if (prepared_[i].marches) packed_.push_back(prepared_[i].ray);
      }
      found_.assign(packed_.size(), glsl::scarp_function_miss());
      run(pipeline, batch);
      for_each(some, [&](std::size_t i) {
        answer(first + i, prepared_[i], prepared_[i].marches ? found_[place_[i]] : glsl::scarp_function_miss());
      });
    }
  }

  const std::vector<PassTime>& passes() const { return passes_; }

 private:
  static constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  // 65,535 workgroups
  static constexpr std::int64_t kRaysPerPiece = 1024;

  static std::uint32_t checked(std::uint32_t rays) {
    if (rays >= 1 && rays <= kMostRaysAtOnce) return rays;
    throw Error(fmt::format("device queries: {} rays at once; there can be 1 to {}", rays, kMostRaysAtOnce));
  }

  template <class Body>
  static void for_each(std::size_t count, const Body& body) {
    parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
    });
  }

  template <class Batch>
  void run(const ComputePipeline& pipeline, Batch batch) {
    open_.resize(packed_.size());
    std::iota(open_.begin(), open_.end(), std::size_t{0});
    while (!open_.empty()) {
      batch.count = static_cast<std::uint32_t>(open_.size());
      answered_.resize(open_.size());
      upload(rays_, 0, packed_.data(), open_.size() * sizeof(glsl::ScarpFunctionRay));
      commands_.dispatch(pipeline, batch, {(batch.count + kThreads - 1) / kThreads, 1, 1});
      commands_.run();
      passes_.insert(passes_.end(), commands_.passes().begin(), commands_.passes().end());
      download(answers_, 0, answered_.data(), open_.size() * sizeof(glsl::ScarpFunctionHit));
      std::size_t left = 0;
      for (std::size_t i = 0; i < answered_.size(); ++i) {
        glsl::ScarpFunctionHit& hit = found_[open_[i]];
        const std::uint32_t bounds = hit.bounds, heights = hit.heights;
        hit = answered_[i];
        hit.bounds += bounds;
        hit.heights += heights;
        if (hit.status != glsl::kScarpFunctionUnderWay) continue;
        packed_[left] = packed_[i];
        packed_[left].state = hit.state;
        open_[left++] = open_[i];
      }
      open_.resize(left);
    }
  }

  std::uint32_t slice_;
  DeviceBuffer rays_, answers_;
  Commands commands_;
  std::vector<PassTime> passes_;
  // Of one slice.
  std::vector<DeviceFunctionRay> prepared_;
  std::vector<glsl::ScarpFunctionRay> packed_;
  std::vector<std::size_t> place_;
  std::vector<glsl::ScarpFunctionHit> found_;
  // Of one run: those under way, by their places, and what the device tells of them.
  std::vector<std::size_t> open_;
  std::vector<glsl::ScarpFunctionHit> answered_;
};

}  // namespace scarp
