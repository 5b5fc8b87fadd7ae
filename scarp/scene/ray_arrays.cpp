// SPDX-License-Identifier: MIT
#include "scarp/scene/ray_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/valid_rays.h"

namespace scarp {
namespace {

// Few enough to stay in each thread's L2 cache, many enough for all threads.
constexpr std::size_t kRaysAtOnce = 1 << 16;
constexpr std::int64_t kRaysPerColumn = 8192;

void require_length(std::size_t length, std::size_t rays, const char* name, bool optional) {
  if (length == rays || (optional && length == 0)) return;
  throw Error(fmt::format("batch: {} rays by origin_x, but {} values of {}", rays, length, name));
}

void require_together(bool all, bool any, const char* names) {
  if (any && !all) throw Error(fmt::format("batch: {} are given together or not at all", names));
}

std::size_t require_rays(const RayArrays& rays) {
  const std::size_t count = rays.origin_x.size();
  require_length(rays.origin_y.size(), count, "origin_y", false);
  require_length(rays.origin_z.size(), count, "origin_z", false);
  require_length(rays.direction_x.size(), count, "direction_x", false);
  require_length(rays.direction_y.size(), count, "direction_y", false);
  require_length(rays.direction_z.size(), count, "direction_z", false);
  require_length(rays.t_min.size(), count, "t_min", true);
  require_length(rays.t_max.size(), count, "t_max", true);
  require_length(rays.start_col.size(), count, "start_col", true);
  require_length(rays.start_row.size(), count, "start_row", true);
  require_length(rays.start_object.size(), count, "start_object", true);
  require_together(rays.start_col.size() == rays.start_row.size(), true, "start_col and start_row");
  return count;
}

void require_hits(const HitArrays& hits, std::size_t count) {
  require_length(hits.t.size(), count, "t", true);
  require_length(hits.status.size(), count, "status", true);
  require_length(hits.object.size(), count, "object", true);
  require_length(hits.part.size(), count, "part", true);
  require_length(hits.col.size(), count, "col", true);
  require_length(hits.row.size(), count, "row", true);
  require_length(hits.u.size(), count, "u", true);
  require_length(hits.v.size(), count, "v", true);
  require_length(hits.normal_x.size(), count, "normal_x", true);
  require_length(hits.normal_y.size(), count, "normal_y", true);
  require_length(hits.normal_z.size(), count, "normal_z", true);
  const bool x = !hits.normal_x.empty(), y = !hits.normal_y.empty(), z = !hits.normal_z.empty();
  require_together(x && y && z, x || y || z, "normal_x, normal_y and normal_z");
}

Ray ray_at(const RayArrays& rays, std::size_t i) {
  Ray ray{.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          .direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]}};
  if (!rays.t_min.empty()) ray.t_min = rays.t_min[i];
  if (!rays.t_max.empty()) ray.t_max = rays.t_max[i];
  if (!rays.start_col.empty() && rays.start_col[i] >= 0) {
    ray.start = RayStart::on_surface;
    ray.start_cell = {rays.start_col[i], rays.start_row[i]};
    if (!rays.start_object.empty()) ray.start_object = rays.start_object[i];
  }
  return ray;
}

// Calls answer(first, rays) for pieces of the batch. Errors name the ray by its index in the whole batch.
template <class Answer>
void for_each_piece(const RayArrays& rays, const Scene& scene, BadRays bad, const Answer& answer) {
  const std::size_t count = rays.origin_x.size();
  std::vector<Ray> piece;
  for (std::size_t first = 0; first < count; first += kRaysAtOnce) {
    piece.resize(std::min(kRaysAtOnce, count - first));
    parallel_for(static_cast<std::int64_t>(piece.size()), kRaysPerColumn, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
        piece[i] = ray_at(rays, first + i);
    });
    std::vector<std::size_t> invalid;
    if (bad == BadRays::refuse) {
      require_valid(piece, {}, scene, first, count);
    } else {
      invalid = replace_invalid(piece, {}, scene);
    }
    answer(first, std::span<const Ray>(piece), std::span<const std::size_t>(invalid));
  }
}

template <class T, class U>
void put(std::span<T> to, std::size_t i, U value) {
  if (!to.empty()) to[i] = static_cast<T>(value);
}

void put(const Scene& scene, const Ray& ray, const Hit& hit, const HitArrays& hits, std::size_t i) {
  put(hits.t, i, hit.t);
  put(hits.status, i, hit.status);
  put(hits.object, i, hit.object);
  put(hits.part, i, hit ? hit.part : 0);
  put(hits.col, i, hit.cell.col);
  put(hits.row, i, hit.cell.row);
  put(hits.u, i, hit.u);
  put(hits.v, i, hit.v);
  if (hits.normal_x.empty()) return;
  const dvec3 normal = hit ? scene.surface(ray, hit).normal : dvec3(0.0);
  put(hits.normal_x, i, normal.x);
  put(hits.normal_y, i, normal.y);
  put(hits.normal_z, i, normal.z);
}

}  // namespace

void cast(const Scene& scene, const RayArrays& rays, const HitArrays& hits, BadRays bad) {
  require_hits(hits, require_rays(rays));
  std::vector<Hit> answers;
  const auto answer = [&](std::size_t first, std::span<const Ray> piece, std::span<const std::size_t> invalid) {
    answers.resize(piece.size());
    scene.closest_hits(piece, answers);
    for (const std::size_t i : invalid) answers[i] = Hit{}, answers[i].status = HitStatus::invalid;
    parallel_for(static_cast<std::int64_t>(piece.size()), kRaysPerColumn, [&](std::int64_t begin, std::int64_t end) {
      for (auto j = static_cast<std::size_t>(begin); j < static_cast<std::size_t>(end); ++j)
        put(scene, piece[j], answers[j], hits, first + j);
    });
  };
  for_each_piece(rays, scene, bad, answer);
}

void occluded(const Scene& scene, const RayArrays& rays, std::span<std::uint8_t> blocked, BadRays bad) {
  require_length(blocked.size(), require_rays(rays), "blocked", false);
  const auto answer = [&](std::size_t first, std::span<const Ray> piece, std::span<const std::size_t> invalid) {
    scene.occluded(piece, blocked.subspan(first, piece.size()));
    for (const std::size_t i : invalid) blocked[first + i] = kInvalidRay;
  };
  for_each_piece(rays, scene, bad, answer);
}

}  // namespace scarp
