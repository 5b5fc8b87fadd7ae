// SPDX-License-Identifier: MIT
#include "scarp/scene/cast.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/field/ground_points.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/valid_rays.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerCheck = 8192, kPointsPerPiece = 1024;
// Batches of at most this many rays are traced ray by ray on the calling thread.
constexpr std::size_t kFewRays = 16;

bool are_few(const Scene& scene, std::size_t rays, std::size_t answers) {
  return rays <= kFewRays && rays == answers && !scene.on_device();
}

// True only for rays that validate() accepts, and for nearly all of those, at a fraction of its cost. Sums of numbers
// are finite only if the numbers are.
bool is_plain(const Ray& ray, bool wraps) {
  const dvec3 sum = ray.origin + ray.direction;
  return std::isfinite(sum.x + sum.y + sum.z + ray.t_min) && ray.direction != dvec3(0.0) && ray.t_max >= ray.t_min &&
         !(wraps && std::isinf(ray.t_max)) && ray.start == RayStart::free;
}

void require_valid(const Ray& ray, const Hit* from, const Scene& scene) {
  if (!is_plain(ray, scene.wraps())) validate(ray, scene);
  if (from && (!*from || from->object >= scene.objects().size()))
    throw Error("ray: it starts on the surface of what is not a hit of this scene");
}

bool is_valid(const Ray& ray, const Hit* from, const Scene& scene) {
  if (!from && is_plain(ray, scene.wraps())) return true;
  if (!is_followable(ray)) return false;
  try {
    require_valid(ray, from, scene);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// The index of the first ray that cannot be traced, even if a thread finds another one earlier; rays.size() if all can.
std::size_t first_invalid(std::span<const Ray> rays, std::span<const Hit* const> from, const Scene& scene) {
  const auto is_good = [&](std::size_t i) { return is_valid(rays[i], from.empty() ? nullptr : from[i], scene); };
  if (rays.size() <= kFewRays) {
    std::size_t i = 0;
    while (i < rays.size() && is_good(i)) ++i;
    return i;
  }
  const auto count = static_cast<std::int64_t>(rays.size());
  std::atomic<std::int64_t> first_bad = count;
  parallel_for(count, kRaysPerCheck, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < std::min(end, first_bad.load(std::memory_order_relaxed)); ++i) {
      if (is_good(static_cast<std::size_t>(i))) continue;
      std::int64_t known = first_bad;
      while (i < known && !first_bad.compare_exchange_weak(known, i)) {
      }
    }
  });
  return static_cast<std::size_t>(first_bad.load());
}

Hit invalid_hit() {
  Hit hit;
  hit.status = HitStatus::invalid;
  return hit;
}

void require_starts(std::size_t rays, std::size_t from) {
  if (from != 0 && from != rays) throw Error(fmt::format("batch: {} rays, {} hits to start from", rays, from));
}

// Calls trace(rays, from) and then invalid(i) for each ray i that cannot be traced.
template <class Trace, class Invalid>
void trace_valid(const Scene& scene, std::span<const Ray> rays, std::span<const Hit* const> from, BadRays bad,
                 const Trace& trace, const Invalid& invalid) {
  if (bad == BadRays::refuse) {
    require_valid(rays, from, scene, 0, rays.size());
    return trace(rays, from);
  }
  require_starts(rays.size(), from.size());
  if (first_invalid(rays, from, scene) == rays.size()) return trace(rays, from);
  std::vector<Ray> valid(rays.begin(), rays.end());
  std::vector<const Hit*> starts(from.begin(), from.end());
  const std::vector<std::size_t> found = replace_invalid(valid, starts, scene);
  trace(valid, starts);
  for (const std::size_t i : found) invalid(i);
}

}  // namespace

void require_valid(std::span<const Ray> rays, std::span<const Hit* const> from, const Scene& scene, std::size_t first,
                   std::size_t all) {
  require_starts(rays.size(), from.size());
  const std::size_t bad = first_invalid(rays, from, scene);
  if (bad == rays.size()) return;
  try {
    require_valid(rays[bad], from.empty() ? nullptr : from[bad], scene);
  } catch (const Error& error) {
    std::string_view what = error.what();
    if (what.starts_with("ray: ")) what.remove_prefix(5);
    throw Error(fmt::format("ray {} of {}: {}", first + bad, all, what));
  }
}

std::vector<std::size_t> replace_invalid(std::span<Ray> rays, std::span<const Hit*> from, const Scene& scene) {
  std::vector<std::size_t> invalid;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (is_valid(rays[i], from.empty() ? nullptr : from[i], scene)) continue;
    invalid.push_back(i);
    rays[i] = {.origin = {0, 0, 0}, .direction = {0, 0, 1}, .t_max = 0};
    if (!from.empty()) from[i] = nullptr;
  }
  return invalid;
}

Hit cast(const Scene& scene, const Ray& ray, const Hit* from) {
  require_valid(ray, from, scene);
  return scene.closest_hit(ray, from);
}

void cast(const Scene& scene, std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from,
          BadRays bad) {
  const auto trace = [&](std::span<const Ray> valid, std::span<const Hit* const> starts) {
    if (!are_few(scene, valid.size(), hits.size())) return scene.closest_hits(valid, hits, {}, starts);
    for (std::size_t i = 0; i < valid.size(); ++i)
      hits[i] = scene.closest_hit(valid[i], starts.empty() ? nullptr : starts[i]);
  };
  trace_valid(scene, rays, from, bad, trace, [&](std::size_t i) { hits[i] = invalid_hit(); });
}

bool occluded(const Scene& scene, const Ray& ray, const Hit* from) {
  require_valid(ray, from, scene);
  return scene.occluded(ray, from);
}

void occluded(const Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              std::span<const Hit* const> from, BadRays bad) {
  const auto trace = [&](std::span<const Ray> valid, std::span<const Hit* const> starts) {
    if (!are_few(scene, valid.size(), blocked.size())) return scene.occluded(valid, blocked, starts);
    for (std::size_t i = 0; i < valid.size(); ++i)
      blocked[i] = scene.occluded(valid[i], starts.empty() ? nullptr : starts[i]);
  };
  trace_valid(scene, rays, from, bad, trace, [&](std::size_t i) { blocked[i] = kInvalidRay; });
}

void heights_at(const Scene& scene, std::span<const double> xs, std::span<const double> ys, std::span<double> heights) {
  if (ys.size() != xs.size() || heights.size() != xs.size())
    throw Error(fmt::format("heights: {} x, {} y, room for {} heights", xs.size(), ys.size(), heights.size()));
  if (const HeightField* field = scene.only_heights()) return heights_at(*field, xs, ys, heights);
  parallel_for(static_cast<std::int64_t>(xs.size()), kPointsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      heights[i] = scene.height(xs[i], ys[i]).value_or(std::numeric_limits<double>::quiet_NaN());
  });
}

}  // namespace scarp
