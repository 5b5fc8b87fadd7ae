// SPDX-License-Identifier: MIT
// Private to the station: batches of rays on a device, run after run until no march is under way.
//
//   slice of rays ──prepare──▶ device ──▶ run ──▶ under way ──▶ run ──▶ ... ──▶ answers, in the rays' order
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/pipeline.h"

namespace scarp {

/// Throws Error unless a batch has one result per ray, and one cost per ray or no costs.
inline void require_room(std::size_t rays, std::size_t hits, std::size_t costs) {
  if (rays != hits || (costs != 0 && rays != costs))
    throw Error(fmt::format("batch: {} rays, room for {} answers and {} costs", rays, hits, costs));
}

/// Returns the names in a table of device marches, separated by commas.
template <class Table>
std::string names_of(const Table& table) {
  std::string names;
  for (const auto& row : table) names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

/// The slices of a batch, by the types of a ray on the host (Prepared) and on the device (Ray), and of its result
/// (Hit).
template <class Kind>
class RaySlices {
 public:
  using Prepared = typename Kind::Prepared;
  using Hit = typename Kind::Hit;

  const std::vector<PassTime>& passes() const { return passes_; }

 protected:
  /// Throws Error for a slice out of range.
  RaySlices(const Device& device, std::uint32_t rays_at_once) : slice_(checked(rays_at_once)), commands_(device) {}

  static constexpr std::int64_t kRaysPerPiece = 1024;

  // Calls body(i) for each i below count, on all threads, kRaysPerPiece at a time.
  template <class Body>
  static void for_each(std::size_t count, const Body& body) {
    parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
    });
  }

  // For each i below count, on all threads: prepare(i) returns a Prepared, answer(i, prepared, hit) receives the
  // result, which is undefined for rays that do not march. `march` sets found_ from prepared_, the rays of one slice.
  template <class Prepare, class Answer, class March>
  void ask_in_slices(std::size_t count, const Prepare& prepare, const Answer& answer, const March& march) {
    passes_.clear();
    for (std::size_t first = 0; first < count; first += slice_) {
      const std::size_t some = std::min<std::size_t>(slice_, count - first);
      prepared_.resize(some);
      found_.assign(some, Kind::none());
      std::atomic<bool> any = false;
      for_each(some, [&](std::size_t i) {
        prepared_[i] = prepare(first + i);
        if (prepared_[i].marches && !any.load(std::memory_order_relaxed)) any.store(true, std::memory_order_relaxed);
      });
      if (any) march();
      for_each(some, [&](std::size_t i) { answer(first + i, prepared_[i], found_[i]); });
    }
  }

  void run() {
    commands_.run();
    passes_.insert(passes_.end(), commands_.passes().begin(), commands_.passes().end());
  }

  std::uint32_t slice_;
  Commands commands_;
  std::vector<PassTime> passes_;
  // The current slice, by ray.
  std::vector<Prepared> prepared_;
  std::vector<Hit> found_;

 private:
  static constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  // 65,535 workgroups at most

  static std::uint32_t checked(std::uint32_t rays) {
    if (rays >= 1 && rays <= kMostRaysAtOnce) return rays;
    throw Error(fmt::format("device queries: {} rays at once (must be 1 to {})", rays, kMostRaysAtOnce));
  }
};

/// Runs of rays whose interrupted marches are `under_way`: their state is returned with the answer and sent again with
/// the ray (`go_on`).
template <class Kind>
class RayRuns : public RaySlices<Kind> {
 public:
  using Ray = typename Kind::Ray;
  using typename RaySlices<Kind>::Hit;

  static constexpr std::uint32_t kThreads = 64;  // of a workgroup

  /// Throws Error for a slice out of range, or if the device lacks memory.
  RayRuns(const Device& device, std::uint32_t rays_at_once)
      : RaySlices<Kind>(device, rays_at_once),
        rays_(device, std::uint64_t{slice_} * sizeof(Ray), "rays"),
        answers_(device, std::uint64_t{slice_} * sizeof(Hit), "hits") {}

  /// `prepare` and `answer` as in RaySlices; `batch` is the shader's push constants, with rays, hits and count.
  template <class Batch, class Prepare, class Answer>
  void ask(const ComputePipeline& pipeline, Batch batch, std::size_t count, const Prepare& prepare,
           const Answer& answer) {
    batch.rays = rays_.address();
    batch.hits = answers_.address();
    this->ask_in_slices(count, prepare, answer, [&] { march(pipeline, batch); });
  }

 private:
  using RaySlices<Kind>::slice_;
  using RaySlices<Kind>::commands_;
  using RaySlices<Kind>::prepared_;
  using RaySlices<Kind>::found_;

  // A run contains only the rays that are under way.
  template <class Batch>
  void march(const ComputePipeline& pipeline, Batch& batch) {
    open_.clear();
    packed_.clear();
    for (std::size_t i = 0; i < prepared_.size(); ++i) {
      if (!prepared_[i].marches) continue;
      packed_.push_back(prepared_[i].ray);
      open_.push_back(i);
    }
    while (!open_.empty()) {
      upload(rays_, 0, packed_.data(), open_.size() * sizeof(Ray));
      answered_.resize(open_.size());
      batch.count = static_cast<std::uint32_t>(open_.size());
      commands_.dispatch(pipeline, batch, {(batch.count + kThreads - 1) / kThreads, 1, 1});
      this->run();
      download(answers_, 0, answered_.data(), answered_.size() * sizeof(Hit));
      std::size_t left = 0;
      for (std::size_t i = 0; i < answered_.size(); ++i) {
        Hit& hit = found_[open_[i]];
        Kind::add(answered_[i], hit);
        if (!Kind::under_way(hit)) continue;
        packed_[left] = packed_[i];
        Kind::go_on(packed_[left], hit);
        open_[left++] = open_[i];
      }
      open_.resize(left);
    }
  }

  DeviceBuffer rays_, answers_;
  // The rays under way in one run, their indices and results.
  std::vector<Ray> packed_;
  std::vector<std::size_t> open_;
  std::vector<Hit> answered_;
};

}  // namespace scarp
