// SPDX-License-Identifier: MIT
#include "scarp/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/scene_answers.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerPiece = 512;
// So many of the objects that like batches, the largest ones, are asked about all rays; the others are found by the
// tree.
constexpr std::size_t kMostBesideTree = 4;
// How far a turn may be from orthogonal: many roundings, and no shear that could be meant.
constexpr double kRigid = 1e-9;

bool good(const Placement& p) {
  if (!(std::isfinite(p.scale) && p.scale > 0 && std::isfinite(p.origin.x + p.origin.y + p.origin.z))) return false;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (!(std::abs(dot(p.turn[i], p.turn[j]) - (i == j ? 1 : 0)) <= kRigid)) return false;
    }
  }
  return dot(cross(p.turn[0], p.turn[1]), p.turn[2]) > 0;
}

// Levels of voxels: a grid of 2,048 is a single one then.
constexpr int kCoarsest = 11;

bool empty(const WorldBox& box) { return !(box.low.x <= box.high.x); }

WorldBox world_box(const Placement& placement, const WorldBox& box) {
  WorldBox world;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p =
        placement.world_from_field({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                    corner & 4 ? box.high.z : box.low.z});
    world = around(world, {p, p});
  }
  return world;
}

void require_same_length(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error(fmt::format("batch: {} rays, room for {} answers", rays, answers));
}

}  // namespace

Scene::Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects)
    : fields_(std::move(fields)), objects_(std::move(objects)) {
  std::vector<std::optional<WorldBox>> field_boxes;
  for (const SceneFieldPtr& field : fields_) {
    if (!field) throw Error(fmt::format("scene: field {} is null", field_boxes.size()));
    field_boxes.push_back(field->box());
  }
  for (const SceneObject& object : objects_) {
    const auto index = static_cast<std::size_t>(&object - objects_.data());
    if (object.field >= fields_.size()) {
      throw Error(fmt::format("scene: object {}: its field {} does not exist; there are {}", index, object.field,
                              fields_.size()));
    }
    if (!good(object.placement))
      throw Error(
          fmt::format("scene: object {}: its placement must be a rotation, a scale above 0, a finite place", index));
  }
  std::vector<WorldBox> boxes;
  std::vector<std::pair<double, std::uint32_t>> batched;  // by how much there is of them
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const std::optional<WorldBox>& box = field_boxes[objects_[i].field];
    if (!box) {
      endless_ = true;
      beside_tree_.push_back(i);
      continue;
    }
    if (empty(*box)) continue;
    const WorldBox here = world_box(objects_[i].placement, *box);
    box_ = around(box_, here);
    boxes.push_back(here);
    in_tree_.push_back(i);
    const dvec3 size = here.high - here.low;
    if (field_of(i).likes_batches()) batched.emplace_back(-(size.x * size.y + size.y * size.z + size.z * size.x), i);
  }
  std::sort(batched.begin(), batched.end());
  batched.resize(std::min(batched.size(), kMostBesideTree));
  for (const auto& [unused, i] : batched) {
    beside_tree_.push_back(i);
    const auto place = std::find(in_tree_.begin(), in_tree_.end(), i) - in_tree_.begin();
    in_tree_.erase(in_tree_.begin() + place);
    boxes.erase(boxes.begin() + place);
  }
  tree_ = BoxTree(boxes);
}

void Scene::ask_tree(const SceneRay& ray, SceneHit& best, SceneStats* stats) const {
  Ray reach = ray.ray;
  if (best) reach.t_max = best.field.t;
  tree_.traverse(reach, [&](std::uint32_t in_tree) {
    const std::uint32_t object = in_tree_[in_tree];
    MarchStats march;
    take(field_of(object).closest_hit(shortened(objects_[object].placement, ray.ray, best), start_on(object, ray),
                                      stats ? &march : nullptr),
         object, best);
    if (stats) {
      stats->steps += march.steps;
      ++stats->boxes;
    }
    return best ? best.field.t : ray.ray.t_max;
  });
}

SceneHit Scene::closest_hit(const SceneRay& ray, SceneStats* stats) const {
  SceneHit best;
  if (queries_) {
    std::uint32_t steps = 0;
    closest_elsewhere({&ray, 1}, {&best, 1}, {&steps, 1});
    if (stats) *stats = {.steps = steps};
    return best;
  }
  if (stats) *stats = {};
  for (const std::uint32_t object : beside_tree_) {
    MarchStats march;
    take(field_of(object).closest_hit(shortened(objects_[object].placement, ray.ray, best), start_on(object, ray),
                                      stats ? &march : nullptr),
         object, best);
    if (stats) stats->steps += march.steps;
  }
  ask_tree(ray, best, stats);
  return best;
}

bool Scene::tree_blocks(const SceneRay& ray) const {
  bool blocked = false;
  tree_.traverse(ray.ray, [&](std::uint32_t in_tree) {
    const std::uint32_t object = in_tree_[in_tree];
    blocked = field_of(object).occluded(shortened(objects_[object].placement, ray.ray, {}), start_on(object, ray));
    return blocked ? -std::numeric_limits<double>::infinity() : ray.ray.t_max;
  });
  return blocked;
}

bool Scene::occluded(const SceneRay& ray) const {
  if (queries_) {
    std::uint8_t blocked = 0;
    occluded_elsewhere({&ray, 1}, {&blocked, 1});
    return blocked != 0;
  }
  for (const std::uint32_t object : beside_tree_) {
    if (field_of(object).occluded(shortened(objects_[object].placement, ray.ray, {}), start_on(object, ray)))
      return true;
  }
  return tree_blocks(ray);
}

void Scene::closest_of_piece(std::span<const SceneRay> rays, std::span<SceneHit> hits) const {
  std::vector<Ray> local(rays.size());
  std::vector<const FieldHit*> from(rays.size());
  std::vector<FieldHit> answers(rays.size());
  for (SceneHit& hit : hits) hit = {};
  for (const std::uint32_t object : beside_tree_) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      local[i] = shortened(objects_[object].placement, rays[i].ray, hits[i]);
      from[i] = start_on(object, rays[i]);
    }
    field_of(object).closest_hits(local, from, answers);
    for (std::size_t i = 0; i < rays.size(); ++i) take(answers[i], object, hits[i]);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) ask_tree(rays[i], hits[i], nullptr);
}

void Scene::occluded_of_piece(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const {
  // The tree first: what it blocks need not be followed over the ground.
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    blocked[i] = tree_blocks(rays[i]);
    if (!blocked[i]) open.push_back(i);
  }
  std::vector<Ray> local;
  std::vector<const FieldHit*> from;
  std::vector<std::uint8_t> answers;
  for (const std::uint32_t object : beside_tree_) {
    local.clear(), from.clear();
    for (const std::size_t i : open) {
      local.push_back(shortened(objects_[object].placement, rays[i].ray, {}));
      from.push_back(start_on(object, rays[i]));
    }
    answers.resize(open.size());
    field_of(object).occluded(local, from, answers);
    std::size_t left = 0;
    for (std::size_t j = 0; j < open.size(); ++j) {
      blocked[open[j]] = answers[j];
      if (!answers[j]) open[left++] = open[j];
    }
    open.resize(left);
  }
}

void Scene::closest_hits(std::span<const SceneRay> rays, std::span<SceneHit> hits,
                         std::span<std::uint32_t> steps) const {
  require_same_length(rays.size(), hits.size());
  if (!steps.empty()) require_same_length(rays.size(), steps.size());
  if (queries_) return closest_elsewhere(rays, hits, steps);
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    if (steps.empty()) return closest_of_piece(rays.subspan(first, count), hits.subspan(first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      SceneStats stats;
      hits[i] = closest_hit(rays[i], &stats);
      steps[i] = stats.steps;
    }
  });
}

void Scene::occluded(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const {
  require_same_length(rays.size(), blocked.size());
  if (queries_) return occluded_elsewhere(rays, blocked);
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    occluded_of_piece(rays.subspan(first, count), blocked.subspan(first, count));
  });
}

SceneSurface Scene::placed_surface(std::uint32_t index, const FieldSurface& own, const dvec3& p,
                                   const dvec3& in_field) const {
  const SceneObject& object = objects_[index];
  SceneSurface surface;
  surface.position = p;
  surface.normal = object.placement.world_from_normal(own.normal);
  surface.shading_normal = object.placement.world_from_normal(own.shading_normal);
  surface.object = index;
  // Materials of parts count from 1.
  surface.material = own.material > 0 ? static_cast<std::uint32_t>(own.material - 1) : object.material;
  surface.place = in_field;
  surface.colour = own.colour;
  surface.openness = own.openness;
  return surface;
}

SceneSurface Scene::surface(const Ray& ray, const SceneHit& hit) const {
  const Ray local = objects_[hit.object].placement.field_from_world(ray);
  return placed_surface(hit.object, field_of(hit.object).surface(local, hit.field), ray.at(hit.t()), local.at(hit.t()));
}

std::optional<SceneSurface> Scene::within(const dvec3& p) const {
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const dvec3 in_field = objects_[i].placement.field_from_world(p);
    if (const auto own = field_of(i).within(in_field)) return placed_surface(i, *own, p, in_field);
  }
  return {};
}

Scene Scene::coarser(const SceneDetail& detail) const {
  std::vector<SceneFieldPtr> fields = fields_;
  std::vector<SceneObject> objects = objects_;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> known;  // of a field and a level
  for (SceneObject& object : objects) {
    const SceneField& field = *fields_[object.field];
    const std::optional<WorldBox> box = field.box();
    const double side = field.detail() * object.placement.scale;
    if (!(side > 0) || !box || empty(*box)) continue;
    const WorldBox in_world = world_box(object.placement, *box);
    double depth = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 p(corner & 1 ? in_world.high.x : in_world.low.x, corner & 2 ? in_world.high.y : in_world.low.y,
                    corner & 4 ? in_world.high.z : in_world.low.z);
      depth = std::min(depth, dot(p - detail.eye, detail.forward));
    }
    const double voxels = detail.sample(std::max(depth, 0.0)) / side;
    if (!(voxels >= 2)) continue;
    const int level = std::min(kCoarsest, std::ilogb(voxels));
    const auto [place, fresh] = known.try_emplace({object.field, level}, static_cast<std::uint32_t>(fields.size()));
    if (fresh) {
      SceneFieldPtr coarse = field.coarser(level);
      if (coarse) {
        fields.push_back(std::move(coarse));
      } else {
        place->second = object.field;
      }
    }
    object.field = place->second;
  }
  return Scene(std::move(fields), std::move(objects));
}

std::size_t Scene::bytes() const {
  return sizeof(*this) - sizeof(tree_) + objects_.size() * sizeof(SceneObject) + tree_.bytes() +
         (beside_tree_.size() + in_tree_.size()) * sizeof(std::uint32_t) + fields_.size() * sizeof(SceneFieldPtr);
}

}  // namespace scarp
