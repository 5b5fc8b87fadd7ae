// SPDX-License-Identifier: MIT
#include "scarp/march/voxel_exhaustive.h"

#include <cstdlib>
#include <optional>

namespace scarp {
namespace {

__extension__ using Wide = __int128;

// The crossing of a plane: distance / speed, then the axis.
struct Event {
  std::int64_t distance, speed;
  int axis;

  friend bool operator<(const Event& a, const Event& b) {
    const Wide left = Wide{a.distance} * b.speed, right = Wide{b.distance} * a.speed;
    return left != right ? left < right : a.axis < b.axis;
  }
};

// What keeps the ray in and out of a voxel along one axis. No event: it is there from the beginning, or for good.
struct Passage {
  std::optional<Event> in, out;
};

std::optional<Passage> passage(const QuantisedRay& ray, const ivec3& voxel, int axis) {
  const std::int64_t planes = std::int64_t{voxel[axis] - ray.voxel[axis]} * ray.direction.step[axis];
  const std::int64_t speed = ray.direction.speed[axis], first = ray.to_plane[axis], side = 1 << 20;
  if (planes < 0 || (planes > 0 && speed == 0)) return {};
  Passage passage;
  if (planes > 0) passage.in = Event{first + (planes - 1) * side, speed, axis};
  if (speed > 0) passage.out = Event{first + planes * side, speed, axis};
  return passage;
}

struct Visit {
  std::optional<Event> in;  // none: the first voxel
};

std::optional<Visit> visit(const QuantisedRay& ray, const ivec3& voxel) {
  Visit visit;
  std::optional<Event> out;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<Passage> along = passage(ray, voxel, axis);
    if (!along) return {};
    if (along->in && (!visit.in || *visit.in < *along->in)) visit.in = along->in;
    if (along->out && (!out || *along->out < *out)) out = along->out;
    if (visit.in && out && !(*visit.in < *out)) return {};
  }
  return visit;
}

}  // namespace

VoxelHit march_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  std::optional<Visit> first;
  ivec3 voxel(-1);
  std::uint32_t looked_at = 0;
  for (int z = target.box.low.z; z < target.box.high.z; ++z) {
    for (int y = target.box.low.y; y < target.box.high.y; ++y) {
      for (int x = target.box.low.x; x < target.box.high.x; ++x) {
        if (!target.grid->solid({x, y, z})) continue;
        ++looked_at;
        const std::optional<Visit> here = visit(ray, {x, y, z});
        if (!here || (first && !(here->in && first->in ? *here->in < *first->in : !here->in))) continue;
        first = here;
        voxel = {x, y, z};
      }
    }
  }
  if (stats) *stats = {looked_at, 0, looked_at};
  VoxelHit hit;
  if (!first) return hit;
  hit.t = ray.t;
  hit.face = ray.face;
  if (first->in) {
    const int axis = first->in->axis;
    hit.t = ray.t_at(axis, first->in->distance);
    hit.face = static_cast<VoxelFace>(2 * axis + (ray.direction.step[axis] < 0 ? 1 : 0));
  }
  if (!(hit.t <= ray.t_max)) return {};
  hit.status = HitStatus::hit;
  hit.voxel = voxel;
  hit.entry = target.grid->entry(voxel);
  return hit;
}

}  // namespace scarp
