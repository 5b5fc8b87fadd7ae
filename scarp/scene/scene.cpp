// SPDX-License-Identifier: MIT
#include "scarp/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/kept_memory.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/ray_room.h"
#include "scarp/march/usual_ray.h"
#include "scarp/scene/object_boxes.h"
#include "scarp/scene/object_queues.h"
#include "scarp/scene/scene_answers.h"
#include "scarp/scene/scene_back_end.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {
namespace {

// Maximum level of voxels: a grid with sides of 2,048 is a single voxel then.
constexpr int kCoarsest = 11;

// Materials of cells and parts count from 1.
std::uint32_t material_of(const SceneObject& object, int own) {
  return own > 0 ? static_cast<std::uint32_t>(own - 1) : object.material;
}

void require_mask(std::uint32_t mask, std::size_t object) {
  if (mask == 0) throw Error(fmt::format("scene: object {}: its mask is 0, so no query would see it", object));
}

}  // namespace

void require_same_length(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error(fmt::format("batch: {} rays, room for {} answers", rays, answers));
}

Scene::Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects)
    : fields_(std::move(fields)), objects_(std::move(objects)) {
  seen_.set(edits_of_all_fields.load(std::memory_order_relaxed));
  std::vector<std::optional<WorldBox>> field_boxes, field_extents;
  for (const SceneFieldPtr& field : fields_) {
    const std::size_t index = field_boxes.size();
    if (!field) throw Error(fmt::format("scene: field {} is null", index));
    if (field->outdated()) {
      throw Error(fmt::format("scene: field {} ({}) was edited after it was built (build the field again)", index,
                              field->kind()));
    }
    field_boxes.push_back(field->box());
    field_extents.push_back(field->extent());
    watch_field(static_cast<std::uint32_t>(index));
  }
  for (const SceneObject& object : objects_) {
    const auto index = static_cast<std::size_t>(&object - objects_.data());
    if (object.field >= fields_.size()) {
      throw Error(fmt::format("scene: object {}: its field {} does not exist (there are {})", index, object.field,
                              fields_.size()));
    }
    require_placement(object.placement, index);
    require_mask(object.mask, index);
  }
  std::vector<WorldBox> boxes(objects_.size());
  std::vector<std::uint32_t> in_tree;
  std::vector<std::pair<double, std::uint32_t>> batched;  // minus half the box area, object
  int voxels = 0, placed_voxels = 0;
  double farthest = 0;
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const auto& [field, material, placement, mask] = objects_[i];
    in_place_.push_back(placement.identity());
    frames_.push_back(frame_of(placement));
    const WorldBox extent = field_extents[field] ? world_box(placement, *field_extents[field]) : WorldBox{};
    box_ = around(box_, extent);
    if (const double far = farthest_of(placement, fields_[field]->farthest_voxel(), extent); far > 0) {
      farthest = std::max(farthest, far);
      ++voxels, placed_voxels += !in_place_[i];
    }
    if (!field_boxes[field]) {
      beside_tree_.push_back(i);
      continue;
    }
    boxes[i] = world_box(placement, *field_boxes[field]);
    if (boxes[i].empty()) continue;
    in_tree.push_back(i);
    if (field_of(i).likes_batches()) batched.emplace_back(-half_area(boxes[i]), i);
  }
  std::sort(batched.begin(), batched.end());
  batched.resize(std::min(batched.size(), kMostBesideTree));
  for (const auto& [unused, i] : batched) {
    beside_tree_.push_back(i);
    in_tree.erase(std::find(in_tree.begin(), in_tree.end(), i));
  }
  tree_ = BoxTree(boxes, std::move(in_tree));
  if (voxels > 1 || placed_voxels > 0) room_ = room_of_voxels(farthest);
  rooms_.resize(objects_.size());
  for (std::uint32_t i = 0; i < objects_.size(); ++i) find_room(i);
  find_special();
}

void Scene::find_room(std::uint32_t object) {
  const bool voxels = room_ > 0 && field_of(object).farthest_voxel() > 0;
  rooms_[object] = voxels ? ray_room(room_ / objects_[object].placement.scale) : std::uint16_t{0};
}

void Scene::watch_field(std::uint32_t index) {
  if (const auto edits = fields_[index]->edits()) editable_.push_back({index, *edits});
  if (fields_[index]->memory()) with_owner_.push_back(index);
  if (!fields_[index]->no_contacts().empty()) without_contacts_.push_back(index);
}

void Scene::unwatch_field(std::uint32_t index) {
  std::erase_if(editable_, [&](const Editable& editable) { return editable.field == index; });
  std::erase(with_owner_, index);
  std::erase(without_contacts_, index);
}

// Before every ray query.
void Scene::require_current() const {
  const std::uint64_t edits = edits_of_all_fields.load(std::memory_order_relaxed);
  if (edits != seen_.value()) compare_edits(edits);
  if (!with_owner_.empty()) require_memory();
}

void Scene::compare_edits(std::uint64_t edits) const {
  for (const Editable& editable : editable_) {
    const SceneField& field = *fields_[editable.field];
    if (field.edits() == editable.edits) continue;
    throw Error(
        fmt::format("scene: field {} ({}) was edited after the scene was built (build the scene again, or edit in "
                    "LiveScene::edit())",
                    editable.field, field.kind()));
  }
  seen_.set(edits);
}

void Scene::require_memory() const {
  for (const std::uint32_t index : with_owner_) {
    if (!fields_[index]->memory()->expired()) continue;
    throw Error(fmt::format("scene: field {} ({}): the memory of its samples was freed (keep it as long as its scenes)",
                            index, fields_[index]->kind()));
  }
}

// The special objects: unbounded ones, backdrops, height fields, and a single one.
void Scene::find_special() {
  endless_ = wraps_ = false;
  walls_end_ = -std::numeric_limits<double>::infinity();
  std::vector<std::uint8_t> endless;
  for (const SceneFieldPtr& field : fields_) {
    endless.push_back(!field->extent());
    const HeightField* heights = height_field_of(*field);
    wraps_ = wraps_ || (heights && heights->wraps());
  }
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    endless_ = endless_ || endless[objects_[i].field];
    if (!field_of(i).is_backdrop()) continue;
    const std::optional<WorldBox> box = field_of(i).box();
    if (box && !box->empty()) walls_end_ = world_box(objects_[i].placement, *box).low.z;
  }
  alone_ = objects_.size() == 1 && in_place_[0];
  find_sole();
  find_terrain();
}

void Scene::find_sole() {
  int others = 0;
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    if (field_of(i).is_backdrop()) continue;
    sole_object_ = i;
    ++others;
  }
  sole_ = others == 1 && in_place_[sole_object_];
}

void Scene::find_terrain() {
  int found = 0;
  terrain_ = nullptr;
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const HeightField* field = height_field_of(field_of(i));
    if (!field || !objects_[i].placement.identity()) continue;
    terrain_ = field;
    terrain_object_ = i;
    ++found;
  }
  if (found != 1) terrain_ = nullptr;
}

Scene::Scene(SceneFieldPtr field) : Scene(std::vector{std::move(field)}, {SceneObject{}}) {}

void Scene::take_hit(const Hit& hit, std::uint32_t object, Hit& best) const {
  if (hit && hit.wall && hit.height < walls_end_) return;
  take(hit, object, best);
}

void Scene::trace(const StartedRay& ray, std::uint32_t object, Hit& best, MarchStats* stats) const {
  if (!sees(ray.rules, objects_[object])) return;
  MarchStats march;
  const Ray own = local(ray, object, best);
  MarchStats* cost = stats ? &march : nullptr;
  take_hit(about_hits(ray.rules) ? accepted_hit(ray, object, own, cost)
                                 : field_of(object).closest_hit(own, ray.from_on(object), cost),
           object, best);
  if (!stats) return;
  stats->steps += march.steps, stats->level_changes += march.level_changes;
  stats->cell_tests += march.cell_tests, stats->boxes += march.boxes;
}

void Scene::trace_tree(const StartedRay& ray, Hit& best, MarchStats* stats) const {
  Ray reach = ray.ray;
  if (best) reach.t_max = best.t;
  tree_.traverse(reach, [&](std::uint32_t object) {
    trace(ray, object, best, stats);
    if (stats) ++stats->boxes;
    return best ? best.t : ray.ray.t_max;
  });
}

Hit Scene::closest(const StartedRay& ray, MarchStats* stats) const {
  Hit best;
  if (stats) *stats = {};
  if (!is_followable(ray.ray)) return best;
  if (is_too_long(ray.ray)) {
    const Ray shorter = scaled_down(ray.ray, kShorter);
    best = closest(ray.with(shorter), stats);
    best.t = std::ldexp(best.t, -kShorter);
    return best;
  }
  for (const std::uint32_t object : beside_tree_) trace(ray, object, best, stats);
  trace_tree(ray, best, stats);
  return best;
}

Hit Scene::closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const {
  require_current();
  if (back_end_) {
    Hit hit;
    std::uint32_t steps = 0;
    closest_by_back_end({&ray, 1}, {&hit, 1}, stats ? std::span(&steps, 1) : std::span<std::uint32_t>(),
                        from ? From(&from, 1) : From());
    if (stats) *stats = {.steps = steps};
    return hit;
  }
  if (alone_ && is_followable(ray)) return field_of(0).closest_hit(ray, from, stats);
  return closest({ray, from}, stats);
}

bool Scene::blocks(const StartedRay& ray, std::uint32_t object) const {
  if (field_of(object).is_backdrop() || !sees(ray.rules, objects_[object])) return false;
  const Ray own = local(ray, object, {});
  if (about_hits(ray.rules)) return static_cast<bool>(accepted_hit(ray, object, own, nullptr));
  return field_of(object).occluded(own, ray.from_on(object));
}

// `own` is the ray in the object's space.
Hit Scene::accepted_hit(const StartedRay& ray, std::uint32_t object, const Ray& own, MarchStats* stats) const {
  const SceneRules& rules = *ray.rules;
  const auto in_scene = [&](Hit hit) {
    // No hit of the scene: see take_hit().
    if (hit.wall && hit.height < walls_end_) return true;
    hit.object = object;
    return rules.accept(ray.ray, hit);
  };
  const HitFilter accept = std::ref(in_scene);  // allocates nothing
  // A free ray by `own`, as the march of the field expects it.
  return field_of(object).accepted_hit(own, ray.from_on(object), {rules.sides, rules.accept ? &accept : nullptr},
                                       stats);
}

bool Scene::tree_blocks(const StartedRay& ray) const {
  bool blocked = false;
  tree_.traverse(ray.ray, [&](std::uint32_t object) {
    blocked = blocks(ray, object);
    return blocked ? -std::numeric_limits<double>::infinity() : ray.ray.t_max;
  });
  return blocked;
}

bool Scene::occluded(const Ray& ray, const Hit* from) const {
  require_current();
  if (back_end_) {
    std::uint8_t blocked = 0;
    occluded_by_back_end({&ray, 1}, {&blocked, 1}, from ? From(&from, 1) : From());
    return blocked != 0;
  }
  return sole_ && is_followable(ray) ? field_of(sole_object_).occluded(ray, from) : any({ray, from});
}

bool Scene::any(const StartedRay& ray) const {
  if (!is_followable(ray.ray)) return false;
  if (is_too_long(ray.ray)) {
    const Ray shorter = scaled_down(ray.ray, kShorter);
    return any(ray.with(shorter));
  }
  return std::any_of(beside_tree_.begin(), beside_tree_.end(),
                     [&](std::uint32_t object) { return blocks(ray, object); }) ||
         tree_blocks(ray);
}

namespace {

// Queues need more rays than other code.
std::int64_t rays_per_piece(const Scene& scene, std::size_t rays) {
  const auto some = static_cast<std::int64_t>(rays / 8);
  return some > kRaysPerPiece && has_only_heights(scene) ? std::min(some, kRaysPerQueuedPiece) : kRaysPerPiece;
}

bool pays_to_queue(const Scene& scene, std::span<const Ray> rays, const SceneRules* rules) {
  return !rules && rays.size() >= kFewForQueues && has_only_heights(scene);
}

bool all_free(std::span<const Ray> rays, std::span<const Hit* const> from) {
  return from.empty() && std::all_of(rays.begin(), rays.end(), [](const Ray& r) { return r.start == RayStart::free; });
}

}  // namespace

void Scene::closest_of_piece(std::span<const Ray> rays, From from, std::span<Hit> hits, const SceneRules* rules,
                             std::span<const FanSight> sights) const {
  KeptVector<Ray> locals;
  KeptVector<const Hit*> on_object(from.size());
  KeptVector<Hit> answers(rays.size());
  std::fill(hits.begin(), hits.end(), Hit{});
  bool any_hit = false;
  std::optional<ObjectQueues> queues;
  if (sights.empty() && !tree_.empty() && pays_to_queue(*this, rays, rules)) queues.emplace(*this);
  for (const std::uint32_t object : beside_tree_) {
    if (!sees(rules, objects_[object]) || (queues && queues->bounded(object))) continue;
    // Without earlier hits, the ranges of free rays need no limit.
    std::span<const Ray> asked = rays;
    if (any_hit || !in_place_[object] || rooms_[object] != 0 || !all_free(rays, from)) {
      locals.resize(rays.size());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const StartedRay ray(rays, from, i);
        make_local(ray, object, hits[i], locals[i]);
        if (!from.empty()) on_object[i] = ray.from_on(object);
      }
      asked = locals;
    }
    if (!sights.empty() && object == terrain_object_) {
      closest_hits_max_mip_seen(*field_of(object).fan_target(), asked, sights, answers);
    } else {
      field_of(object).closest_hits(asked, answers, on_object);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      take_hit(answers[i], object, hits[i]);
      any_hit = any_hit || hits[i].status != HitStatus::miss;
    }
  }
  if (tree_.empty()) return;
  if (!queues) {
    for (std::size_t i = 0; i < rays.size(); ++i) trace_tree({rays, from, i, rules}, hits[i], nullptr);
    return;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray reach = rays[i];
    if (hits[i]) reach.t_max = hits[i].t;
    queues->add(static_cast<std::uint32_t>(i), reach, [&](const auto& visit) {
      for (const std::uint32_t object : beside_tree_)
        if (queues->bounded(object)) visit(object);
      tree_.traverse(reach, [&](std::uint32_t object) { return visit(object), reach.t_max; });
    });
  }
  queues->run([&](std::uint32_t object, const std::vector<ObjectQueues::Waiting>& waiting) {
    locals.clear(), on_object.clear();
    std::vector<std::uint32_t> asked;
    for (const auto& one : waiting) {
      const StartedRay ray(rays, from, one.ray);
      if (hits[one.ray] && one.enters > hits[one.ray].t) continue;
      asked.push_back(one.ray);
      locals.emplace_back();
      make_local(ray, object, hits[one.ray], locals.back());
      if (!from.empty()) on_object.push_back(ray.from_on(object));
    }
    if (asked.size() < kFewAtObject) {
      for (const std::uint32_t i : asked) trace({rays, from, i}, object, hits[i], nullptr);
    } else {
      answers.resize(asked.size());
      field_of(object).closest_hits(locals, answers, on_object);
      for (std::size_t j = 0; j < asked.size(); ++j) take_hit(answers[j], object, hits[asked[j]]);
    }
    for (const auto& one : waiting) queues->go_on(one);
  });
}

void Scene::occluded_of_piece(std::span<const Ray> rays, From from, std::span<std::uint8_t> blocked,
                              const SceneRules* rules) const {
  // The tree first: rays that are blocked there need not be traced over the ground.
  std::vector<std::size_t> open;
  std::vector<Ray> locals;
  std::vector<const Hit*> on_object;
  std::vector<std::uint8_t> answers;
  std::optional<ObjectQueues> queues;
  if (!tree_.empty() && pays_to_queue(*this, rays, rules)) queues.emplace(*this);
  if (!queues) {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = tree_blocks({rays, from, i, rules});
  } else {
    std::fill(blocked.begin(), blocked.end(), std::uint8_t{0});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      queues->add(static_cast<std::uint32_t>(i), rays[i], [&](const auto& visit) {
        for (const std::uint32_t object : beside_tree_)
          if (queues->bounded(object)) visit(object);
        tree_.traverse(rays[i], [&](std::uint32_t object) { return visit(object), rays[i].t_max; });
      });
    }
    queues->run([&](std::uint32_t object, const std::vector<ObjectQueues::Waiting>& waiting) {
      locals.clear(), on_object.clear();
      for (const auto& one : waiting) {
        const StartedRay ray(rays, from, one.ray);
        locals.push_back(local(ray, object, {}));
        if (!from.empty()) on_object.push_back(ray.from_on(object));
      }
      answers.resize(waiting.size());
      field_of(object).occluded(locals, answers, on_object);
      for (std::size_t j = 0; j < waiting.size(); ++j) {
        blocked[waiting[j].ray] = answers[j];
        if (!answers[j]) queues->go_on(waiting[j]);
      }
    });
  }
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!blocked[i]) open.push_back(i);
  for (const std::uint32_t object : beside_tree_) {
    if (field_of(object).is_backdrop() || !sees(rules, objects_[object])) continue;
    if (queues && queues->bounded(object)) continue;
    locals.clear(), on_object.clear();
    for (const std::size_t i : open) {
      const StartedRay ray(rays, from, i);
      locals.push_back(local(ray, object, {}));
      if (!from.empty()) on_object.push_back(ray.from_on(object));
    }
    answers.resize(open.size());
    field_of(object).occluded(locals, answers, on_object);
    std::size_t left = 0;
    for (std::size_t j = 0; j < open.size(); ++j) {
      blocked[open[j]] = answers[j];
      if (!answers[j]) open[left++] = open[j];
    }
    open.resize(left);
  }
}

void Scene::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                         From from) const {
  require_current();
  require_same_length(rays.size(), hits.size());
  if (!steps.empty()) require_same_length(rays.size(), steps.size());
  if (!from.empty()) require_same_length(rays.size(), from.size());
  if (back_end_) return closest_by_back_end(rays, hits, steps, from);
  if (alone_) return field_of(0).closest_hits_on_all_threads(rays, hits, steps, from);
  parallel_for(static_cast<std::int64_t>(rays.size()), rays_per_piece(*this, rays.size()),
               [&](std::int64_t begin, std::int64_t end) {
                 const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
                 if (steps.empty() && !any_odd(rays.subspan(first, count))) {
                   return closest_of_piece(rays.subspan(first, count), from.empty() ? from : from.subspan(first, count),
                                           hits.subspan(first, count));
                 }
                 for (std::size_t i = first; i < first + count; ++i) {
                   MarchStats stats;
                   hits[i] = closest({rays, from, i}, &stats);
                   if (!steps.empty()) steps[i] = stats.steps;
                 }
               });
}

std::optional<HeightTarget> Scene::fan_target() const {
  return back_end_ || !only_heights() ? std::nullopt : field_of(terrain_object_).fan_target();
}

void Scene::closest_hits(std::span<const Ray> rays, std::span<const FanSight> sights, std::span<Hit> hits) const {
  require_same_length(rays.size(), hits.size());
  require_same_length(rays.size(), sights.size());
  if (!fan_target() || any_odd(rays)) return closest_hits(rays, hits);
  require_current();
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    closest_of_piece(rays.subspan(first, count), {}, hits.subspan(first, count), nullptr, sights.subspan(first, count));
  });
}

void Scene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, From from) const {
  require_current();
  require_same_length(rays.size(), blocked.size());
  if (!from.empty()) require_same_length(rays.size(), from.size());
  if (back_end_) return occluded_by_back_end(rays, blocked, from);
  if (sole_) return field_of(sole_object_).occluded_on_all_threads(rays, blocked, from);
  parallel_for(static_cast<std::int64_t>(rays.size()), rays_per_piece(*this, rays.size()),
               [&](std::int64_t begin, std::int64_t end) {
                 const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
                 if (any_odd(rays.subspan(first, count))) {
                   for (std::size_t i = first; i < first + count; ++i) blocked[i] = any({rays, from, i});
                   return;
                 }
                 occluded_of_piece(rays.subspan(first, count), from.empty() ? from : from.subspan(first, count),
                                   blocked.subspan(first, count));
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
  surface.material = material_of(object, own.material);
  surface.place = in_field;
  surface.colour = own.colour;
  surface.openness = own.openness;
  surface.light = own.light;
  surface.wall = own.wall;
  if (own.height && object.placement.upright())
    surface.height = object.placement.world_from_field({in_field.x, in_field.y, *own.height}).z;
  return surface;
}

SceneSurface Scene::surface(const Ray& ray, const Hit& hit) const {
  const Ray local = objects_[hit.object].placement.field_from_world(ray);
  return placed_surface(hit.object, field_of(hit.object).surface(local, hit), ray.at(hit.t), local.at(hit.t));
}

std::uint32_t Scene::material(const Ray& ray, const Hit& hit) const {
  const SceneObject& object = objects_[hit.object];
  return material_of(object, field_of(hit.object).material(object.placement.field_from_world(ray), hit));
}

std::optional<SceneSurface> Scene::within(const dvec3& p) const {
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const dvec3 in_field = objects_[i].placement.field_from_world(p);
    if (const auto own = field_of(i).within(in_field)) return placed_surface(i, *own, p, in_field);
  }
  return {};
}

std::optional<double> Scene::height(double x, double y) const {
  std::optional<double> highest;
  for (const SceneObject& object : objects_) {
    if (!object.placement.upright()) continue;
    const dvec3 in_field = object.placement.field_from_world(dvec3(x, y, object.placement.origin.z));
    const std::optional<double> own = fields_[object.field]->height(in_field.x, in_field.y);
    if (!own) continue;
    const double z = object.placement.world_from_field({in_field.x, in_field.y, *own}).z;
    highest = highest ? std::max(*highest, z) : z;
  }
  return highest;
}

double Scene::cell_side() const {
  double least = 0;
  for (const SceneObject& object : objects_) {
    const double side = fields_[object.field]->cell_side() * object.placement.scale;
    if (side > 0) least = least > 0 ? std::min(least, side) : side;
  }
  return least;
}

Scene Scene::judge() const {
  std::vector<SceneFieldPtr> fields;
  for (const SceneFieldPtr& field : fields_) {
    SceneFieldPtr judge = field->judge();
    fields.push_back(judge ? std::move(judge) : field);
  }
  return Scene(std::move(fields), objects_);
}

std::string Scene::marches() const {
  std::set<std::string_view> names;
  for (const SceneObject& object : objects_) {
    if (!fields_[object.field]->is_backdrop()) names.insert(fields_[object.field]->march());
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Sampling Scene::sampling() const {
  std::optional<Sampling> common;
  for (const SceneObject& object : objects_) {
    const SceneField& field = *fields_[object.field];
    if (field.is_backdrop()) continue;
    if (common && *common != field.sampling()) return Sampling::none;
    common = field.sampling();
  }
  return common.value_or(Sampling::none);
}

std::vector<std::string> Scene::caveats() const {
  std::set<std::string> caveats;
  for (const SceneObject& object : objects_) caveats.insert(fields_[object.field]->caveat());
  caveats.erase("");
  return {caveats.begin(), caveats.end()};
}

Scene Scene::coarser(const SceneDetail& detail) const {
  std::vector<SceneFieldPtr> fields = fields_;
  std::vector<SceneObject> objects = objects_;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> known;  // by field and level
  for (SceneObject& object : objects) {
    const SceneField& field = *fields_[object.field];
    const std::optional<WorldBox> box = field.box();
    const double side = field.cell_side() * object.placement.scale;
    if (!(side > 0) || !box || box->empty()) continue;
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
         beside_tree_.size() * sizeof(std::uint32_t) + fields_.size() * sizeof(SceneFieldPtr);
}

void validate(const Ray& ray, const Scene& scene) {
  validate(ray);
  if (scene.wraps() && std::isinf(ray.t_max))
    throw Error("ray: its range has no end; over a field that wraps round t_max must be finite");
  if (ray.start != RayStart::on_surface) return;
  if (ray.start_object >= scene.objects().size()) {
    throw Error(fmt::format("ray: it starts on the surface of object {}, which does not exist (there are {})",
                            ray.start_object, scene.objects().size()));
  }
  if (const HeightField* heights = height_field_of(scene.field_of(ray.start_object))) validate(ray, *heights);
}

}  // namespace scarp
