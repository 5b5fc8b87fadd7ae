// SPDX-License-Identifier: MIT
#include "scarp/march/height/queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/prefetch.h"
#include "scarp/march/height/fan_batch.h"
#include "scarp/march/height/ground_order.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerScalarPiece = 256;
constexpr std::int64_t kRaysPerVectorPiece = 2048;  // at the end of a piece, vectors have idle lanes
constexpr std::size_t kFewForVectors = 32;
constexpr std::size_t kRaysAtOnce = 1 << 22;  // size of the groups that are sorted
constexpr std::size_t kAhead = 6;

void require_same_length(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error(fmt::format("batch: {} rays, room for {} answers", rays, answers));
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void prefetch_ray(const Ray& ray) {
  prefetch(&ray);
  prefetch(reinterpret_cast<const char*>(&ray) + 64);  // the next cache line
}

// Calls body(first, order) for pieces of the rays on all threads: traces those from `first` on or, if `order` is not
// empty, those at its indices relative to `first`. Groups rays over the same tile of ground where that pays.
template <class Body>
void for_each_piece(const HeightField& field, std::span<const Ray> rays, std::int64_t rays_per_piece,
                    const Body& body) {
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::span<const Ray> part = rays.subspan(first, std::min(kRaysAtOnce, rays.size() - first));
    const std::vector<std::uint32_t> order = ground_order(field, part);
    parallel_for(static_cast<std::int64_t>(part.size()), rays_per_piece, [&](std::int64_t begin, std::int64_t end) {
      const auto from = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
      if (order.empty()) {
        body(first + from, count, {});
      } else {
        body(first, count, std::span(order).subspan(from, count));
      }
    });
  }
}

// Answers ray by ray, using answer(i).
template <class Answer>
void for_each_ray(const HeightField& field, std::span<const Ray> rays, const Answer& answer) {
  for_each_piece(field, rays, kRaysPerScalarPiece,
                 [&](std::size_t first, std::size_t count, std::span<const std::uint32_t> order) {
                   for (std::size_t i = 0; i < count; ++i) {
                     // Rays that are not traced in memory order must be prefetched.
                     if (i + kAhead < order.size()) prefetch_ray(rays[first + order[i + kAhead]]);
                     answer(first + (order.empty() ? i : order[i]));
                   }
                 });
}

// Answers many rays at once, using answer(rays, answers).
template <class Result, class Answer>
void in_vectors(const HeightField& field, std::span<const Ray> rays, std::span<Result> results, const Answer& answer) {
  // Even a thousand rays are worth several threads.
  const auto some = static_cast<std::int64_t>(rays.size() / 8);
  const std::int64_t piece = std::clamp(some, kRaysPerScalarPiece, kRaysPerVectorPiece);
  for_each_piece(field, rays, piece, [&](std::size_t first, std::size_t count, std::span<const std::uint32_t> order) {
    if (order.empty()) return answer(rays.subspan(first, count), results.subspan(first, count));
    std::vector<Ray> ordered(count);
    std::vector<Result> answers(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (i + kAhead < count) prefetch_ray(rays[first + order[i + kAhead]]);
      ordered[i] = rays[first + order[i]];
    }
    answer(ordered, answers);
    for (std::size_t i = 0; i < count; ++i) results[first + order[i]] = answers[i];
  });
}

}  // namespace

void closest_hits(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits,
                  const HeightMarchEntry& march, const MarchSettings& settings) {
  require(target, HeightPart::none);
  require_same_length(rays.size(), hits.size());
  if (march.fans) {
    if (const auto fan = fan_batch(target, rays)) return closest_hits_in_fan(target, *fan, rays, hits);
  }
  if (march.simd && rays.size() >= kFewForVectors) {
    return in_vectors(*target.field, rays, hits, [&](std::span<const Ray> some, std::span<Hit> answers) {
      march.batch(target, some, answers, settings);
    });
  }
  for_each_ray(*target.field, rays, [&](std::size_t i) { hits[i] = march.cpu(target, rays[i], settings, nullptr); });
}

void occluded(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const HeightMarchEntry& march, const MarchSettings& settings) {
  require(target, HeightPart::none);
  require_same_length(rays.size(), blocked.size());
  if (march.simd && rays.size() >= kFewForVectors) {
    return in_vectors(*target.field, rays, blocked, [&](std::span<const Ray> some, std::span<std::uint8_t> answers) {
      march.occluded_batch(target, some, answers, settings);
    });
  }
  for_each_ray(*target.field, rays, [&](std::size_t i) { blocked[i] = march.occluded(target, rays[i], settings); });
}

void validate(const Ray& ray) {
  if (!finite(ray.origin)) throw Error("ray: its origin is not finite");
  if (!finite(ray.direction)) throw Error("ray: its direction is not finite");
  if (ray.direction == dvec3(0.0)) throw Error("ray: its direction is zero");
  if (!std::isfinite(ray.t_min) || std::isnan(ray.t_max) || ray.t_max < ray.t_min) {
    throw Error(
        fmt::format("ray: its range is {} to {}; t_min must be finite and t_max no less", ray.t_min, ray.t_max));
  }
}

void validate(const Ray& ray, const HeightField& field) {
  validate(ray);
  if (field.wraps() && std::isinf(ray.t_max)) {
    throw Error("ray: its range has no end; over a field that wraps round t_max must be finite");
  }
  if (ray.start == RayStart::on_surface) {
    const Cell cell = ray.start_cell;
    const bool exists = cell.col >= 0 && cell.col < field.cell_cols() && cell.row >= 0 && cell.row < field.cell_rows();
    if (!exists || !field.cell_heights(cell)) {
      throw Error(fmt::format("ray: it starts on the surface of cell ({}, {}), which {}", cell.col, cell.row,
                              exists ? "is a hole" : "does not exist"));
    }
  }
}

}  // namespace scarp
