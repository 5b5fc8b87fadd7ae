// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/voxel_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/matrix.hpp>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/march_trace.h"
#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/rounded_voxels.h"
#include "scarp/march/voxel/voxel_planes.h"
#include "scarp/scene/voxel/coarse_voxels.h"

namespace scarp {
namespace {

// Tolerance for orthogonal columns of equal length in a matrix, relative to their squares: permits many roundings of
// multiplied rotations, but no intentional shear.
constexpr double kRigid = 1e-9;

void require_rigid(const glm::dmat3& m, std::size_t place) {
  const double square = dot(m[0], m[0]);
  bool good = std::isfinite(square) && square > 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) good = good && std::abs(dot(m[i], m[j]) - (i == j ? square : 0)) <= kRigid * square;
  }
  if (!good) throw Error(fmt::format("voxels: object {}: its matrix must be a rotation times a scale above 0", place));
}

double largest(const dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

Hit hit_on(std::uint32_t part, const VoxelHit& found) {
  Hit hit;
  hit.status = HitStatus::hit, hit.face = found.face, hit.t = found.t;
  hit.voxel = found.voxel, hit.part = part;
  return hit;
}

// The march in one grid, recorded.
VoxelHit traced_in(const VoxelMarchEntry& march, const VoxelTarget& target, const QuantisedRay& ray,
                   std::uint32_t object, MarchStats& stats, MarchTrace& trace) {
  const std::size_t first = trace.steps.size();
  const VoxelHit hit = march.traced(target, ray, &stats, trace);
  for (std::size_t i = first; i < trace.steps.size(); ++i) trace.steps[i].object = object;
  return hit;
}

}  // namespace

VoxelObjects::Turn::Turn(const glm::dmat3& world_from_grid_)
    : grid_from_world(glm::inverse(world_from_grid_)),
      world_from_grid(world_from_grid_),
      per_metre(length(grid_from_world[0])) {
  VoxelTies frame;
  for (std::uint8_t& ties : ties_by_frame)
    ties = static_cast<std::uint8_t>(VoxelTies(grid_from_world, frame).bits), ++frame.bits;
}

VoxelObjects::VoxelObjects(PlacedVoxels voxels) : models_(std::move(voxels.models)), rounding_(voxels.rounding) {
  validate(rounding_);
  for (const auto& model : models_) {
    if (!model) throw Error(fmt::format("voxels: model {} is null", targets_.size()));
    targets_.push_back(model->target());
  }
  std::unordered_map<std::string, std::uint32_t> turns;
  std::vector<WorldBox> boxes;
  for (const VoxelPlace& place : voxels.places) {
    const std::size_t index = objects_.size();
    if (place.model >= models_.size())
      throw Error(fmt::format("voxels: object {}: its model {} does not exist (there are {})", index, place.model,
                              models_.size()));
    const dvec3& origin = place.origin;
    if (!std::isfinite(origin.x + origin.y + origin.z))
      throw Error(fmt::format("voxels: object {}: its place is not finite", index));
    require_rigid(place.world_from_grid, index);
    const std::string key(reinterpret_cast<const char*>(&place.world_from_grid), sizeof(place.world_from_grid));
    const auto [turn, fresh] = turns.try_emplace(key, static_cast<std::uint32_t>(turns_.size()));
    if (fresh) turns_.emplace_back(place.world_from_grid);
    objects_.push_back({origin, place.model, turn->second});
    const VoxelBox& box = models_[place.model]->box();
    if (box.empty()) continue;
    in_tree_.push_back(static_cast<std::uint32_t>(index));
    boxes.push_back(world_box(place, box));
  }
  objects_.shrink_to_fit();
  in_tree_.shrink_to_fit();
  // Where objects meet, no coordinate of a ray, a placement or a corner is larger than `farthest_`. Their difference,
  // the three products of a row and the sums have less than 8 units of rounding. The elements of the inverse, and
  // placements that readers make, are products and add as much again: 2^-49. Twice that covers both sides of a plane.
  // Scenes that place the field set Ray::room of its rays to cover all roundings.
  for (const WorldBox& box : boxes) box_ = around(box_, box);
  if (!boxes.empty()) {
    farthest_ = std::max(largest(box_.low), largest(box_.high));
    for (const Object& object : objects_) farthest_ = std::max(farthest_, largest(object.origin));
  }
  for (Turn& turn : turns_) turn.room = std::ldexp(farthest_, -48) * turn.per_metre;
  // Rays may hit voxels at the edges of a box that they miss by less than this (quantise()).
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Turn& turn = turns_[objects_[in_tree_[i]].turn];
    const double margin =
        2 * length(turn.world_from_grid[0]) * (turn.room + kTouch / static_cast<double>(kVoxelPlaces));
    boxes[i] = {boxes[i].low - margin, boxes[i].high + margin};
  }
  tree_ = BoxTree(boxes);
}

// A world ray that is traced through the objects. Values shared by neighbouring objects are computed once.
struct VoxelObjects::Query {
  const VoxelObjects& scene;
  const Ray& ray;
  std::uint32_t turn;
  VoxelDirection direction;

  Query(const VoxelObjects& in, const Ray& world_ray)
      : scene(in),
        ray(world_ray),
        turn(in.objects_[in.in_tree_[0]].turn),
        direction(in.turns_[turn].grid_from_world * world_ray.direction, in.turns_[turn].ties(world_ray)) {}

  VoxelRay in_grid(std::uint32_t index, double t_max) {
    const Object& object = scene.objects_[index];
    const Turn& to = scene.turns_[object.turn];
    if (object.turn != turn) {
      turn = object.turn;
      direction = VoxelDirection(to.grid_from_world * ray.direction, to.ties(ray));
    }
    return {to.grid_from_world * (ray.origin - object.origin), direction.given, ray.t_min, t_max, {}, to.room_of(ray)};
  }
  // Returns false for a ray that misses the object's box.
  bool quantise_at(std::uint32_t index, double t_max, const Hit* from, QuantisedRay& quantised) {
    VoxelRay local = in_grid(index, t_max);
    if (from && from->part == index) local.start_voxel = from->voxel + normal_of(from->face);
    return quantise(local, direction, scene.targets_[scene.objects_[index].model].box, quantised);
  }
  VoxelHit rounded(std::uint32_t index, double t_max, const Hit* from, MarchStats* stats,
                   const VoxelFilter* accept = nullptr) {
    const std::uint32_t model = scene.objects_[index].model;
    const VoxelRay local = in_grid(index, t_max);
    return first_rounded_voxel(scene.targets_[model], scene.models_[model]->march().cpu, local, direction,
                               scene.rounding_, from && from->part == index ? &from->voxel : nullptr, stats, accept);
  }
};

// A ray that points into the rounded voxel on which it starts hits it immediately, as with cubes: the walk starts in a
// neighbour and would not detect this.
bool VoxelObjects::begins_into(const Ray& ray, const Hit* from) const {
  return rounding_ && from && ray.t_min <= ray.t_max && dot(normal(ray.at(ray.t_min), *from), ray.direction) < 0;
}

Hit VoxelObjects::follow(const Ray& ray, const Hit* from, const HitFilter* accept, MarchStats* stats,
                         MarchTrace* trace) const {
  if (stats) *stats = {};
  Hit best;
  if (in_tree_.empty()) return best;
  if (const double longest = longest_of(ray.direction); !is_usual(longest)) {
    if (!is_direction(longest)) return best;
    const int exponent = std::ilogb(longest);
    const HitFilter usual = [&](Hit hit) {
      hit.t = std::ldexp(hit.t, -exponent);
      return (*accept)(hit);
    };
    best = follow(scaled_down(ray, exponent), from, accept ? &usual : nullptr, stats, trace);
    if (trace) trace->scale_times(exponent);
    if (best) best.t = std::ldexp(best.t, -exponent);
    return best;
  }
  Query query(*this, ray);
  double t_max = ray.t_max;
  if (begins_into(ray, from)) {
    best = *from;
    best.object = 0;
    best.t = t_max = ray.t_min;
    if (accept && !(*accept)(best)) best = {}, t_max = ray.t_max;
  }
  // Tested even if a hit is known: at the same t the first object counts.
  tree_.traverse(ray, [&](std::uint32_t in_tree) {
    const std::uint32_t index = in_tree_[in_tree];
    const Object& object = objects_[index];
    MarchStats steps;
    VoxelHit hit;
    const VoxelFilter counts = [&](const VoxelHit& one) { return (*accept)(hit_on(index, one)); };
    if (rounding_) {
      hit = query.rounded(index, t_max, from, stats ? &steps : nullptr, accept ? &counts : nullptr);
    } else {
      QuantisedRay quantised;
      if (!query.quantise_at(index, t_max, from, quantised)) return t_max;
      const VoxelTarget& target = targets_[object.model];
      const VoxelMarchEntry& march = models_[object.model]->march();
      hit = trace ? traced_in(march, target, quantised, index, steps, *trace)
                  : march.cpu(target, quantised, stats ? &steps : nullptr);
      if (accept && hit && !counts(hit)) hit = march_voxel_planes_accepted(target, quantised, counts, &steps);
    }
    if (stats) {
      ++stats->boxes;
      stats->steps += steps.steps;
    }
    if (hit && (!best || hit.t < best.t || index < best.part)) {
      best = hit_on(index, hit);
      t_max = hit.t;
    }
    return t_max;
  });
  return best;
}

Hit VoxelObjects::traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const {
  trace.steps.clear();
  return follow(ray, nullptr, nullptr, stats, &trace);
}

bool VoxelObjects::records() const {
  return std::all_of(models_.begin(), models_.end(), [](const auto& model) { return model->march().traced; });
}

bool VoxelObjects::occluded(const Ray& ray, const Hit* from) const {
  if (in_tree_.empty()) return false;
  if (const double longest = longest_of(ray.direction); !is_usual(longest))
    return is_direction(longest) && occluded(scaled_down(ray, std::ilogb(longest)), from);
  if (begins_into(ray, from)) return true;
  Query query(*this, ray);
  bool blocked = false;
  tree_.traverse(ray, [&](std::uint32_t in_tree) {
    const std::uint32_t index = in_tree_[in_tree];
    const Object& object = objects_[index];
    if (rounding_) {
      blocked = static_cast<bool>(query.rounded(index, ray.t_max, from, nullptr));
    } else if (QuantisedRay quantised; query.quantise_at(index, ray.t_max, from, quantised)) {
      blocked = models_[object.model]->march().occluded(targets_[object.model], quantised);
    }
    return blocked ? -std::numeric_limits<double>::infinity() : ray.t_max;
  });
  return blocked;
}

dvec3 VoxelObjects::normal(const dvec3& p, const Hit& hit) const {
  if (hit.face == VoxelFace::inside) return dvec3(0.0);
  if (!rounding_) return world_from_grid(hit, dvec3(normal_of(hit.face)));
  return world_from_grid(hit, rounded_normal(grid(hit), hit.voxel, hit.face, place_in_grid(hit, p), rounding_));
}

dvec3 VoxelObjects::place_in_grid(const Hit& hit, const dvec3& p) const {
  const Object& object = objects_[hit.part];
  return turns_[object.turn].grid_from_world * (p - object.origin);
}

double VoxelObjects::voxel_side(const Hit& hit) const {
  return length(turns_[objects_[hit.part].turn].world_from_grid[0]);
}

dvec3 VoxelObjects::world_from_grid(const Hit& hit, const dvec3& direction) const {
  return normalize(turns_[objects_[hit.part].turn].world_from_grid * direction);
}

std::optional<VoxelColour> VoxelObjects::colour_at(const dvec3& p) const {
  for (const Object& object : objects_) {
    const dvec3 at = floor(turns_[object.turn].grid_from_world * (p - object.origin));
    const VoxelModel& model = *models_[object.model];
    const dvec3 size(model.grid().size());
    // Compared as doubles: too far away for integers.
    if (!(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z)) continue;
    if (model.grid().solid(ivec3(at))) return model.colour(model.grid().entry(ivec3(at)));
  }
  return {};
}

double VoxelObjects::voxel_side() const {
  double least = 0;
  for (const Turn& turn : turns_) {
    const double side = length(turn.world_from_grid[0]);
    least = least > 0 ? std::min(least, side) : side;
  }
  return least;
}

VoxelObjects VoxelObjects::coarser(int level) const {
  PlacedVoxels coarse{.rounding = rounding_};
  for (const auto& model : models_) coarse.models.push_back(coarse_voxels(model, level));
  for (const Object& object : objects_)
    coarse.places.push_back({object.model, std::ldexp(1, level) * turns_[object.turn].world_from_grid, object.origin});
  return VoxelObjects(std::move(coarse));
}

VoxelObjects VoxelObjects::marched_by(std::string_view march) const {
  const VoxelMarchEntry& entry = find_voxel_march(march);
  PlacedVoxels placed{.rounding = rounding_};
  for (const auto& model : models_)
    placed.models.push_back(std::make_shared<const VoxelModel>(model->marched_by(entry)));
  placed.places = places();
  return VoxelObjects(std::move(placed));
}

std::vector<VoxelObjects::Placed> VoxelObjects::placed() const {
  std::vector<Placed> placed;
  for (const std::uint32_t index : in_tree_)
    placed.push_back({objects_[index].origin, objects_[index].model, objects_[index].turn, index});
  return placed;
}

std::vector<VoxelObjects::PlacedTurn> VoxelObjects::turns() const {
  std::vector<PlacedTurn> turns;
  for (const Turn& turn : turns_)
    turns.push_back({turn.grid_from_world, turn.ties_by_frame, turn.room, turn.per_metre});
  return turns;
}

std::vector<VoxelPlace> VoxelObjects::places() const {
  std::vector<VoxelPlace> places;
  for (const Object& object : objects_)
    places.push_back({object.model, turns_[object.turn].world_from_grid, object.origin});
  return places;
}

VoxelObjects VoxelObjects::rebuilt() const {
  return VoxelObjects({.models = models_, .places = places(), .rounding = rounding_});
}

std::uint64_t VoxelObjects::edits() const {
  std::uint64_t edits = 0;
  for (const auto& model : models_) edits += model->edits();
  return edits;
}

VoxelColour VoxelObjects::colour(const Hit& hit) const {
  const VoxelModel& model = *models_[objects_[hit.part].model];
  return model.colour(model.grid().entry(hit.voxel));
}

VoxelMaterial VoxelObjects::material(const Hit& hit) const {
  const VoxelModel& model = *models_[objects_[hit.part].model];
  return model.material(model.grid().entry(hit.voxel));
}

bool VoxelObjects::mirrors() const {
  return std::any_of(models_.begin(), models_.end(), [](const auto& model) { return model->mirrors(); });
}

std::size_t VoxelObjects::bytes() const {
  return sizeof(*this) - sizeof(tree_) + objects_.size() * sizeof(Object) + turns_.size() * sizeof(Turn) +
         in_tree_.size() * sizeof(std::uint32_t) + targets_.size() * sizeof(VoxelTarget) + tree_.bytes();
}

}  // namespace scarp
