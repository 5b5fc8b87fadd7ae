// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_field.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {
namespace {

const Hit* at(std::span<const Hit* const> from, std::size_t i) { return from.empty() ? nullptr : from[i]; }
std::span<const Hit* const> part(std::span<const Hit* const> from, std::size_t first, std::size_t count) {
  return from.empty() ? from : from.subspan(first, count);
}

bool all_followable(std::span<const Ray> rays) { return std::all_of(rays.begin(), rays.end(), is_followable); }

// Calls piece(first, count) on all threads.
template <class Piece>
void for_each_piece(std::size_t rays, const Piece& piece) {
  parallel_for(static_cast<std::int64_t>(rays), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    piece(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  });
}

}  // namespace

const HeightField* height_field_of(const SceneField& field) {
  const SceneFieldParts parts = field.parts();
  const auto* heights = std::get_if<SceneFieldParts::Heights>(&parts.of);
  return heights ? heights->field : nullptr;
}

std::optional<double> SceneField::height(double, double) const { return {}; }

Ray SceneField::started(const Ray& ray, const Hit* from) const {
  Ray r = ray;
  r.start = from ? RayStart::on_surface : RayStart::free;
  return r;
}

Hit SceneField::accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const {
  const Hit hit = closest_hit(ray, from, stats);
  if (!hit || !rules.accept || (*rules.accept)(hit)) return hit;
  throw Error(
      fmt::format("scene: the filter rejected a hit on a {}; {} cannot continue behind it (use another march, or "
                  "exclude the object by its mask)",
                  kind(), march()));
}

std::string SceneField::no_trace() const {
  return fmt::format("the march {} of a {} records no steps", march(), kind());
}
Hit SceneField::traced_hit(const Ray&, MarchStats*, MarchTrace&) const { throw Error(no_trace()); }

std::string SceneField::no_contacts() const {
  return fmt::format("scene: contacts support height fields, tiles and voxels, not a {} (exclude it by its mask)",
                     kind());
}
std::optional<FieldContact> SceneField::sweep(const Capsule&, const dvec3&) const { throw Error(no_contacts()); }
bool SceneField::overlaps(const TurnedBox&) const { throw Error(no_contacts()); }
std::optional<FieldPoint> SceneField::closest_point(const dvec3&, double) const { throw Error(no_contacts()); }

void SceneField::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit* hit = at(from, i);
    hits[i] = closest_hit(from.empty() || hit ? rays[i] : started(rays[i], nullptr), hit, nullptr);
  }
}

void SceneField::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                          std::span<const Hit* const> from) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit* hit = at(from, i);
    blocked[i] = occluded(from.empty() || hit ? rays[i] : started(rays[i], nullptr), hit);
  }
}

void SceneField::closest_hits_on_all_threads(std::span<const Ray> rays, std::span<Hit> hits,
                                             std::span<std::uint32_t> steps, std::span<const Hit* const> from) const {
  for_each_piece(rays.size(), [&](std::size_t first, std::size_t count) {
    if (steps.empty() && all_followable(rays.subspan(first, count)))
      return closest_hits(rays.subspan(first, count), hits.subspan(first, count), part(from, first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      const Hit* hit = at(from, i);
      MarchStats stats;
      hits[i] = is_followable(rays[i])
                    ? closest_hit(from.empty() || hit ? rays[i] : started(rays[i], nullptr), hit, &stats)
                    : Hit{};
      if (!steps.empty()) steps[i] = stats.steps;
    }
  });
}

void SceneField::occluded_on_all_threads(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                                         std::span<const Hit* const> from) const {
  for_each_piece(rays.size(), [&](std::size_t first, std::size_t count) {
    if (all_followable(rays.subspan(first, count)))
      return occluded(rays.subspan(first, count), blocked.subspan(first, count), part(from, first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      const Hit* hit = at(from, i);
      blocked[i] = is_followable(rays[i]) && occluded(from.empty() || hit ? rays[i] : started(rays[i], nullptr), hit);
    }
  });
}

}  // namespace scarp
