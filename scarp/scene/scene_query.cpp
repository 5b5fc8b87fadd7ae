// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_query.h"

#include <fmt/format.h>

#include <glm/matrix.hpp>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/object_boxes.h"
#include "scarp/scene/scene_answers.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {

SceneQuery Scene::query(SceneRules rules) const { return {*this, std::move(rules)}; }

SceneQuery::SceneQuery(const Scene& scene, SceneRules rules) : scene_(scene), rules_(std::move(rules)) {
  if (scene.on_device()) throw Error("scene: masks, sides and filters are for rays on the CPU (query another scene)");
  std::uint32_t masks = 0;
  for (const SceneObject& object : scene.objects()) masks |= object.mask;
  if (scene.objects().empty() || (masks & rules_.mask) != 0) return;
  throw Error(fmt::format("scene: mask {:#x} is that of no object (together they have {:#x})", rules_.mask, masks));
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
    if (!about_hits(&rules_)) {
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
    if (!about_hits(&rules_)) {
      return scene_.occluded_of_piece(rays.subspan(first, count), from.empty() ? from : from.subspan(first, count),
                                      blocked.subspan(first, count), &rules_);
    }
    for (std::size_t i = first; i < first + count; ++i) blocked[i] = scene_.any({rays, from, i, &rules_});
  });
}

// f(object, field, box) for the objects that the mask selects; the box is around the object.
template <class F>
void SceneQuery::for_each_in_contact(const F& f) const {
  scene_.require_current();
  for (std::uint32_t i = 0; i < scene_.objects().size(); ++i) {
    const SceneField& field = scene_.field_of(i);
    if (!sees(&rules_, scene_.objects()[i]) || field.is_backdrop()) continue;
    const std::optional<WorldBox> box = field.extent();
    f(i, field, box ? std::optional(world_box(scene_.objects()[i].placement, *box)) : std::nullopt);
  }
}

std::optional<SceneContact> SceneQuery::sweep(const Capsule& capsule, const dvec3& motion) const {
  validate(capsule, motion);
  std::optional<SceneContact> best;
  for_each_in_contact([&](std::uint32_t object, const SceneField& field, const std::optional<WorldBox>& box) {
    const double last = best ? best->t : 1;
    if (box && (box->empty() || sweep_bound(capsule, motion, box->low, box->high, last) > last)) return;
    const Placement& to = scene_.objects()[object].placement;
    const auto found =
        field.sweep({to.field_from_world(capsule.a), to.field_from_world(capsule.b), capsule.radius / to.scale},
                    to.field_from_world(Ray{.direction = motion}).direction);
    if (!found || (best && found->t >= best->t)) return;
    best = SceneContact{*found, object};
    best->point = to.world_from_field(found->point);
    best->normal = to.world_from_normal(found->normal);
  });
  return best;
}

bool SceneQuery::overlaps(const TurnedBox& box) const {
  validate(box);
  bool found = false;
  for_each_in_contact([&](std::uint32_t object, const SceneField& field, const std::optional<WorldBox>& around) {
    if (found || (around && (around->empty() || !scarp::overlaps(box, around->low, around->high)))) return;
    const Placement& to = scene_.objects()[object].placement;
    found = field.overlaps({to.field_from_world(box.centre), box.half / to.scale, transpose(to.turn) * box.turn});
  });
  return found;
}

std::optional<ScenePoint> SceneQuery::closest_point(const dvec3& p, double max_distance) const {
  std::optional<ScenePoint> best;
  for_each_in_contact([&](std::uint32_t object, const SceneField& field, const std::optional<WorldBox>& box) {
    const double most = best ? best->distance : max_distance;
    if (box && (box->empty() || length(min(max(p, box->low), box->high) - p) > most * (1 + 0x1p-40))) return;
    const Placement& to = scene_.objects()[object].placement;
    const auto found = field.closest_point(to.field_from_world(p), most / to.scale);
    if (!found || (best && found->distance * to.scale >= best->distance)) return;
    best = ScenePoint{*found, object};
    best->distance = found->distance * to.scale;
    best->point = to.world_from_field(found->point);
    best->normal = to.world_from_normal(found->normal);
  });
  return best;
}

}  // namespace scarp
