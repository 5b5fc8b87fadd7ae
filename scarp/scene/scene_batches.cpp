// SPDX-License-Identifier: MIT
// Batches of a scene whose fields' rays are answered elsewhere: many rays over one field at a time.
//
//   all rays ──▶ one ground beside the tree after the other, each ray no further than to what is known
//   hierarchy ──▶ pairs of ray and object whose box it meets, sorted by field ──▶ one call per field
//
// The hierarchy cannot shorten rays on the way, as it does for single ones: all boxes up to the ground are asked.
#include <algorithm>
#include <utility>

#include "scarp/base/parallel.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/scene_answers.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerPiece = 512;
// What one slice of rays makes of pairs is on its way at once.
constexpr std::size_t kRaysAtOnce = 1 << 17;

// For each i in [0, count), on all threads.
template <class Body>
void for_each(std::size_t count, const Body& body) {
  parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
  });
}

}  // namespace

Scene Scene::answered_by(std::shared_ptr<FieldQueries> queries) const {
  Scene scene = *this;
  scene.queries_ = std::move(queries);
  return scene;
}

// asked: all of one field.
void Scene::ask_closest(std::span<const SceneRay> rays, std::span<const Asked> asked, std::span<SceneHit> hits,
                        std::span<std::uint32_t> steps) const {
  if (asked.empty()) return;
  std::vector<Ray> local(asked.size());
  std::vector<const FieldHit*> from(asked.size());
  std::vector<FieldHit> answers(asked.size());
  std::vector<std::uint32_t> cost(steps.empty() ? 0 : asked.size());
  for_each(asked.size(), [&](std::size_t i) {
    const auto [object, ray] = asked[i];
    local[i] = shortened(objects_[object].placement, rays[ray].ray, hits[ray]);
    from[i] = start_on(object, rays[ray]);
  });
  queries_->closest_hits(objects_[asked.front().object].field, local, from, answers, cost);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    take(answers[i], asked[i].object, hits[asked[i].ray]);
    if (!steps.empty()) steps[asked[i].ray] += cost[i];
  }
}

void Scene::ask_occluded(std::span<const SceneRay> rays, std::span<const Asked> asked,
                         std::span<std::uint8_t> blocked) const {
  if (asked.empty()) return;
  std::vector<Ray> local(asked.size());
  std::vector<const FieldHit*> from(asked.size());
  std::vector<std::uint8_t> answers(asked.size());
  for_each(asked.size(), [&](std::size_t i) {
    const auto [object, ray] = asked[i];
    local[i] = shortened(objects_[object].placement, rays[ray].ray, {});
    from[i] = start_on(object, rays[ray]);
  });
  queries_->occluded(objects_[asked.front().object].field, local, from, answers);
  for (std::size_t i = 0; i < asked.size(); ++i) blocked[asked[i].ray] |= answers[i];
}

// Of rays that are not blocked already: no further than their hit.
std::vector<Scene::Asked> Scene::asked_in_tree(std::span<const SceneRay> rays, std::span<const SceneHit> hits) const {
  std::vector<std::vector<std::uint32_t>> met(rays.size());
  for_each(rays.size(), [&](std::size_t i) {
    Ray reach = rays[i].ray;
    if (!hits.empty() && hits[i]) reach.t_max = hits[i].field.t;
    tree_.traverse(reach, [&](std::uint32_t in_tree) {
      met[i].push_back(in_tree_[in_tree]);
      return reach.t_max;
    });
  });
  std::vector<Asked> asked;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (const std::uint32_t object : met[i]) asked.push_back({object, static_cast<std::uint32_t>(i)});
  }
  return asked;
}

template <class Ask>
void Scene::by_field(std::vector<Asked>& asked, const Ask& ask) const {
  const auto field_of_asked = [&](const Asked& a) { return objects_[a.object].field; };
  std::stable_sort(asked.begin(), asked.end(),
                   [&](const Asked& a, const Asked& b) { return field_of_asked(a) < field_of_asked(b); });
  for (auto begin = asked.begin(); begin != asked.end();) {
    const auto end =
        std::find_if(begin, asked.end(), [&](const Asked& a) { return field_of_asked(a) != field_of_asked(*begin); });
    ask(std::span<const Asked>(begin, end));
    begin = end;
  }
}

void Scene::closest_elsewhere(std::span<const SceneRay> rays, std::span<SceneHit> hits,
                              std::span<std::uint32_t> steps) const {
  std::fill(hits.begin(), hits.end(), SceneHit{});
  std::fill(steps.begin(), steps.end(), 0);
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    const auto some = rays.subspan(first, count);
    const auto found = hits.subspan(first, count);
    const auto cost = steps.empty() ? steps : steps.subspan(first, count);
    for (const std::uint32_t object : beside_tree_) {
      std::vector<Asked> asked(count);
      for (std::size_t i = 0; i < count; ++i) asked[i] = {object, static_cast<std::uint32_t>(i)};
      ask_closest(some, asked, found, cost);
    }
    std::vector<Asked> asked = asked_in_tree(some, found);
    by_field(asked, [&](std::span<const Asked> of_field) { ask_closest(some, of_field, found, cost); });
  }
}

void Scene::occluded_elsewhere(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const {
  std::fill(blocked.begin(), blocked.end(), 0);
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    const auto some = rays.subspan(first, count);
    const auto answers = blocked.subspan(first, count);
    std::vector<Asked> asked = asked_in_tree(some, {});
    by_field(asked, [&](std::span<const Asked> of_field) { ask_occluded(some, of_field, answers); });
    for (const std::uint32_t object : beside_tree_) {
      asked.clear();
      for (std::size_t i = 0; i < count; ++i) {
        if (!answers[i]) asked.push_back({object, static_cast<std::uint32_t>(i)});
      }
      ask_occluded(some, asked, answers);
    }
  }
}

}  // namespace scarp
