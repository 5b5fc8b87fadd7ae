// SPDX-License-Identifier: MIT
// Contacts of voxel objects: one model after the other, each in its grid's space.
#include <algorithm>

#include "scarp/march/voxel/voxel_contact.h"
#include "scarp/scene/voxel_objects.h"

namespace scarp {

WorldBox VoxelObjects::box_of(const Object& object) const {
  return world_box(VoxelPlace{object.model, turns_[object.turn].world_from_grid, object.origin},
                   models_[object.model]->box());
}

std::optional<FieldContact> VoxelObjects::sweep(const Capsule& capsule, const dvec3& motion) const {
  std::optional<FieldContact> best;
  for (const std::uint32_t index : in_tree_) {
    const Object& object = objects_[index];
    const WorldBox box = box_of(object);
    const double last = best ? best->t : 1;
    if (sweep_bound(capsule, motion, box.low, box.high, last) > last) continue;
    const Turn& turn = turns_[object.turn];
    const auto to_grid = [&](const dvec3& p) { return turn.grid_from_world * (p - object.origin); };
    const Capsule own{to_grid(capsule.a), to_grid(capsule.b), capsule.radius / length(turn.world_from_grid[0])};
    const auto found = scarp::sweep(models_[object.model]->grid(), own, turn.grid_from_world * motion);
    if (!found || (best && found->t >= best->t)) continue;
    best = FieldContact{*found, {.voxel = found->voxel, .part = index}};
    best->point = turn.world_from_grid * found->point + object.origin;
    if (found->normal != dvec3(0.0)) best->normal = normalize(turn.world_from_grid * found->normal);
  }
  return best;
}

bool VoxelObjects::overlaps(const TurnedBox& box) const {
  return std::any_of(in_tree_.begin(), in_tree_.end(), [&](std::uint32_t index) {
    const Object& object = objects_[index];
    const WorldBox around = box_of(object);
    if (!scarp::overlaps(box, around.low, around.high)) return false;
    const Turn& turn = turns_[object.turn];
    TurnedBox own = box;
    own.centre = turn.grid_from_world * (box.centre - object.origin);
    own.turn = turn.grid_from_world * box.turn;  // with the scale
    return scarp::overlaps(models_[object.model]->grid(), own);
  });
}

std::optional<FieldPoint> VoxelObjects::closest_point(const dvec3& p, double max_distance) const {
  std::optional<FieldPoint> best;
  for (const std::uint32_t index : in_tree_) {
    const Object& object = objects_[index];
    const WorldBox box = box_of(object);
    const double most = best ? best->distance : max_distance;
    if (length(min(max(p, box.low), box.high) - p) > most) continue;
    const Turn& turn = turns_[object.turn];
    const double side = length(turn.world_from_grid[0]);
    const auto found =
        scarp::closest_point(models_[object.model]->grid(), turn.grid_from_world * (p - object.origin), most / side);
    if (!found || (best && found->distance * side >= best->distance)) continue;
    best = FieldPoint{turn.world_from_grid * found->point + object.origin,
                      dvec3(0.0),
                      found->distance * side,
                      {.voxel = found->voxel, .part = index}};
    if (found->normal != dvec3(0.0)) best->normal = normalize(turn.world_from_grid * found->normal);
  }
  return best;
}

}  // namespace scarp
