// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_query.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/object_boxes.h"
#include "scarp/scene/scene_answers.h"
#include "scarp/scene/scene_limits.h"
#include "scarp/scene/tree/contact_search.h"

namespace scarp {
namespace {

// As world_box(), padded for its rounding.
WorldBox padded_box(const Placement& to, const WorldBox& box) {
  const WorldBox world = world_box(to, box);
  const double room = kPlacing * (length(to.origin) + to.scale * (length(box.low) + length(box.high)));
  return {world.low - room, world.high + room};
}

}  // namespace

SceneQuery Scene::query(SceneRules rules) const& { return {*this, std::move(rules)}; }

SceneQuery::SceneQuery(const Scene& scene, SceneRules rules) : scene_(scene), rules_(std::move(rules)) {
  if (scene.on_device()) throw Error("scene: masks, sides and filters are for rays on the CPU (query another scene)");
  std::uint32_t masks = 0;
  for (const SceneObject& object : scene.objects()) masks |= object.mask;
  if (!scene.objects().empty() && (masks & rules_.mask) == 0)
    throw Error(fmt::format("scene: mask {:#x} is that of no object (together they have {:#x})", rules_.mask, masks));
  find_no_contacts();
}

Hit SceneQuery::closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const {
  scene_.require_current();
  return scene_.closest({ray, from, &rules_}, stats);
}

bool SceneQuery::occluded(const Ray& ray, const Hit* from) const {
  scene_.require_current();
  return scene_.any({ray, from, &rules_});
}

void SceneQuery::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const {
  scene_.require_current();
  require_same_length(rays.size(), hits.size());
  if (!from.empty()) require_same_length(rays.size(), from.size());
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    if (!about_hits(&rules_) && !any_odd(rays.subspan(first, count))) {
      return scene_.closest_of_piece(rays.subspan(first, count), from.empty() ? from : from.subspan(first, count),
                                     hits.subspan(first, count), &rules_);
    }
    for (std::size_t i = first; i < first + count; ++i) hits[i] = scene_.closest({rays, from, i, &rules_}, nullptr);
  });
}

void SceneQuery::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                          std::span<const Hit* const> from) const {
  scene_.require_current();
  require_same_length(rays.size(), blocked.size());
  if (!from.empty()) require_same_length(rays.size(), from.size());
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    if (!about_hits(&rules_) && !any_odd(rays.subspan(first, count))) {
      return scene_.occluded_of_piece(rays.subspan(first, count), from.empty() ? from : from.subspan(first, count),
                                      blocked.subspan(first, count), &rules_);
    }
    for (std::size_t i = first; i < first + count; ++i) blocked[i] = scene_.any({rays, from, i, &rules_});
  });
}

void SceneQuery::find_no_contacts() {
  if (scene_.without_contacts_.empty()) return;
  for (std::uint32_t i = 0; i < scene_.objects().size() && no_contacts_.empty(); ++i) {
    const SceneField& field = scene_.field_of(i);
    if (sees(&rules_, scene_.objects()[i]) && !field.is_backdrop()) no_contacts_ = field.no_contacts();
  }
}

// Calls visit(object, field) for the objects that the mask selects and that may contain something no worse than `end`.
// bound() and the result of visit() are as for BoxTree::search().
template <class Bound, class Visit>
void SceneQuery::search(double end, const Bound& bound, const Visit& visit) const {
  scene_.require_current();
  if (!no_contacts_.empty()) throw Error(no_contacts_);
  const auto visit_seen = [&](std::uint32_t object) {
    const SceneField& field = scene_.field_of(object);
    if (sees(&rules_, scene_.objects()[object]) && !field.is_backdrop()) end = visit(object, field);
    return end;
  };
  for (const std::uint32_t object : scene_.beside_tree_) {
    if (const std::optional<WorldBox> extent = scene_.field_of(object).extent()) {
      if (extent->empty() || !(bound(padded_box(scene_.objects()[object].placement, *extent)) <= end)) continue;
    }
    if (visit_seen(object) < 0) return;
  }
  scene_.tree_.search(end, bound, visit_seen);
}

std::optional<SceneContact> SceneQuery::sweep(const Capsule& capsule, const dvec3& motion) const {
  validate(capsule, motion);
  std::optional<SceneContact> best;
  const auto last = [&] { return best ? best->t : 1; };
  const auto bound = [&](const WorldBox& box) { return sweep_bound(capsule, motion, box.low, box.high, last()); };
  search(1, bound, [&](std::uint32_t object, const SceneField& field) {
    const Placement& to = scene_.objects()[object].placement;
    const auto found =
        field.sweep({to.field_from_world(capsule.a), to.field_from_world(capsule.b), capsule.radius / to.scale},
                    to.field_from_world(Ray{.direction = motion}).direction);
    if (found && (!best || is_before(found->t, object, best->t, best->object))) {
      best = SceneContact{*found, object};
      best->point = to.world_from_field(found->point);
      best->normal = to.world_from_normal(found->normal);
      best->depth = found->depth * to.scale;
    }
    return last();
  });
  return best;
}

bool SceneQuery::overlaps(const TurnedBox& box) const {
  validate(box);
  bool found = false;
  const auto bound = [&](const WorldBox& other) { return overlap_bound(box, other); };
  search(0, bound, [&](std::uint32_t object, const SceneField& field) {
    const Placement& to = scene_.objects()[object].placement;
    found = field.overlaps({to.field_from_world(box.centre), box.half / to.scale, transpose(to.turn) * box.turn});
    return found ? -1.0 : 0.0;
  });
  return found;
}

std::optional<ScenePoint> SceneQuery::closest_point(const dvec3& p, double max_distance) const {
  if (!(p == p) || !std::isfinite(longest_of(p)) || std::isnan(max_distance))
    throw Error("closest point: the point must be finite and the distance a number");
  std::optional<ScenePoint> best;
  const auto distance = [&] { return best ? std::optional(best->distance) : std::nullopt; };
  const auto bound = [&](const WorldBox& box) { return distance_bound(p, box); };
  search(reach_of(p, max_distance), bound, [&](std::uint32_t object, const SceneField& field) {
    const Placement& to = scene_.objects()[object].placement;
    const auto found = closest_of_object(p, max_distance, distance(), [&](double most) {
      return field.closest_point(to.field_from_world(p), most / to.scale);
    });
    if (found && (!best || is_before(found->distance * to.scale, object, best->distance, best->object))) {
      best = ScenePoint{*found, object};
      best->distance = found->distance * to.scale;
      best->point = to.world_from_field(found->point);
      best->normal = to.world_from_normal(found->normal);
    }
    return reach_of(p, distance().value_or(max_distance));
  });
  return best;
}

}  // namespace scarp
