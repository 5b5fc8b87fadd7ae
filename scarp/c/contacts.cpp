// SPDX-License-Identifier: MIT
#include "scarp/c/scene_handle.h"
#include "scarp/scene/scene_query.h"

namespace scarp::c {
namespace {

scarp_contact contact_at(const dvec3& point, const dvec3& normal, const FieldPlace& place, std::uint32_t object) {
  scarp_contact contact{};
  for (int axis = 0; axis < 3; ++axis) {
    contact.point[axis] = point[axis];
    contact.normal[axis] = normal[axis];
    contact.voxel[axis] = place.voxel[axis];
  }
  contact.object = object;
  contact.part = place.part;
  contact.col = place.cell.col;
  contact.row = place.cell.row;
  contact.found = 1;
  return contact;
}

SceneQuery query_of(const scarp_scene* scene, std::uint32_t mask) { return {scene_of(scene), {.mask = mask}}; }

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_sweep(const scarp_scene* scene, const double a[3], const double b[3], double radius,
                         const double motion[3], uint32_t mask, scarp_contact* contact) {
  return guarded([&] {
    const scarp::SceneQuery query = query_of(scene, mask);
    required(contact, "contact");
    const auto found = query.sweep({vector_from(a, "a"), vector_from(b, "b"), radius}, vector_from(motion, "motion"));
    *contact = found ? contact_at(found->point, found->normal, found->place, found->object) : scarp_contact{};
    if (found) contact->t = found->t, contact->distance = -found->depth;
  });
}

scarp_status scarp_overlaps(const scarp_scene* scene, const double centre[3], const double half[3],
                            const double turn[9], uint32_t mask, uint8_t* overlaps) {
  return guarded([&] {
    const scarp::SceneQuery query = query_of(scene, mask);
    required(overlaps, "overlaps");
    scarp::TurnedBox box{vector_from(centre, "centre"), vector_from(half, "half")};
    if (turn) box.turn = turn_from(turn);
    *overlaps = query.overlaps(box);
  });
}

scarp_status scarp_closest_point(const scarp_scene* scene, const double point[3], double max_distance, uint32_t mask,
                                 scarp_contact* contact) {
  return guarded([&] {
    const scarp::SceneQuery query = query_of(scene, mask);
    required(contact, "contact");
    const auto found = query.closest_point(vector_from(point, "point"), max_distance);
    *contact = found ? contact_at(found->point, found->normal, found->place, found->object) : scarp_contact{};
    if (found) contact->distance = found->distance;
  });
}
