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

/// Throws Error unless a batch has as many answers and costs (or none) as rays.
inline void require_room(std::size_t rays, std::size_t hits, std::size_t costs) {
  if (rays != hits || (costs != 0 && rays != costs))
    throw Error(fmt::format("batch: {} rays, room for {} answers and {} costs", rays, hits, costs));
}

/// Names of the rows of a table of device marches, separated by commas.
template <class Table>
std::string names_of(const Table& table) {
  std::string names;
  for (const auto& row : table) names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

/// What a kind of ray is on the host (Prepared), on the device (Ray), and its answer (Hit). A march that is interrupted
/// either keeps its state on the device (ask_there()), or is `under_way`: its state comes back with the answer and goes
/// out again with the ray (`go_on`).
template <class Kind>
class RayRuns {
 public:
  using Prepared = typename Kind::Prepared;
  using Ray = typename Kind::Ray;
  using Hit = typename Kind::Hit;

  static constexpr std::uint32_t kThreads = 64;  // of a workgroup

  /// Throws Error: a slice out of its range, no memory on the device.
  RayRuns(const Device& device, std::uint32_t rays_at_once)
      : slice_(checked(rays_at_once)),
        rays_(device, std::uint64_t{slice_} * sizeof(Ray), "rays"),
        answers_(device, std::uint64_t{slice_} * sizeof(Hit), "hits"),
        commands_(device) {}

  /// For each i below count, on all threads: prepare(i) returns a Prepared, answer(i, prepared, hit) takes the answer,
  /// which means nothing for rays that do not march. `batch` is the shader's push constants, with rays, hits and count.
  template <class Batch, class Prepare, class Answer>
  void ask(const ComputePipeline& pipeline, Batch batch, std::size_t count, const Prepare& prepare,
           const Answer& answer) {
    batch.rays = rays_.address();
    batch.hits = answers_.address();
    ask_in_slices(count, prepare, answer, [&] { march(pipeline, batch); });
  }
  /// The same by a march that keeps its states: begin(commands, rays, hits, count) records its first run on buffers of
  /// these addresses, go_on(commands) the next one, or returns false if there is none.
  template <class Begin, class GoOn, class Prepare, class Answer>
  void ask_there(const Begin& begin, const GoOn& go_on, std::size_t count, const Prepare& prepare,
                 const Answer& answer) {
    ask_in_slices(count, prepare, answer, [&] {
      // Each ray keeps its place. Those that do not march end at once.
      upload(rays_, 0, packed_.data(), packed_.size() * sizeof(Ray));
      begin(commands_, rays_.address(), answers_.address(), static_cast<std::uint32_t>(packed_.size()));
      do run();
      while (go_on(commands_));
      download(answers_, 0, found_.data(), found_.size() * sizeof(Hit));
    });
  }

  const std::vector<PassTime>& passes() const { return passes_; }

 private:
  static constexpr std::uint32_t kMostRaysAtOnce = 4'000'000;  // 65,535 workgroups at most
  static constexpr std::int64_t kRaysPerPiece = 1024;

  static std::uint32_t checked(std::uint32_t rays) {
    if (rays >= 1 && rays <= kMostRaysAtOnce) return rays;
    throw Error(fmt::format("device queries: {} rays at once (must be 1 to {})", rays, kMostRaysAtOnce));
  }

  template <class Body>
  static void for_each(std::size_t count, const Body& body) {
    parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
    });
  }

  // `march` sets found_ from packed_ and prepared_.
  template <class Prepare, class Answer, class March>
  void ask_in_slices(std::size_t count, const Prepare& prepare, const Answer& answer, const March& march) {
    passes_.clear();
    for (std::size_t first = 0; first < count; first += slice_) {
      const std::size_t some = std::min<std::size_t>(slice_, count - first);
      prepared_.resize(some);
      packed_.resize(some);
      found_.assign(some, Kind::none());
      std::atomic<bool> any = false;
      for_each(some, [&](std::size_t i) {
        prepared_[i] = prepare(first + i);
        packed_[i] = prepared_[i].ray;
        if (prepared_[i].marches && !any.load(std::memory_order_relaxed)) any.store(true, std::memory_order_relaxed);
      });
      if (any) march();
      for_each(some, [&](std::size_t i) { answer(first + i, prepared_[i], found_[i]); });
    }
  }

  // A run has the rays that are under way only.
  template <class Batch>
  void march(const ComputePipeline& pipeline, Batch& batch) {
    open_.clear();
    for (std::size_t i = 0; i < packed_.size(); ++i) {
      if (!prepared_[i].marches) continue;
      packed_[open_.size()] = packed_[i];
      open_.push_back(i);
    }
    while (!open_.empty()) {
      upload(rays_, 0, packed_.data(), open_.size() * sizeof(Ray));
      answered_.resize(open_.size());
      batch.count = static_cast<std::uint32_t>(open_.size());
      commands_.dispatch(pipeline, batch, {(batch.count + kThreads - 1) / kThreads, 1, 1});
      run();
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

  void run() {
    commands_.run();
    passes_.insert(passes_.end(), commands_.passes().begin(), commands_.passes().end());
  }

  std::uint32_t slice_;
  DeviceBuffer rays_, answers_;
  Commands commands_;
  std::vector<PassTime> passes_;
  // Of one slice, by ray.
  std::vector<Prepared> prepared_;
  std::vector<Hit> found_;
  std::vector<Ray> packed_;  // as they lie on the device
  // Of one run with rays under way only: their indices and answers.
  std::vector<std::size_t> open_;
  std::vector<Hit> answered_;
};

}  // namespace scarp
