// SPDX-License-Identifier: MIT
// Batches of rays and points. Rays are converted piece by piece, as in scene/ray_arrays.cpp; hits are written where the
// caller keeps them.
#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <span>
#include <vector>

#include "scarp/base/parallel.h"
#include "scarp/c/scene_handle.h"
#include "scarp/c/structures.h"
#include "scarp/c/threads.h"
#include "scarp/scene/cast.h"
#include "scarp/scene/ray_arrays.h"
#include "scarp/scene/valid_rays.h"

namespace scarp::c {
namespace {

constexpr std::size_t kRaysAtOnce = 1 << 16;
constexpr std::int64_t kRaysPerColumn = 8192;

template <class Body>
void for_each(std::size_t count, const Body& body) {
  parallel_for(static_cast<std::int64_t>(count), kRaysPerColumn, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
  });
}

// Calls answer(first, rays, from) for pieces of the batch.
template <class Answer>
void for_each_piece(const scarp_scene& scene, const scarp_ray* rays, const scarp_hit* start, std::size_t count,
                    const Answer& answer) {
  std::vector<Ray> piece;
  std::vector<Hit> hits;
  std::vector<const Hit*> from;
  for (std::size_t first = 0; first < count; first += kRaysAtOnce) {
    piece.resize(std::min(kRaysAtOnce, count - first));
    if (start) hits.resize(piece.size()), from.resize(piece.size());
    std::atomic<std::size_t> first_bad = count;
    for_each(piece.size(), [&](std::size_t i) {
      piece[i] = ray_from(rays[first + i]);
      if (!start) return;
      const scarp_hit& hit = start[first + i];
      const bool starts = hit.status == SCARP_HIT;
      hits[i] = hit_from(hit);
      from[i] = starts ? &hits[i] : nullptr;
      if (!starts || is_hit_of(scene, hit)) return;
      std::size_t known = first_bad;
      while (first + i < known && !first_bad.compare_exchange_weak(known, first + i)) {
      }
    });
    if (first_bad < count)
      throw Error(
          fmt::format("ray {} of {}: this scene did not return the hit that it starts from", first_bad.load(), count));
    require_valid(piece, from, *scene.queries, first, count);
    answer(first, std::span<const Ray>(piece), std::span<const Hit* const>(from));
  }
}

template <class T>
std::span<T> span_of(T* values, std::size_t count) {
  return values ? std::span(values, count) : std::span<T>();
}

RayArrays arrays_from(const scarp_ray_arrays* given, std::size_t count) {
  const scarp_ray_arrays rays = read(given, "ray_arrays");
  return {.origin_x = {required(rays.origin_x, count, "origin_x"), count},
          .origin_y = {required(rays.origin_y, count, "origin_y"), count},
          .origin_z = {required(rays.origin_z, count, "origin_z"), count},
          .direction_x = {required(rays.direction_x, count, "direction_x"), count},
          .direction_y = {required(rays.direction_y, count, "direction_y"), count},
          .direction_z = {required(rays.direction_z, count, "direction_z"), count},
          .t_min = span_of(rays.t_min, count),
          .t_max = span_of(rays.t_max, count)};
}

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_cast_batch(const scarp_scene* scene, const scarp_ray* rays, const scarp_hit* from, scarp_hit* hits,
                              size_t count) {
  return guarded_on_threads([&] {
    const scarp::Scene& queries = scene_of(scene);
    required(rays, count, "rays");
    required(hits, count, "hits");
    for_each_piece(*scene, rays, from, count, [&](std::size_t first, auto piece, auto starts) {
      const std::span own(reinterpret_cast<scarp::Hit*>(hits + first), piece.size());
      queries.closest_hits(piece, own, {}, starts);
    });
  });
}

scarp_status scarp_occluded_batch(const scarp_scene* scene, const scarp_ray* rays, const scarp_hit* from,
                                  uint8_t* blocked, size_t count) {
  return guarded_on_threads([&] {
    const scarp::Scene& queries = scene_of(scene);
    required(rays, count, "rays");
    required(blocked, count, "blocked");
    for_each_piece(*scene, rays, from, count, [&](std::size_t first, auto piece, auto starts) {
      queries.occluded(piece, std::span(blocked + first, piece.size()), starts);
    });
  });
}

scarp_status scarp_cast_arrays(const scarp_scene* scene, const scarp_ray_arrays* rays, const scarp_hit_arrays* hits,
                               size_t count) {
  return guarded_on_threads([&] {
    const scarp_hit_arrays to = read(hits, "hit_arrays");
    scarp::cast(scene_of(scene), arrays_from(rays, count),
                {.t = span_of(to.t, count),
                 .status = span_of(reinterpret_cast<scarp::HitStatus*>(to.status), count),
                 .object = span_of(to.object, count),
                 .part = span_of(to.part, count),
                 .col = span_of(to.col, count),
                 .row = span_of(to.row, count),
                 .u = span_of(to.u, count),
                 .v = span_of(to.v, count),
                 .normal_x = span_of(to.normal_x, count),
                 .normal_y = span_of(to.normal_y, count),
                 .normal_z = span_of(to.normal_z, count)});
  });
}

scarp_status scarp_occluded_arrays(const scarp_scene* scene, const scarp_ray_arrays* rays, uint8_t* blocked,
                                   size_t count) {
  return guarded_on_threads([&] {
    scarp::occluded(scene_of(scene), arrays_from(rays, count), std::span(required(blocked, count, "blocked"), count));
  });
}

scarp_status scarp_heights_at(const scarp_scene* scene, const double* xs, const double* ys, double* heights,
                              size_t count) {
  return guarded_on_threads([&] {
    const std::span x(required(xs, count, "xs"), count), y(required(ys, count, "ys"), count);
    const std::span to(required(heights, count, "heights"), count);
    const scarp::Scene& queries = scene_of(scene);
    if (count != 1) return scarp::heights_at(queries, x, y, to);
    to[0] = queries.height(x[0], y[0]).value_or(std::numeric_limits<double>::quiet_NaN());  // allocates nothing
  });
}
