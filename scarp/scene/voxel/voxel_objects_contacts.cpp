// SPDX-License-Identifier: MIT
// Contacts of voxel objects: the hierarchy finds the objects, and each is tested in the space of its grid.
#include "scarp/march/voxel/voxel_contact.h"
#include "scarp/scene/tree/contact_search.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {

std::optional<FieldContact> VoxelObjects::sweep(const Capsule& capsule, const dvec3& motion) const {
  std::optional<FieldContact> best;
  const auto last = [&] { return best ? best->t : 1; };
  const auto bound = [&](const WorldBox& box) { return sweep_bound(capsule, motion, box.low, box.high, last()); };
  tree_.search(1, bound, [&](std::uint32_t in_tree) {
    const std::uint32_t index = in_tree_[in_tree];
    const Object& object = objects_[index];
    const Turn& turn = turns_[object.turn];
    const auto to_grid = [&](const dvec3& p) { return turn.grid_from_world * (p - object.origin); };
    const Capsule own{to_grid(capsule.a), to_grid(capsule.b), capsule.radius / length(turn.world_from_grid[0])};
    const auto found = scarp::sweep(models_[object.model]->grid(), own, turn.grid_from_world * motion);
    if (!found || (best && !is_before(found->t, index, best->t, best->place.part))) return last();
    best = FieldContact{*found, {.voxel = found->voxel, .part = index}};
    best->point = turn.world_from_grid * found->point + object.origin;
    best->depth = found->depth * length(turn.world_from_grid[0]);
    if (found->normal != dvec3(0.0)) best->normal = normalize(turn.world_from_grid * found->normal);
    return last();
  });
  return best;
}

bool VoxelObjects::overlaps(const TurnedBox& box) const {
  bool found = false;
  tree_.search(
      0, [&](const WorldBox& other) { return overlap_bound(box, other); },
      [&](std::uint32_t in_tree) {
        const Object& object = objects_[in_tree_[in_tree]];
        const Turn& turn = turns_[object.turn];
        TurnedBox own = box;
        own.centre = turn.grid_from_world * (box.centre - object.origin);
        own.turn = turn.grid_from_world * box.turn;  // includes the scale
        found = scarp::overlaps(models_[object.model]->grid(), own);
        return found ? -1.0 : 0.0;
      });
  return found;
}

std::optional<FieldPoint> VoxelObjects::closest_point(const dvec3& p, double max_distance) const {
  std::optional<FieldPoint> best;
  const auto distance = [&] { return best ? std::optional(best->distance) : std::nullopt; };
  const auto bound = [&](const WorldBox& box) { return distance_bound(p, box); };
  tree_.search(reach_of(p, max_distance), bound, [&](std::uint32_t in_tree) {
    const std::uint32_t index = in_tree_[in_tree];
    const Object& object = objects_[index];
    const Turn& turn = turns_[object.turn];
    const double side = length(turn.world_from_grid[0]);
    const auto found = closest_of_object(p, max_distance, distance(), [&](double most) {
      return scarp::closest_point(models_[object.model]->grid(), turn.grid_from_world * (p - object.origin),
                                  most / side);
    });
    if (found && (!best || is_before(found->distance * side, index, best->distance, best->place.part))) {
      best = FieldPoint{turn.world_from_grid * found->point + object.origin,
                        dvec3(0.0),
                        found->distance * side,
                        {.voxel = found->voxel, .part = index}};
      if (found->normal != dvec3(0.0)) best->normal = normalize(turn.world_from_grid * found->normal);
    }
    return reach_of(p, distance().value_or(max_distance));
  });
  return best;
}

}  // namespace scarp
