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
#include "scarp/scene/valid_rays.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerCheck = 8192, kPointsPerPiece = 1024;

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
  try {
    require_valid(ray, from, scene);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void require_valid(std::span<const Ray> rays, std::span<const Hit* const> from, const Scene& scene, std::size_t first,
                   std::size_t all) {
  if (!from.empty() && from.size() != rays.size())
    throw Error(fmt::format("batch: {} rays, {} hits to start from", rays.size(), from.size()));
  const auto from_of = [&](std::int64_t i) { return from.empty() ? nullptr : from[static_cast<std::size_t>(i)]; };
  const auto count = static_cast<std::int64_t>(rays.size());
  std::atomic<std::int64_t> first_bad = count;
  parallel_for(count, kRaysPerCheck, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < std::min(end, first_bad.load(std::memory_order_relaxed)); ++i) {
      if (is_valid(rays[static_cast<std::size_t>(i)], from_of(i), scene)) continue;
      std::int64_t known = first_bad;
      while (i < known && !first_bad.compare_exchange_weak(known, i)) {
      }
    }
  });
  if (first_bad == count) return;
  try {
    require_valid(rays[static_cast<std::size_t>(first_bad)], from_of(first_bad), scene);
  } catch (const Error& error) {
    std::string_view what = error.what();
    if (what.starts_with("ray: ")) what.remove_prefix(5);
    throw Error(fmt::format("ray {} of {}: {}", first + static_cast<std::size_t>(first_bad.load()), all, what));
  }
}

Hit cast(const Scene& scene, const Ray& ray, const Hit* from) {
  require_valid(ray, from, scene);
  return scene.closest_hit(ray, from);
}

void cast(const Scene& scene, std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) {
  require_valid(rays, from, scene, 0, rays.size());
  scene.closest_hits(rays, hits, {}, from);
}

bool occluded(const Scene& scene, const Ray& ray, const Hit* from) {
  require_valid(ray, from, scene);
  return scene.occluded(ray, from);
}

void occluded(const Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              std::span<const Hit* const> from) {
  require_valid(rays, from, scene, 0, rays.size());
  scene.occluded(rays, blocked, from);
}

void heights_at(const Scene& scene, std::span<const double> xs, std::span<const double> ys, std::span<double> heights) {
  if (ys.size() != xs.size() || heights.size() != xs.size())
    throw Error(fmt::format("heights: {} x, {} y, room for {} heights", xs.size(), ys.size(), heights.size()));
  parallel_for(static_cast<std::int64_t>(xs.size()), kPointsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      heights[i] = scene.height(xs[i], ys[i]).value_or(std::numeric_limits<double>::quiet_NaN());
  });
}

}  // namespace scarp
