// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_query.h"

#include <fmt/format.h>

#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
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

}  // namespace scarp
