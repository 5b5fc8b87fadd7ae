// SPDX-License-Identifier: MIT
// Batches of a scene whose rays a back end traces: many rays over one field at a time.
//
//   all rays ──▶ each ground beside the tree in turn, each ray no farther than its nearest hit so far
//   hierarchy ──▶ pairs of a ray and an object whose box it hits, sorted by field ──▶ one call per field
//
// The hierarchy cannot shorten rays along the way, as it does for single rays: all boxes up to the ground are tested.
// Rays of a scene of one field at the origin are passed to the back end unchanged.
#include "scarp/scene/scene_back_end.h"

#include <algorithm>
#include <utility>

#include "scarp/base/parallel.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/scene_answers.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {
namespace {

// The pairs of a slice of rays are traced together.
constexpr std::size_t kRaysAtOnce = 1 << 17;

// Calls body(i) for each i in [0, count), on all threads.
template <class Body>
void for_each(std::size_t count, const Body& body) {
  parallel_for(static_cast<std::int64_t>(count), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) body(i);
  });
}

}  // namespace

Scene Scene::answered_by(std::shared_ptr<SceneBackEnd> back_end) const {
  Scene scene = *this;
  scene.back_end_ = std::move(back_end);
  return scene;
}

const DeviceTerrain* Scene::device_terrain() const {
  return back_end_ && sole_ ? back_end_->terrain(objects_[sole_object_].field) : nullptr;
}

// pairs: all with the same field.
void Scene::trace_closest(std::span<const Ray> rays, From from, std::span<const Pair> pairs, std::span<Hit> hits,
                          std::span<std::uint32_t> steps) const {
  if (pairs.empty()) return;
  std::vector<Ray> locals(pairs.size());
  std::vector<const Hit*> on_object(from.empty() ? 0 : pairs.size());
  std::vector<Hit> answers(pairs.size());
  std::vector<std::uint32_t> cost(steps.empty() ? 0 : pairs.size());
  for_each(pairs.size(), [&](std::size_t i) {
    const auto [object, ray] = pairs[i];
    const StartedRay started(rays, from, ray);
    locals[i] = local(started, object, hits[ray]);
    if (!from.empty()) on_object[i] = started.from_on(object);
  });
  back_end_->closest_hits(objects_[pairs.front().object].field, locals, answers, cost, on_object);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    take_hit(answers[i], pairs[i].object, hits[pairs[i].ray]);
    if (!steps.empty()) steps[pairs[i].ray] += cost[i];
  }
}

void Scene::trace_occluded(std::span<const Ray> rays, From from, std::span<const Pair> pairs,
                           std::span<std::uint8_t> blocked) const {
  if (pairs.empty()) return;
  std::vector<Ray> locals(pairs.size());
  std::vector<const Hit*> on_object(from.empty() ? 0 : pairs.size());
  std::vector<std::uint8_t> answers(pairs.size());
  for_each(pairs.size(), [&](std::size_t i) {
    const auto [object, ray] = pairs[i];
    const StartedRay started(rays, from, ray);
    locals[i] = local(started, object, {});
    if (!from.empty()) on_object[i] = started.from_on(object);
  });
  back_end_->occluded(objects_[pairs.front().object].field, locals, answers, on_object);
  for (std::size_t i = 0; i < pairs.size(); ++i) blocked[pairs[i].ray] |= answers[i];
}

// Returns the pairs along the rays up to their hits.
std::vector<Scene::Pair> Scene::pairs_in_tree(std::span<const Ray> rays, std::span<const Hit> hits) const {
  std::vector<std::vector<std::uint32_t>> met(rays.size());
  for_each(rays.size(), [&](std::size_t i) {
    Ray reach = rays[i];
    if (!hits.empty() && hits[i]) reach.t_max = hits[i].t;
    tree_.traverse(reach, [&](std::uint32_t object) {
      met[i].push_back(object);
      return reach.t_max;
    });
  });
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (const std::uint32_t object : met[i]) pairs.push_back({object, static_cast<std::uint32_t>(i)});
  }
  return pairs;
}

template <class Query>
void Scene::by_field(std::vector<Pair>& pairs, const Query& query) const {
  const auto field_of_pair = [&](const Pair& pair) { return objects_[pair.object].field; };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const Pair& a, const Pair& b) { return field_of_pair(a) < field_of_pair(b); });
  for (auto begin = pairs.begin(); begin != pairs.end();) {
    const auto end = std::find_if(begin, pairs.end(),
                                  [&](const Pair& pair) { return field_of_pair(pair) != field_of_pair(*begin); });
    query(std::span<const Pair>(begin, end));
    begin = end;
  }
}

void Scene::closest_by_back_end(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                                From from) const {
  if (alone_) return back_end_->closest_hits(objects_[0].field, rays, hits, steps, from);
  std::fill(hits.begin(), hits.end(), Hit{});
  std::fill(steps.begin(), steps.end(), 0);
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    const auto some = rays.subspan(first, count);
    const auto begun = from.empty() ? from : from.subspan(first, count);
    const auto found = hits.subspan(first, count);
    const auto cost = steps.empty() ? steps : steps.subspan(first, count);
    for (const std::uint32_t object : beside_tree_) {
      std::vector<Pair> pairs(count);
      for (std::size_t i = 0; i < count; ++i) pairs[i] = {object, static_cast<std::uint32_t>(i)};
      trace_closest(some, begun, pairs, found, cost);
    }
    std::vector<Pair> pairs = pairs_in_tree(some, found);
    by_field(pairs, [&](std::span<const Pair> of_field) { trace_closest(some, begun, of_field, found, cost); });
  }
}

void Scene::occluded_by_back_end(std::span<const Ray> rays, std::span<std::uint8_t> blocked, From from) const {
  if (sole_) return back_end_->occluded(objects_[sole_object_].field, rays, blocked, from);
  std::fill(blocked.begin(), blocked.end(), 0);
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    const auto some = rays.subspan(first, count);
    const auto begun = from.empty() ? from : from.subspan(first, count);
    const auto answers = blocked.subspan(first, count);
    std::vector<Pair> pairs = pairs_in_tree(some, {});
    by_field(pairs, [&](std::span<const Pair> of_field) { trace_occluded(some, begun, of_field, answers); });
    for (const std::uint32_t object : beside_tree_) {
      if (field_of(object).is_backdrop()) continue;
      pairs.clear();
      for (std::size_t i = 0; i < count; ++i) {
        if (!answers[i]) pairs.push_back({object, static_cast<std::uint32_t>(i)});
      }
      trace_occluded(some, begun, pairs, answers);
    }
  }
}

}  // namespace scarp
