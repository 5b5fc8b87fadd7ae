// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_exhaustive.h"

#include <compare>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace scarp {
namespace {

// distance * speed, for any distance and 0 <= speed < 2^31, as high * 2^32 + low: not all compilers have 128 bits.
struct Product {
  std::int64_t high, low;

  Product(std::int64_t distance, std::int64_t speed) {
    const std::int64_t lower = (distance & 0xffff'ffff) * speed;
    high = (distance >> 32) * speed + (lower >> 32);
    low = lower & 0xffff'ffff;
  }
  friend auto operator<=>(const Product&, const Product&) = default;
};

// The crossing of a plane: distance / speed, then the rank of the axis.
struct Event {
  std::int64_t distance, speed;
  int axis, rank;

  friend bool operator<(const Event& a, const Event& b) {
    const Product left(a.distance, b.speed), right(b.distance, a.speed);
    return left != right ? left < right : a.rank < b.rank;
  }
};

// Entry into and exit from the voxels left by some axes. No event: inside from the start, or forever.
struct Visit {
  std::optional<Event> in, out;
};

// Restricts the visit to the voxels at that position along the axis; returns false if nothing is left.
bool cut(Visit& visit, const QuantisedRay& ray, int axis, int place) {
  const std::int64_t planes = std::int64_t{place - ray.voxel[axis]} * ray.direction.step[axis];
  const std::int64_t speed = ray.direction.speed[axis], first = ray.to_plane[axis], side = 1 << 20;
  const int rank = ray.direction.ties.rank(axis);
  if (planes < 0 || (planes > 0 && speed == 0)) return false;
  if (planes > 0) {
    const Event in{first + (planes - 1) * side, speed, axis, rank};
    if (!visit.in || *visit.in < in) visit.in = in;
  }
  if (speed > 0) {
    const Event out{first + planes * side, speed, axis, rank};
    if (!visit.out || out < *visit.out) visit.out = out;
  }
  return !visit.in || !visit.out || *visit.in < *visit.out;
}

}  // namespace

VoxelHit march_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  std::optional<Visit> first;
  ivec3 voxel(-1);
  std::uint32_t looked_at = 0;
  for (int z = target.box.low.z; z < target.box.high.z; ++z) {
    Visit layer;
    if (!cut(layer, ray, 2, z)) continue;
    for (int y = target.box.low.y; y < target.box.high.y; ++y) {
      Visit row = layer;
      if (!cut(row, ray, 1, y)) continue;
      for (int x = target.box.low.x; x < target.box.high.x; ++x) {
        if (!target.grid->solid({x, y, z})) continue;
        ++looked_at;
        Visit here = row;
        if (!cut(here, ray, 0, x)) continue;
        if (first && !(here.in && first->in ? *here.in < *first->in : !here.in)) continue;
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
