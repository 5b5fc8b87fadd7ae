// SPDX-License-Identifier: MIT
// The path of a quantised ray from voxel to voxel, or over many at once, in integers: shared by the voxel marches.
//
//   along each axis the ray crosses planes at the distances  next, next + 2^20, next + 2 * 2^20, ...
//   which correspond to                                      s = distance / speed
//
// All planes of all axes, in the order of s and then of the axis (VoxelTies), are the ray's events. A position is a
// number of past events, and determines the voxel. A skip finds the first event that leaves a box, and counts the
// events of the other axes before it. The position after a skip thus equals that of single steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

class VoxelWalk {
 public:
  explicit VoxelWalk(const QuantisedRay& ray, const VoxelBox& box)
      : ray_(ray),
        speed_(ray.direction.speed),
        step_(ray.direction.step),
        ties_(ray.direction.ties),
        next_(ray.to_plane),
        voxel_(ray.voxel),
        box_(box) {}

  const ivec3& voxel() const { return voxel_; }

  /// Crosses the next plane. Returns false if that leaves the box.
  bool step() {
    cross(first(next_));
    return in_box();
  }

  /// Crosses planes until one of them leaves `part`, a box around the voxel. Returns false if that leaves the box of
  /// the walk; `part` may extend beyond it.
  bool leave(const VoxelBox& part) {
    std::array<std::int64_t, 3> out;
    for (int i = 0; i < 3; ++i) {
      const int planes = step_[i] > 0 ? std::min(part.high[i], box_.high[i]) - voxel_[i]
                                      : voxel_[i] - std::max(part.low[i], box_.low[i]) + 1;
      out[i] = next_[i] + (std::int64_t{planes} - 1) * kVoxelPlaces;
    }
    const int axis = first(out);
    const std::int64_t distance = out[axis], speed = speed_[axis];
    const double slowness = ray_.direction.slowness[axis];
    const std::int64_t after = ray_.direction.after[axis];
    // For each axis, all planes with next + k 2^20 over its speed no later than distance over speed; those at the same
    // s that come after the last one are not crossed.
    for (int i = 0; i < 3; ++i) {
      const std::int64_t ahead = distance * speed_[i] - next_[i] * speed - (after >> i & 1);
      const std::int64_t planes = quotient(ahead >> kPlaceBits, speed, slowness) + 1;
      advance(i, ahead < 0 ? 0 : planes);
    }
    axis_ = axis;
    return in_box();
  }

  /// Crosses the next plane, then all planes within `voxels` further travel. Returns false if that leaves the box.
  bool step_and_travel(std::int64_t voxels, std::int64_t travel_per_voxel) {
    const int axis = first(next_);
    const std::int64_t distance = next_[axis];
    cross(axis);
    if (!in_box()) return false;
    if (voxels == 0) return true;
    // s in 2^-28, rounded down.
    const std::int64_t from = (distance << kDirectionBits) / speed_[axis];
    const std::int64_t until = from + voxels * travel_per_voxel;
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
      if (speed_[i] == 0) continue;
      const std::int64_t ahead = until * speed_[i] - (next_[i] << kDirectionBits) - 1;
      if (ahead < 0) continue;
      advance(i, (ahead >> (kDirectionBits + kPlaceBits)) + 1);
      inside = inside && voxel_[i] >= box_.low[i] && voxel_[i] < box_.high[i];
    }
    return inside;
  }

  /// Returns the hit in the current voxel.
  VoxelHit hit(const VoxelGrid& grid) const {
    VoxelHit hit;
    hit.t = t();
    if (hit.t > ray_.t_max) return hit = {};
    hit.status = HitStatus::hit;
    hit.face = axis_ < 0 ? ray_.face : static_cast<VoxelFace>(2 * axis_ + (step_[axis_] < 0 ? 1 : 0));
    hit.voxel = voxel_;
    hit.entry = grid.entry(voxel_);
    return hit;
  }
  bool in_range() const { return t() <= ray_.t_max; }
  /// Time at which the ray enters the current voxel.
  double t() const { return axis_ < 0 ? ray_.t : ray_.t_at(axis_, next_[axis_] - kVoxelPlaces); }

 private:
  // Axis of the smallest distance. If speed is 0 the distance is not, and comes last.
  int first(const std::array<std::int64_t, 3>& distance) const {
    const bool y_first = distance[1] * speed_[0] < distance[0] * speed_[1] + (ties_.bits >> 3 & 1);
    const int axis = y_first ? 1 : 0;
    return distance[2] * speed_[axis] < distance[axis] * speed_[2] + (ties_.bits >> (axis + 4) & 1) ? 2 : axis;
  }
  void advance(int axis, std::int64_t planes) {
    next_[axis] += planes * kVoxelPlaces;
    voxel_[axis] += step_[axis] * static_cast<int>(planes);
  }
  void cross(int axis) {
    advance(axis, 1);
    axis_ = axis;
  }
  bool in_box() const { return voxel_[axis_] >= box_.low[axis_] && voxel_[axis_] < box_.high[axis_]; }

  // a / speed, rounded down, for 0 <= a < 2^53: by a product, corrected.
  static std::int64_t quotient(std::int64_t a, std::int64_t speed, double slowness) {
    const auto q = static_cast<std::int64_t>(static_cast<double>(a) * slowness);
    const std::int64_t rest = a - q * speed;
    return q - (rest < 0 ? 1 : 0) + (rest >= speed ? 1 : 0);
  }

  const QuantisedRay& ray_;
  const std::array<std::int64_t, 3> speed_;
  const std::array<int, 3> step_;
  const VoxelTies ties_;
  std::array<std::int64_t, 3> next_;
  ivec3 voxel_;
  const VoxelBox box_;
  int axis_ = -1;  // crossed last
};

}  // namespace scarp
